#pragma once

#include <string>
#include <vector>

#include "manoscope/design/run_forecast.hpp"
#include "manoscope/design/wish.hpp"
#include "manoscope/wall/clamped_wall.hpp"

namespace manoscope::design {

/// What a wish asks of levels.
class Demand {
 public:
  /// All of them must outlive it.
  Demand(const Wish& wish, const Target& target, const std::vector<SolvedRun>& runs)
      : wish_(wish), target_(target), runs_(runs) {}

  /// Whether it asks for an uncertainty.
  bool asks() const { return wish_.uncertainty || wish_.drop_uncertainty; }
  /// Of p(x), as it is to be small, Pa.
  double uncertainty(const Apparatus& apparatus, const std::vector<double>& levels) const;
  /// Of the drop of the worst run; of the range where there are none, Pa.
  double drop(const Apparatus& apparatus, const std::vector<double>& levels) const;
  bool enough(const Apparatus& apparatus, const std::vector<double>& levels) const;

 private:
  const Wish& wish_;
  const Target& target_;
  const std::vector<SolvedRun>& runs_;
};

/// How a wall answers along x.
struct WallReach {
  PressureSpan half_wavelength;  ///< m, least and largest over the range; 0: at x alone
  double spacing = 0.0;          ///< m, of stations
};

/// One part of the wish.
struct WishAnswer {
  bool met = false;
  std::string text;
};

/// Whether each part of a wish is met by levels, and else what alone would meet it.
std::vector<WishAnswer> answer_wish(const Wish& wish, const PlacementTask& task,
                                    const Demand& demand, const std::vector<double>& levels,
                                    const wall::ClampedWall& wall, const WallReach& reach);

}  // namespace manoscope::design
