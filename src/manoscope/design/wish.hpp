#pragma once

#include <optional>
#include <string>

#include "manoscope/core/units.hpp"
#include "manoscope/design/place_levels.hpp"

namespace manoscope::design {

/// What an experiment is to reach, and what may be spent on it.
struct Wish {
  std::optional<Pressure> uncertainty;
  std::optional<Pressure> drop_uncertainty;
  std::optional<Length> resolution;
  std::optional<Pressure> lowest, highest;
  std::optional<Pressure> highest_level;
  std::optional<int> levels;
  int most_levels = 40;
  int most_repeats = 2;
  int flow_maps = 1;
  std::optional<std::string> minimise;
  double wall_doubt = 0.1;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("uncertainty", uncertainty, "wanted standard uncertainty of p(x), over the whole range");
    visit("drop-uncertainty", drop_uncertainty,
          "wanted standard uncertainty of the drop dp_e of every run; without runs, of the range");
    visit(
        "resolution", resolution,
        "wanted spatial resolution: wavelength of a ripple of p(x) that the reading shows by half");
    visit("lowest", lowest, "lowest pressure to be read; auto: of the runs");
    visit("highest", highest, "highest pressure to be read; auto: of the runs");
    visit("highest-level", highest_level,
          "highest pressure that the gauge may give; auto: 15 % above the highest to be read");
    visit("levels", levels,
          "number of calibration maps; auto: the fewest that meet the wish, without one those of "
          "the scenario, else 20");
    visit("most-levels", most_levels, "largest number of calibration maps that is tried");
    visit("most-repeats", most_repeats,
          "largest number of maps at one level; many leave no level to notice another wall by");
    visit("flow-maps", flow_maps, "maps of one flow rate that are averaged");
    visit("minimise", minimise,
          "what of the uncertainty of p(x): worst, over the range, or rms, over the runs; auto: "
          "worst "
          "where --uncertainty is wished, else rms");
    visit("wall-doubt", wall_doubt,
          "relative uncertainty of the wall's pressures before the experiment: levels serve softer "
          "and stiffer walls, too");
  }
  Aim aim() const;
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

}  // namespace manoscope::design
