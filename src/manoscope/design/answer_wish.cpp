#include "manoscope/design/answer_wish.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "manoscope/design/pressure_text.hpp"
#include "manoscope/design/what_matters.hpp"

namespace manoscope::design {
namespace {

/// What alone would do, in words; "" if nothing would.
std::string what_would_do(const PlacementTask& task, const wall::ClampedWall& wall,
                          const std::function<bool(const Apparatus&)>& enough) {
  std::string text;
  for (const Lever lever : levers(task.apparatus)) {
    const auto share = needed_share(task.apparatus, lever, enough);
    const bool of_wall = lever == Lever::wall_stiffness;
    if (!share || (of_wall && !still_bears(task, wall, *share))) continue;
    const Apparatus better = improved(task.apparatus, lever, *share);
    const std::string value = of_wall ? fmt::format("{:.2g} of what it is", *share)
                                      : fmt::format("{} instead of {}", lever_value(better, lever),
                                                    lever_value(task.apparatus, lever));
    text += fmt::format("{}{} {}", text.empty() ? "" : "; or ", lever_name(lever), value);
  }
  return text;
}

/// An uncertainty that is wanted, Pa, and what there is.
struct Balance {
  std::string what;
  double wanted = 0.0, found = 0.0;
  double floor = 0.0;  ///< whatever the levels and their labels
  std::size_t n_maps = 0;
  std::string where;  ///< of what was found
};

/// @param would_do  says what alone would meet the wish; asked only where it is not met.
WishAnswer answer_uncertainty(const Balance& of, const std::function<std::string()>& would_do) {
  const bool met = of.found <= of.wanted;
  std::string text = fmt::format("{} to {:.3g} Pa: {} by {} maps, {:.3g} Pa{}", of.what, of.wanted,
                                 met ? "met" : "not met", of.n_maps, of.found, of.where);
  if (met) return {true, std::move(text)};
  if (of.floor > of.wanted) {
    text += fmt::format("; {:.3g} Pa are left whatever the levels", of.floor);
  }
  const std::string mend = would_do();
  text += mend.empty() ? ". Nothing alone mends that: see what matters"
                       : ". With these levels, any of this would do: " + mend;
  return {false, std::move(text)};
}

WishAnswer answer_resolution(double wanted, const WallReach& reach, double width) {
  const PressureSpan& shown = reach.half_wavelength;
  if (shown.high == 0.0) {
    return {wanted >= 2.0 * reach.spacing,
            fmt::format("resolution {:.3g} mm: the wall answers to the pressure at x alone; "
                        "stations are {:.3g} um apart",
                        wanted * 1e3, reach.spacing * 1e6)};
  }
  const std::string wall = fmt::format("the wall shows half of ripples of {:.3g} to {:.3g} mm",
                                       shown.low * 1e3, shown.high * 1e3);
  if (wanted >= shown.high) {
    return {true, fmt::format("resolution {:.3g} mm: met, {}", wanted * 1e3, wall)};
  }
  constexpr double kFinest = 0.1;  // what `measure` accepts
  return {false,
          fmt::format("resolution {:.3g} mm: not met, {}. It goes with the width: {:.2g} mm would "
                      "do; or --finest-ripple {:.2g} of `measure`, at more noise",
                      wanted * 1e3, wall, width * wanted / shown.high * 1e3,
                      std::max(kFinest, wanted / shown.high))};
}

}  // namespace

double Demand::uncertainty(const Apparatus& apparatus, const std::vector<double>& levels) const {
  return uncertainty_over(apparatus, levels, target_).of(wish_.aim());
}

double Demand::drop(const Apparatus& apparatus, const std::vector<double>& levels) const {
  if (runs_.empty()) return range_drop_uncertainty(apparatus, levels, target_.range);
  double worst = 0.0;
  for (const SolvedRun& run : runs_) {
    worst = std::max(worst, forecast_run(apparatus, levels, run).drop_uncertainty);
  }
  return worst;
}

bool Demand::enough(const Apparatus& apparatus, const std::vector<double>& levels) const {
  return (!wish_.uncertainty || uncertainty(apparatus, levels) <= wish_.uncertainty->si()) &&
         (!wish_.drop_uncertainty || drop(apparatus, levels) <= wish_.drop_uncertainty->si());
}

std::vector<WishAnswer> answer_wish(const Wish& wish, const PlacementTask& task,
                                    const Demand& demand, const std::vector<double>& levels,
                                    const wall::ClampedWall& wall, const WallReach& reach) {
  std::vector<WishAnswer> answers;
  const Apparatus exact = with_exact_labels(task.apparatus);
  const std::vector<double> dense = dense_levels(task);
  if (wish.uncertainty) {
    const RangeUncertainty over = uncertainty_over(task.apparatus, levels, task.target);
    const std::string where = wish.aim() == Aim::rms
                                  ? " rms"
                                  : fmt::format(" at worst, at {}", pressure_text(over.worst_at));
    const Balance balance{"p(x)",
                          wish.uncertainty->si(),
                          over.of(wish.aim()),
                          demand.uncertainty(exact, dense),
                          levels.size(),
                          where};
    answers.push_back(answer_uncertainty(balance, [&] {
      return what_would_do(task, wall, [&](const Apparatus& apparatus) {
        return demand.uncertainty(apparatus, levels) <= balance.wanted;
      });
    }));
  }
  if (wish.drop_uncertainty) {
    const Balance balance{"dp_e",
                          wish.drop_uncertainty->si(),
                          demand.drop(task.apparatus, levels),
                          demand.drop(exact, dense),
                          levels.size(),
                          " at worst"};
    answers.push_back(answer_uncertainty(balance, [&] {
      return what_would_do(task, wall, [&](const Apparatus& apparatus) {
        return demand.drop(apparatus, levels) <= balance.wanted;
      });
    }));
  }
  if (wish.resolution) {
    answers.push_back(answer_resolution(wish.resolution->si(), reach, wall.width.si()));
  }
  return answers;
}

}  // namespace manoscope::design
