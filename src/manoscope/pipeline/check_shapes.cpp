#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "manoscope/calibration/shape_check.hpp"
#include "manoscope/calibration/shape_verdict.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/numerics/robust.hpp"
#include "manoscope/pipeline/checks.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;
using results::Measurement;

calibration::ShapedMap shaped(const maps::ReducedMap& map, double pressure) {
  const maps::MapShift& shift = map.condition.shift;
  return {pressure, &map.sections, shift.shift.si(), shift.uncertainty.si()};
}

/// Pressure that the curves give the level of a label.
double estimate_of(const calibration::ConstitutiveCurves& curves, Pressure label) {
  for (std::size_t k = 0; k < curves.levels.size(); ++k) {
    if (curves.levels[k].pressure == label) return curves.level_pressure[static_cast<Index>(k)];
  }
  return label.si();
}

/// The hydrostatic maps, in order of pressure, and where each stands among the levels.
struct LevelMaps {
  std::vector<calibration::ShapedMap> list;
  std::vector<Index> place;  ///< in `list`, of each hydrostatic map

  LevelMaps(const Experiment& experiment, const ReducedExperiment& reduced,
            const calibration::ConstitutiveCurves& curves) {
    std::vector<std::size_t> order(reduced.hydrostatic.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto& entries = experiment.hydrostatic;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return entries[a].pressure < entries[b].pressure;
    });
    place.resize(order.size());
    for (const std::size_t i : order) {
      place[i] = static_cast<Index>(list.size());
      list.push_back(shaped(reduced.hydrostatic[i], estimate_of(curves, entries[i].pressure)));
    }
  }
};

void make_room(const ReducedExperiment& reduced, Index n_maps, Measurement& m) {
  if (!reduced.hydrostatic.empty()) {
    m.section_x = reduced.hydrostatic.front().sections.x;
    m.section_z = reduced.hydrostatic.front().sections.z;
  }
  m.shape_chi_square = m.shape_dof = Array2::Constant(n_maps, m.section_x.size(), kMissing);
  m.shape_misfit.assign(static_cast<std::size_t>(n_maps),
                        Array2::Constant(m.section_z.size(), m.section_x.size(), kMissing));
  m.shape_reduced_chi_square = m.shape_p_value = m.shape_reading_shift =
      Array1::Constant(n_maps, kMissing);
  m.shape_worst = Array2::Constant(n_maps, 2, kMissing);
}

/// Which run each map belongs to.
std::vector<int> runs_of_maps(const Experiment& experiment, const std::vector<std::string>& runs) {
  std::vector<int> run_of(experiment.hydrostatic.size(), -1);
  for (const auto& entry : experiment.flow) {
    run_of.push_back(
        static_cast<int>(std::find(runs.begin(), runs.end(), entry.run) - runs.begin()));
  }
  return run_of;
}

void store(const calibration::ShapeMisfit& misfit, const inversion::Stretch& stretch, Index map,
           Measurement& m) {
  m.shape_chi_square.row(map) = misfit.chi_square;
  m.shape_dof.row(map) = misfit.dof;
  m.shape_misfit[static_cast<std::size_t>(map)] = misfit.residual;
  const calibration::ShapeVerdict verdict =
      calibration::shape_verdict(misfit, m.section_x, stretch.start.si(), stretch.end.si());
  if (verdict.dof == 0.0) return;
  m.shape_reduced_chi_square[map] = verdict.chi_square / verdict.dof;
  m.shape_p_value[map] = verdict.p_value;
  m.shape_worst(map, 0) = verdict.worst_start;
  m.shape_worst(map, 1) = verdict.worst_end;
  m.shape_reading_shift[map] = verdict.reading_shift;
}

/// Median of u(p) over the stations of one run, or of all, within a stretch; NaN without any.
double usual_uncertainty(const Measurement& m, Index run, double start, double end) {
  std::vector<double> values;
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    if (run >= 0 && r != run) continue;
    for (Index ix = 0; ix < m.x.size(); ++ix) {
      const double u = m.pressure_uncertainty(r, ix);
      if (m.x[ix] >= start && m.x[ix] <= end && std::isfinite(u)) values.push_back(u);
    }
  }
  return values.empty() ? kMissing : numerics::median(values);
}

/// The largest chi-square by its degrees of freedom in the worst stretch of a map.
double worst_ratio(const Measurement& m, Index map) {
  double worst = 0.0;
  for (Index j = 0; j < m.section_x.size(); ++j) {
    const bool inside =
        m.section_x[j] >= m.shape_worst(map, 0) && m.section_x[j] <= m.shape_worst(map, 1);
    const double ratio = m.shape_chi_square(map, j) / m.shape_dof(map, j);
    if (inside && std::isfinite(ratio)) worst = std::max(worst, ratio);
  }
  return worst;
}

/// Two digits at least, no exponent.
std::string plain(double value) {
  return value < 10.0 ? fmt::format("{:.1f}", value) : fmt::format("{:.0f}", value);
}

std::string words(const Experiment& experiment, const Measurement& m, Index map, double usual) {
  const auto i = static_cast<std::size_t>(map);
  const int run = m.map_run[i];
  const double shift = m.shape_reading_shift[map];
  const std::string what =
      run < 0
          ? fmt::format("Level {:.6g} Pa ({})", experiment.hydrostatic[i].pressure.si(), m.map[i])
          : fmt::format("Run {} ({})", m.run[static_cast<std::size_t>(run)], m.map[i]);
  std::string text = fmt::format(
      "{}: between x = {:.2f} and {:.2f} mm the wall has not the cross-section that pressure gives "
      "it (chi-square {} times what noise makes): dust, heat, a fault of bond or map? If it is "
      "no pressure, p(x) ",
      what, m.shape_worst(map, 0) * 1e3, m.shape_worst(map, 1) * 1e3, plain(worst_ratio(m, map)));
  if (run < 0) text += "of runs that pass this level ";
  text += fmt::format("may be off there by {} Pa", plain(shift));
  if (std::isgreater(usual, 0.0))
    text += fmt::format(", {} times its standard uncertainty", plain(shift / usual));
  return text;
}

}  // namespace

void store_shapes(const Experiment& experiment, const ReducedExperiment& reduced,
                  const calibration::ConstitutiveCurves& curves, const inversion::Stretch& stretch,
                  int n_threads, Measurement& m) {
  const auto n_levels = static_cast<Index>(reduced.hydrostatic.size());
  const auto n = n_levels + static_cast<Index>(reduced.flow.size());
  m.map_run = runs_of_maps(experiment, m.run);
  make_room(reduced, n, m);
  if (m.section_x.size() == 0) return;
  const LevelMaps levels(experiment, reduced, curves);
  const calibration::CalibratedShapes shapes(levels.list, m.channel_width);
  std::vector<calibration::ShapeMisfit> misfit(static_cast<std::size_t>(n));
  parallel_for(n, n_threads, [&](Index map) {
    const auto i = static_cast<std::size_t>(map);
    misfit[i] = map < n_levels
                    ? shapes.misfit_of_level(levels.place[i])
                    : shapes.misfit(shaped(reduced.flow[i - reduced.hydrostatic.size()], 0.0));
  });
  for (Index map = 0; map < n; ++map) {
    const auto i = static_cast<std::size_t>(map);
    inversion::Stretch within = stretch;
    if (map >= n_levels && std::isfinite(m.test_section(m.map_run[i], 0))) {
      within = {Length::from_si(m.test_section(m.map_run[i], 0)),
                Length::from_si(m.test_section(m.map_run[i], 1))};
    }
    store(misfit[i], within, map, m);
  }
}

std::vector<std::string> doubt_shapes(const Experiment& experiment, const Measurement& m) {
  constexpr double kChance = 1e-4, kMatters = 2.0;
  constexpr std::size_t kMost = 4;
  std::vector<std::string> doubts;
  std::string others;
  for (Index map = 0; map < m.shape_p_value.size(); ++map) {
    if (!std::isless(m.shape_p_value[map], kChance)) continue;
    const int run = m.map_run[static_cast<std::size_t>(map)];
    const double usual =
        run < 0 ? usual_uncertainty(m, -1, m.x[0], m.x[m.x.size() - 1])
                : usual_uncertainty(m, run, m.shape_worst(map, 0), m.shape_worst(map, 1));
    const double shift = m.shape_reading_shift[map];
    if (!(shift > 0.0) || std::islessequal(shift, kMatters * usual)) continue;
    if (doubts.size() < kMost) {
      doubts.push_back(words(experiment, m, map, usual));
    } else {
      others += (others.empty() ? "" : ", ") + m.map[static_cast<std::size_t>(map)];
    }
  }
  if (!others.empty()) {
    doubts.push_back("The wall's cross-section is not the calibrated one in these maps either: " +
                     others);
  }
  return doubts;
}

}  // namespace manoscope::pipeline
