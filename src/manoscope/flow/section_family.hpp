#pragma once

#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/cross_section.hpp"
#include "manoscope/flow/roof.hpp"

namespace manoscope::flow {

/// Options of SectionFamily.
struct SectionFamilyOptions {
  double tolerance = 1e-8;  ///< relative, of every interpolated quantity
  int most_nodes = 33;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("tolerance", tolerance, "relative error of the table of sections");
    visit("most_nodes", most_nodes, "most sections to solve for the table");
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// Sections under one shape of the wall, h = 2 h0 + zeta g(s), for any mean deflection in a range.
///
/// The Poisson problem is solved at Chebyshev nodes of zeta; polynomials through flow factor, beta,
/// alpha, shears and arc length answer in between. Nodes are added until the polynomial of every
/// other node meets the rest within the tolerance, which is kept as error(). Thousands of sections
/// cost what 9 to 17 do.
///
/// Source: barycentric interpolation, Berrut & Trefethen, SIAM Rev. 46 (2004) 501. Accuracy: that
/// of solve_cross_section() and error() together.
class SectionFamily {
 public:
  /// @throws InputError if the channel or an option is out of range, the range of deflections is
  ///         empty, or the gap closes inside it.
  SectionFamily(const Channel& channel, WallShape shape, Length least, Length greatest,
                const SectionFamilyOptions& options = {});

  /// Family of the deflections of a channel: zeta (n), m, with room of a tenth of the range.
  static SectionFamily of(const Channel& channel, WallShape shape, const Array1& zeta,
                          const SectionFamilyOptions& options = {});

  /// @throws InputError outside the range.
  CrossSection at(Length mean_deflection) const;

  Length least() const { return Length::from_si(least_); }
  Length greatest() const { return Length::from_si(greatest_); }
  Index n_nodes() const { return nodes_.size(); }
  /// Relative error of the polynomial through every other node, at the rest: an upper bound in
  /// practice for that through all.
  double error() const { return error_; }
  const WallShape& shape() const { return shape_; }

 private:
  static constexpr Index kQuantities = 7;
  using Row = Eigen::Array<double, 1, kQuantities>;
  using Table = Eigen::Array<double, Eigen::Dynamic, kQuantities>;

  Row solve(double mean_deflection) const;

  Channel channel_;
  WallShape shape_;
  double least_ = 0.0, greatest_ = 0.0, error_ = 0.0;
  CrossSectionOptions degrees_;  ///< the same for all, so that round-off does not jump
  Array1 nodes_;                 ///< m
  Table table_;                  ///< (nodes, quantities)
};

/// Sections at stations along the flow.
struct SectionsAlong {
  Array1 x;                   ///< m
  Array1 area;                ///< m2
  Array1 mean_gap;            ///< m
  Array1 conductance;         ///< Q eta / G, m4
  Array1 momentum_factor;     ///< beta
  Array1 energy_factor;       ///< alpha
  Array1 hydraulic_diameter;  ///< m
  Array1 roof_shear;          ///< mean wall shear on the roof / G, m
  Array1 floor_shear;         ///< m
};

/// Sections of the family at the stations.
/// @param x     (n) m, strictly ascending, n >= 2.
/// @param zeta  (n) width-averaged deflection, m.
/// @throws InputError if the sizes differ, x does not ascend or a deflection is out of the range.
SectionsAlong sections_along(const SectionFamily& family, const Array1& x, const Array1& zeta);

/// Sections solved one by one, for a roof that changes its shape along the channel.
/// @param sections  one a station.
SectionsAlong sections_along(const Array1& x, const std::vector<CrossSection>& sections);

}  // namespace manoscope::flow
