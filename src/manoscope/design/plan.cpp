#include "manoscope/design/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/design/pressure_text.hpp"

namespace manoscope::design {
namespace {

constexpr double kUsable = 0.98;      // of the pressure at which the wall's theory ends
constexpr double kHeadroom = 1.15;    // of the highest pressure to be read, for the highest level
constexpr double kClear = 3.0;        // label uncertainties between that and the highest level
constexpr double kLeastClear = 2e-3;  // the same as a share of it
constexpr int kUsualLevels = 20;

/// A channel whose flow cannot be solved is no fault where the range is told.
std::vector<SolvedRun> try_runs(const twin::Scenario& scenario, const Wish& wish, int n_threads,
                                const Monitor& monitor, std::vector<std::string>& notes) {
  try {
    return solve_runs(scenario, n_threads, monitor);
  } catch (const InputError& error) {
    if (!wish.highest) throw;
    notes.push_back(fmt::format("no runs are forecast. {}: {}", error.where(), error.found()));
    return {};
  }
}

PressureSpan wanted_range(const Wish& wish, const std::vector<SolvedRun>& runs) {
  if (runs.empty() && !wish.highest) {
    throw InputError("plan", "no range of pressure to be read",
                     "Give --lowest and --highest, or flow rates in [flow] of the scenario");
  }
  PressureSpan range{0.0, 0.0};
  if (!runs.empty()) range = runs.front().whole;
  for (const SolvedRun& run : runs) {
    range.low = std::max(0.0, std::min(range.low, run.whole.low));
    range.high = std::max(range.high, run.whole.high);
  }
  if (wish.lowest) range.low = wish.lowest->si();
  if (wish.highest) range.high = wish.highest->si();
  if (!(range.low < range.high)) {
    throw InputError("plan",
                     fmt::format("the range of pressure to be read is {} to {}",
                                 pressure_text(range.low), pressure_text(range.high)),
                     "Give --lowest below --highest");
  }
  return range;
}

/// Highest level that the wall's theory and the gauge allow.
double highest_level(const twin::Scenario& scenario, const Wish& wish, const PressureSpan& range) {
  const double limit =
      kUsable * (scenario.wall.largest_pressure() + scenario.wall.preload.load).si();
  if (range.high > limit) {
    throw InputError(
        "plan",
        fmt::format("{} are to be read, but under {} the wall rises by {:g} of its half-width, "
                    "where its theory (moderate rotations) ends",
                    pressure_text(range.high), pressure_text(limit), wall::kLargestRise),
        "Lower --highest or the flow rates, or make the wall thicker, stiffer or narrower");
  }
  if (!wish.highest_level) return std::min(kHeadroom * range.high, limit);
  const double highest = wish.highest_level->si();
  if (highest < range.high) {
    throw InputError("--highest-level",
                     fmt::format("is {}, but up to {} are to be read", pressure_text(highest),
                                 pressure_text(range.high)),
                     "Raise it, or lower --highest: nothing is read above the highest level");
  }
  return std::min(highest, limit);
}

/// Leaves out pressures at which the wall has two states.
void leave_out_two_states(const WallSurvey& survey, PlacementTask& task,
                          std::vector<std::string>& notes) {
  if (survey.snaps().empty()) return;
  double low = 0.0;
  for (const SurveyedSnap& snap : survey.snaps()) {
    low = std::max(low, snap.between.high);
    notes.push_back(fmt::format(
        "the wall snaps through between {} and {}, by {:+.3g} um at mid-channel",
        pressure_text(snap.between.low), pressure_text(snap.between.high), 1e6 * snap.jump));
  }
  const auto& two = survey.two_states();
  if (two) {
    low = std::max(low, two->high);
    notes.push_back(
        fmt::format("from {} to {} it has two states, by the way it came: a reading "
                    "there is ambiguous",
                    pressure_text(two->low), pressure_text(two->high)));
  }
  constexpr double kAbove = 1.05;
  low *= kAbove;
  task.vented = false;
  if (task.target.range.low >= low) return;
  if (low >= task.target.range.high) {
    throw InputError("plan",
                     fmt::format("the wall is not single-valued below {}, and up to {} are to be "
                                 "read",
                                 pressure_text(low), pressure_text(task.target.range.high)),
                     "Read higher pressures, or take a wall under tension");
  }
  task.target.range.low = low;
  notes.push_back(
      fmt::format("the plan is for {} and above; a map at 0 Pa shows the wall at rest "
                  "and is no level",
                  pressure_text(low)));
}

/// Share of the pixels' variance that reading neighbours together leaves: a smoothing spline that
/// passes half of a ripple, sum of its squared weights.
double averaging(double spacing, double half_wavelength) {
  // (1/pi) int (1 + u^4)^-2 du from 0 to infinity, times 2 pi: 3 pi/(4 sqrt 2).
  constexpr double kSpline = 1.6661;
  return half_wavelength > 0.0 ? std::min(1.0, kSpline * spacing / half_wavelength) : 1.0;
}

std::vector<double> choose(const PlacementTask& task, const Demand& demand, const Wish& wish,
                           int usual, int n_threads, const Monitor& monitor) {
  const bool searched = !wish.levels && demand.asks() &&
                        demand.enough(with_exact_labels(task.apparatus), dense_levels(task));
  if (searched) {
    const auto enough = [&](const std::vector<double>& levels) {
      return demand.enough(task.apparatus, levels);
    };
    return fewest_levels(task, wish.most_levels, enough, n_threads, monitor).levels;
  }
  monitor.report("placing levels", 0.0);
  const int n = wish.levels.value_or(usual);
  return tidy_levels(task, place_levels(task, n, n_threads, monitor));
}

LevelSet level_set(const std::string& name, const PlacementTask& task,
                   const std::vector<SolvedRun>& runs, std::vector<double> levels) {
  LevelSet set{name, std::move(levels), {}, 0.0, {}};
  set.over = uncertainty_over(task.apparatus, set.levels, task.target);
  set.drop = range_drop_uncertainty(task.apparatus, set.levels, task.target.range);
  for (const SolvedRun& run : runs) {
    set.runs.push_back(forecast_run(task.apparatus, set.levels, run));
  }
  return set;
}

std::vector<LevelSet> other_sets(const PlacementTask& task, const std::vector<SolvedRun>& runs,
                                 int n, const twin::ScenarioDraft& draft) {
  // What one would do unplanned: from the lowest pressure to be read, or two decades.
  const double habit = std::max(task.target.range.low, 0.01 * task.lowest_top);
  std::vector<LevelSet> sets{
      level_set(fmt::format("log-spaced from {}", pressure_text(habit)), task, runs,
                log_spaced(n, habit, task.lowest_top, task.vented)),
      level_set("log-spaced, best first", task, runs, best_log_spaced(task, n)),
      level_set("evenly spaced", task, runs,
                even_levels(n, task.target.range.low, task.lowest_top, task.vented))};
  constexpr std::size_t kFewest = 5;
  if (draft.has_levels && draft.scenario.levels.size() >= kFewest) {
    std::vector<double> own;
    for (const Pressure level : draft.scenario.levels) own.push_back(level.si());
    const std::string name = fmt::format("the scenario's own {}", own.size());
    sets.push_back(level_set(name, task, runs, std::move(own)));
  }
  return sets;
}

std::vector<PlannedReading> plan_readings(const PlacementTask& task,
                                          const std::vector<double>& levels) {
  constexpr Index kRows = 9;
  const Forecast forecast =
      forecast_readings(task.apparatus, levels,
                        Array1::LinSpaced(kRows, task.target.range.low, task.target.range.high));
  const Array1 uncertainty = forecast.uncertainty(), error = forecast.error.standard();
  std::vector<PlannedReading> readings;
  for (Index i = 0; i < kRows; ++i) {
    const double p = forecast.pressure[i];
    PlannedReading reading{p,
                           task.apparatus.curve.deflection(p),
                           task.apparatus.curve.compliance(p),
                           uncertainty[i],
                           error[i],
                           {}};
    for (const char* source : {"pressure labels", "interpolation", "pixel noise", "leveling",
                               "registration", "gauge zero", "gauge gain"}) {
      reading.sources.emplace_back(source, by_source(forecast.stated, source)[i]);
    }
    readings.push_back(std::move(reading));
  }
  return readings;
}

/// How the wall answers along x, at three pressures of the range.
void find_reach(const WallSurvey& survey, Length width, Plan& plan) {
  for (const double share : {0.0, 0.5, 1.0}) {
    const double p = plan.range.low + share * (plan.range.high - plan.range.low);
    const double one = survey.half_wavelength(Pressure::from_si(p), width);
    PressureSpan& all = plan.half_wavelength;
    all.low = share == 0.0 ? one : std::min(all.low, one);
    all.high = std::max(all.high, one);
  }
  plan.through_wall = plan.half_wavelength.low > 0.0 && survey.snaps().empty();
}

}  // namespace

Plan make_plan(const twin::ScenarioDraft& draft, const Wish& wish, int n_threads,
               const Monitor& monitor) {
  wish.validate();
  const twin::Scenario& scenario = draft.scenario;
  Plan plan;
  plan.name = scenario.name;
  plan.aim = wish.aim();
  if (draft.water_assumed) plan.notes.emplace_back("no [fluid]: water, 1.0 mPa s, 998 kg/m3");
  const std::vector<SolvedRun> runs = try_runs(scenario, wish, n_threads, monitor, plan.notes);
  PressureSpan range = wanted_range(wish, runs);
  const double highest = highest_level(scenario, wish, range);

  const double noise = scenario.gauge.noise.si();
  const double tolerance = std::max(0.01 * noise, 1e-5 * highest);
  const WallSurvey survey =
      survey_wall(scenario, Pressure::from_si(highest), Pressure::from_si(tolerance), monitor);
  PlacementTask task{{survey.curve(), {}, scenario.gauge}, {range, {}}};
  for (const SolvedRun& run : runs) task.target.spans.push_back(run.whole);
  const double clear = std::max(kClear * noise, kLeastClear * range.high);
  task.lowest_top = std::min(range.high + clear, highest);
  task.highest_level = highest;
  task.aim = wish.aim();
  task.wall_doubt = wish.wall_doubt;
  task.most_repeats = wish.most_repeats;
  leave_out_two_states(survey, task, plan.notes);
  plan.range = task.target.range;
  find_reach(survey, scenario.channel.width, plan);

  monitor.report("rehearsing maps", 0.0);
  plan.maps = task.apparatus.maps = rehearse_maps(scenario, survey, task.target.range);
  task.apparatus.flow_maps = wish.flow_maps;
  task.apparatus.gradient =
      (task.target.range.high - task.target.range.low) / scenario.channel.length.si();
  if (plan.through_wall) {
    task.apparatus.averaging = averaging(plan.maps.spacing, plan.half_wavelength.low);
  }

  const Demand demand(wish, task.target, runs);
  const int usual =
      draft.has_levels ? std::max(5, static_cast<int>(scenario.levels.size())) : kUsualLevels;
  std::vector<double> levels = choose(task, demand, wish, usual, n_threads, monitor);
  plan.scenario = scenario;
  plan.scenario.levels.clear();
  for (const double level : levels) plan.scenario.levels.push_back(Pressure::from_si(level));
  plan.planned = level_set("planned", task, runs, std::move(levels));
  const int n = static_cast<int>(plan.planned.levels.size());
  plan.others = other_sets(task, runs, n, draft);
  plan.readings = plan_readings(task, plan.planned.levels);
  plan.improvements = find_improvements(task, plan.planned.levels, scenario.wall);
  plan.smallest_gap = scenario.channel.height.si() + 1.5 * survey.curve().deflection(0.0);
  const WallReach reach{plan.half_wavelength, plan.maps.spacing};
  plan.answers = answer_wish(wish, task, demand, plan.planned.levels, scenario.wall, reach);
  return plan;
}

}  // namespace manoscope::design
