#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/cross_sections.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/roof.hpp"
#include "manoscope/numerics/smoothing_spline.hpp"
#include "manoscope/validation/across_modes.hpp"
#include "manoscope/validation/smooth_shape.hpp"

namespace manoscope::validation {

/// The deflection zeta(x, z) of one run without its noise: what a flow solver takes for the roof in
/// three dimensions.
///
///   zeta(x, z) = zeta(x) g(s) + sum over k of a_k(x) psi_k(s),  s = 2 z/w
///
/// zeta(x) is the width average (SmoothShape), kept to the last digit; g the one shape across that
/// the wall has between the levels; psi_k even and odd departures from it that are 0 at the clamped
/// sides and have mean 0 (AcrossModes). In every stretch of the cells the a_k are fitted by least
/// squares with the level of the stretch free; along the flow each a_k is a smoothing spline
/// through these and the clamped ends, as rough as its noise makes likely
/// (numerics::SmoothingSpline). A buckled wall, whose mean passes 0, is no special case: departures
/// are lengths, not shares of the mean. With 16 cells across there are 6 even and 5 odd departures,
/// with 8 cells 3 and 2.
///
/// Error: standard() on average over x and z; no more is taken away than the noise explains
/// (tests). Cells leave out 2 % of the width at either side: a kink nearer to the sides is not
/// seen.
class SmoothRoof {
 public:
  /// @param sections  of the run, x from the inlet edge (shift taken back).
  /// @param shape     g, 0 at the sides.
  /// @return none if there are no cells, or fewer than eight stretches with enough good ones.
  static std::optional<SmoothRoof> through(const SmoothShape& along, const CrossSections& sections,
                                           const flow::Channel& channel,
                                           const flow::WallShape& shape);

  /// (n_x, n_z) zeta, m; x in [0, length], z in [-w/2, w/2], m.
  Array2 zeta(const Array1& x, const Array1& z) const { return sum(x, z, modes_.size()); }
  /// The same without its odd part: symmetric about z = 0.
  Array2 even(const Array1& x, const Array1& z) const { return sum(x, z, modes_.n_even()); }
  /// (n_x, n_z) standard uncertainty of zeta by noise and smoothing, m.
  Array2 standard(const Array1& x, const Array1& z) const;

  const AcrossModes& modes() const { return modes_; }
  /// (n_x, modes().size()) a_k, m.
  Matrix departures(const Array1& x) const;
  /// (n_x, modes().size()) their standard uncertainty, m.
  Matrix departures_standard(const Array1& x) const;
  const SmoothShape& along() const { return along_; }
  const flow::Channel& channel() const { return channel_; }

  // Root mean squares over cells, of the shape across: the level of each stretch left free. The
  // ends are what lies within half a width of them, where higher waves across die away within a
  // fraction of w/pi and neither cells nor departures tell them all.
  Length taken() const { return Length::from_si(middle_.taken); }  ///< of what was taken away
  Length noise() const { return Length::from_si(middle_.noise); }  ///< of the stated noise
  /// Of both by cell, with the degrees of freedom of levels and splines taken off: 1 where the
  /// departures suffice.
  double misfit() const { return middle_.misfit; }
  Length end_taken() const { return Length::from_si(ends_.taken); }

  // Root mean squares over the channel.
  Length departure() const;     ///< of the even departure from g
  Length odd() const;           ///< of the odd part
  Length odd_standard() const;  ///< of the odd part's standard uncertainty

 private:
  SmoothRoof(SmoothShape along, const flow::Channel& channel, AcrossModes modes)
      : along_(std::move(along)), channel_(channel), modes_(std::move(modes)) {}
  Array2 sum(const Array1& x, const Array1& z, Index n_departures) const;
  /// What the smooth roof leaves of cells; all 0 where there are none.
  struct Judged {
    double taken = 0.0, noise = 0.0;  ///< m
    double misfit = 0.0;
  };
  bool near_end(double x) const;
  /// Two places in each stretch whose mean is that over it (Gauss).
  std::pair<Array1, Array1> within_stretches(const Array1& x) const;
  Judged judge(const CrossSections& sections, const Matrix& means, const Array1& freedom,
               bool ends) const;
  Length mean_square_root(Index first, Index n, bool of_standard) const;

  SmoothShape along_;
  flow::Channel channel_;
  AcrossModes modes_;
  std::vector<numerics::SmoothingSpline> splines_;  ///< one a departure
  double window_ = 0.0;                             ///< m, length of a stretch
  Judged middle_, ends_;
};

}  // namespace manoscope::validation
