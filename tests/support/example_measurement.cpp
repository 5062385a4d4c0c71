#include "tests/support/example_measurement.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/results/schema.hpp"
#include "tests/support/example_checks.hpp"
#include "tests/support/example_flow.hpp"

namespace manoscope::test_support {
namespace {

using results::Measurement;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLength = 15.5e-3, kWidth = 1.7e-3, kHeight = 174.5e-6;
constexpr double kViscosity = 1e-3, kDensity = 998.0;
constexpr double kStart = 1.6e-3, kEnd = 13.0e-3;

// Pressure (Pa) and mid-channel deflection (um) of a buckled nitride wall.
constexpr std::array<std::array<double, 2>, 25> kWall{
    {{0, -11.4},    {93, -10.8},   {136, -10.6},  {166, -10.4},  {207, -10.0},
     {306, -9.5},   {390, -8.7},   {505, -7.4},   {667, -4.0},   {857, 7.2},
     {1141, 9.8},   {1490, 11.9},  {1949, 13.9},  {2556, 15.9},  {3340, 17.9},
     {4401, 20.0},  {5770, 22.2},  {7550, 24.5},  {9892, 27.1},  {12939, 29.8},
     {16965, 32.8}, {22241, 36.0}, {29112, 39.5}, {38168, 43.3}, {49991, 47.5}}};
constexpr std::array<double, 8> kFlowRates{5, 10, 20, 30, 40, 50, 60, 70};  // mL/min

double wall_deflection(double pressure) {
  std::size_t i = 1;
  while (i + 1 < kWall.size() && kWall[i][0] < pressure) ++i;
  const auto& [p0, z0] = kWall[i - 1];
  const auto& [p1, z1] = kWall[i];
  return 1e-6 * (z0 + (z1 - z0) * (pressure - p0) / (p1 - p0));
}

double end_shape(double x) {
  constexpr double kDecay = 0.45e-3;
  return (1.0 - std::cosh((x - 0.5 * kLength) / kDecay) / std::cosh(0.5 * kLength / kDecay)) *
         (1.0 + 0.02 * (x / kLength - 0.5));
}

double resistance(double gap) {
  return 12.0 * kViscosity / (kWidth * gap * gap * gap) / (1.0 - 0.63 * gap / kWidth);
}

Array1 nan1(Index n) { return Array1::Constant(n, kNan); }
Array2 nan2(Index rows, Index columns) { return Array2::Constant(rows, columns, kNan); }

void add_calibration(Measurement& m, const ExampleSize& size) {
  RandomStream noise(size.seed, "static");
  const Index n_l = size.n_levels;
  m.level_pressure = Array1(n_l);
  m.level_pressure_uncertainty = Array1(n_l);
  m.level_estimate = m.level_estimate_uncertainty = Array1(n_l);
  m.static_deflection = Array2(n_l, size.n_x);
  m.crest_deflection = Array1(n_l);
  for (Index level = 0; level < n_l; ++level) {
    const std::size_t row =
        n_l < 2
            ? kWall.size() - 1
            : static_cast<std::size_t>(level * static_cast<Index>(kWall.size() - 1) / (n_l - 1));
    m.level_pressure(level) = kWall[row][0];
    m.level_pressure_uncertainty(level) = row == 0 ? 0.0 : 10.0;
    m.level_estimate(level) = m.level_pressure(level);
    m.level_estimate_uncertainty(level) = 0.5 * m.level_pressure_uncertainty(level);
    m.crest_deflection(level) = 1.5e-6 * kWall[row][1] + 1e-8 * noise.normal();
    for (Index ix = 0; ix < size.n_x; ++ix) {
      m.static_deflection(level, ix) =
          1e-6 * kWall[row][1] * end_shape(m.x(ix)) + 8e-9 * noise.normal();
    }
  }
  m.static_deflection_uncertainty = Array2::Constant(n_l, size.n_x, 8e-9);
  m.crest_deflection_uncertainty = Array1::Constant(n_l, 1e-8);
  m.stiffness = Array2::Constant(n_l, size.n_x, 3e8);
  m.stiffness_uncertainty = Array2::Constant(n_l, size.n_x, 2e6);
  m.tube_law_at_rest_deflection = Array1::LinSpaced(n_l, 0.0, 40e-6);
  m.tube_law_at_rest_a = Array1::Constant(n_l, 4e8);
  m.tube_law_at_rest_b = -2.0 - 1e11 * m.tube_law_at_rest_deflection.square();
  m.tube_law_at_rest_b_uncertainty = Array1::Constant(n_l, 3.0);
  m.tube_law_at_rest_misfit = Array1::Constant(n_l, 2.5);
  m.tube_law_at_rest_b_small = -2.0;
  m.tube_law_at_rest_b_small_uncertainty = 0.5;
  m.tube_law = "b = -5.8 ± 1.2 N/m at 0.5 um, differs from 0 by 9.7 sigma";
}

void add_empty_runs(Measurement& m, Index n_r, Index n_x) {
  m.flow_rate = m.flow_rate_uncertainty = nan1(n_r);
  for (Array2* array : {&m.deflection, &m.deflection_uncertainty, &m.pressure,
                        &m.pressure_uncertainty, &m.pressure_lower, &m.pressure_upper,
                        &m.pressure_local, &m.pressure_local_uncertainty, &m.resistance_pressure}) {
    *array = nan2(n_r, n_x);
  }
  for (Array1* array :
       {&m.extracted_drop, &m.extracted_drop_uncertainty, &m.resistance_drop,
        &m.resistance_drop_uncertainty, &m.channel_resistance_drop, &m.reynolds, &m.transducer_drop,
        &m.parasitic_drop, &m.en_number, &m.half_response_wavelength, &m.pressure_band_factor,
        &m.tube_law_deflection, &m.tube_law_a, &m.tube_law_b, &m.tube_law_b_uncertainty,
        &m.tube_law_misfit, &m.healing_length}) {
    *array = nan1(n_r);
  }
  m.pressure_flags = Flags2::Zero(n_r, n_x);
  m.test_section = Array2(n_r, 2);
  m.budget_source = {"pixel noise", "leveling", "pressure labels", "interpolation"};
  m.pressure_variance.assign(m.budget_source.size(), nan2(n_r, n_x));
}

/// What the flow does: pressure from the outlet upwards, gap and resistance along.
struct Flow {
  Array1 pressure, resistance_from_inlet;  // (n_x) Pa, Pa s m-3
  double drop = 0.0, mean_gap = 0.0;
};

Flow solve_flow(const Array1& x, double Q) {
  constexpr int kSteps = 2000;
  const double dx = kLength / kSteps;
  std::vector<double> p(kSteps + 1), upstream(kSteps + 1);
  p[kSteps] = 300.0 + Q * 3e8;
  double gaps = 0.0;
  for (int i = kSteps; i > 0; --i) {
    const double gap = kHeight + wall_deflection(p[i]) * end_shape(dx * i);
    p[i - 1] = p[i] + Q * resistance(gap) * dx;
    upstream[i - 1] = upstream[i] + resistance(gap) * dx;
    gaps += gap / kSteps;
  }
  Flow flow{Array1(x.size()), Array1(x.size()), p[0] - p[kSteps], gaps};
  for (Index ix = 0; ix < x.size(); ++ix) {
    const double place = std::min(x(ix) / dx, kSteps - 1e-9);
    const auto i = static_cast<std::size_t>(place);
    const double t = place - static_cast<double>(i);
    flow.pressure(ix) = (1.0 - t) * p[i] + t * p[i + 1];
    flow.resistance_from_inlet(ix) = upstream[0] - (1.0 - t) * upstream[i] - t * upstream[i + 1];
  }
  return flow;
}

FlagBits flags_of(double x, double pressure, Index ix, Index n_x) {
  FlagBits flags = 0;
  if (n_x > 20 && ix == n_x / 3) flags |= ReadingFlag::no_data;
  if (pressure > 650.0 && pressure < 870.0) flags |= ReadingFlag::ambiguous;
  if (std::abs(end_shape(x)) < 0.6) flags |= ReadingFlag::insensitive;
  if (pressure > kWall.back()[0]) flags |= ReadingFlag::out_of_calibration;
  if (x < kStart || x > kEnd) flags |= ReadingFlag::outside_test_section;
  return flags;
}

void add_run(Measurement& m, Index run, const ExampleSize& size) {
  RandomStream noise(size.seed, "run", static_cast<std::uint64_t>(run));
  const double Q = kFlowRates[static_cast<std::size_t>(run)] * 1e-6 / 60.0;
  const Flow flow = solve_flow(m.x, Q);
  const Index n_x = m.x.size();
  m.run.push_back("Q" +
                  std::to_string(static_cast<int>(kFlowRates[static_cast<std::size_t>(run)])));
  m.flow_rate(run) = Q;
  m.flow_rate_uncertainty(run) = 0.01 * Q;
  m.test_section.row(run) << kStart, kEnd;

  const auto at = [&](double x, const Array1& values) {
    Index nearest = 0;
    (m.x - x).abs().minCoeff(&nearest);
    return values(nearest);
  };
  const double end_pressure = at(kEnd, flow.pressure);
  const double end_resistance = at(kEnd, flow.resistance_from_inlet);
  const double tilt = noise.normal(), label = noise.normal();
  Array1 tilt_effect(n_x), label_effect(n_x);
  Matrix covariance(n_x, n_x);
  for (Index ix = 0; ix < n_x; ++ix) {
    const double p = flow.pressure(ix), shape = std::max(end_shape(m.x(ix)), 0.05);
    const double slope = (wall_deflection(p + 20.0) - wall_deflection(p - 20.0)) / 40.0 * shape;
    tilt_effect(ix) = 8e-9 * (2.0 * m.x(ix) / kLength - 1.0) / slope;
    label_effect(ix) = 6.0;
    const std::array<double, 4> variance{std::pow(12e-9 / slope, 2),
                                         tilt_effect(ix) * tilt_effect(ix),
                                         label_effect(ix) * label_effect(ix), 9.0};
    m.deflection(run, ix) = wall_deflection(p) * end_shape(m.x(ix)) + 8e-9 * noise.normal();
    m.deflection_uncertainty(run, ix) = 8e-9;
    const FlagBits flags = flags_of(m.x(ix), p, ix, n_x);
    m.pressure_flags(run, ix) = flags;
    if ((flags & ReadingFlag::no_data) != 0) m.deflection(run, ix) = kNan;
    m.resistance_pressure(run, ix) =
        end_pressure + 0.98 * Q * (end_resistance - flow.resistance_from_inlet(ix));
    if ((flags & ReadingFlag::no_answer) != 0) continue;
    double total = 0.0;
    for (std::size_t source = 0; source < variance.size(); ++source) {
      m.pressure_variance[source](run, ix) = variance[source];
      total += variance[source];
    }
    m.pressure(run, ix) = p + tilt * tilt_effect(ix) + label * label_effect(ix) +
                          std::sqrt(variance[0]) * noise.normal();
    m.pressure_uncertainty(run, ix) = std::sqrt(total);
    m.pressure_lower(run, ix) = m.pressure(run, ix) - 1.96 * std::sqrt(total);
    m.pressure_upper(run, ix) = m.pressure(run, ix) + 1.98 * std::sqrt(total);
    m.pressure_local(run, ix) = m.pressure(run, ix) + 3.0;
    m.pressure_local_uncertainty(run, ix) = 1.1 * std::sqrt(total);
  }
  covariance = tilt_effect.matrix() * tilt_effect.matrix().transpose() +
               label_effect.matrix() * label_effect.matrix().transpose();
  for (Index ix = 0; ix < n_x; ++ix) {
    if (std::isnan(m.pressure(run, ix))) {
      covariance.row(ix).setConstant(kNan);
      covariance.col(ix).setConstant(kNan);
    } else {
      covariance(ix, ix) = std::pow(m.pressure_uncertainty(run, ix), 2);
    }
  }
  m.pressure_covariance.push_back(covariance);

  const double scale = 1.0 + 0.004 * noise.normal();
  m.extracted_drop(run) =
      at(kStart, flow.pressure) - at(kEnd, flow.pressure) + 12.0 * noise.normal();
  m.extracted_drop_uncertainty(run) = 15.0;
  m.resistance_drop(run) =
      scale * Q * (at(kEnd, flow.resistance_from_inlet) - at(kStart, flow.resistance_from_inlet));
  m.resistance_drop_uncertainty(run) = 0.008 * m.resistance_drop(run);
  m.channel_resistance_drop(run) = scale * flow.drop;
  m.reynolds(run) = 2.0 * Q / (kViscosity / kDensity * (kWidth + flow.mean_gap));
  m.parasitic_drop(run) = 0.11 * flow.drop;
  if (run != 2) m.transducer_drop(run) = flow.drop + m.parasitic_drop(run) + 25.0 * noise.normal();
  m.half_response_wavelength(run) = 1.1e-3;
  m.pressure_band_factor(run) = 2.9;
  m.tube_law_deflection(run) = 10e-6 + 1e-6 * static_cast<double>(run);
  m.tube_law_a(run) = 1e8;
  m.tube_law_b(run) = -6.25;
  m.tube_law_b_uncertainty(run) = 1.1;
  m.tube_law_misfit(run) = 0.9;
  m.healing_length(run) = 0.25e-3;
  m.en_number(run) =
      std::abs(m.extracted_drop(run) - m.resistance_drop(run)) /
      (2.0 * std::hypot(m.extracted_drop_uncertainty(run), m.resistance_drop_uncertainty(run)));
}

void add_crossings(Measurement& m, bool wanted) {
  std::vector<double> x, p;
  for (Index run = 0; wanted && run < m.deflection.rows(); ++run) {
    for (Index level = 0; level < m.level_pressure.size(); ++level) {
      for (Index ix = 1; ix < m.x.size(); ++ix) {
        if (m.x(ix - 1) < 1.2e-3 || m.x(ix) > 14.2e-3) continue;
        const double before = m.deflection(run, ix - 1) - m.static_deflection(level, ix - 1);
        const double after = m.deflection(run, ix) - m.static_deflection(level, ix);
        if (!std::isless(before * after, 0.0)) continue;  // NaN: no crossing
        m.crossing_run.push_back(static_cast<int>(run));
        x.push_back(m.x(ix - 1) + (m.x(ix) - m.x(ix - 1)) * before / (before - after));
        p.push_back(m.level_pressure(level));
        break;
      }
    }
  }
  m.crossing_x = Eigen::Map<const Array1>(x.data(), static_cast<Index>(x.size()));
  m.crossing_pressure = Eigen::Map<const Array1>(p.data(), static_cast<Index>(p.size()));
  m.crossing_x_uncertainty = Array1::Constant(m.crossing_x.size(), 2e-5);
}

void add_response(Measurement& m) {
  const double length = m.channel_length, width = m.channel_width;
  m.response_x = Array1::LinSpaced(40, -0.03 * length, 1.03 * length);
  m.response_z = Array1::LinSpaced(12, -0.8 * width, 0.8 * width);
  m.wall_response = Array2::Zero(12, 40);
  for (Index iz = 0; iz < 12; ++iz) {
    for (Index ix = 0; ix < 40; ++ix) {
      const double u = m.response_x(ix) / length, v = 2.0 * m.response_z(iz) / width;
      if (u < 0.0 || u > 1.0 || std::abs(v) > 1.0) continue;
      m.wall_response(iz, ix) = 30e-6 * (1.0 - v * v) * std::min(1.0, 20.0 * std::min(u, 1.0 - u));
    }
  }
  m.wall_response(3, 17) = std::nan("");
}

void add_maps(Measurement& m, const ExampleSize& size) {
  RandomStream noise(size.seed, "maps");
  for (Index level = 0; level < size.n_levels; ++level)
    m.map.push_back("h" + std::to_string(level) + ".gsf");
  for (Index run = 0; run < size.n_runs; ++run) m.map.push_back("f" + std::to_string(run) + ".gsf");
  const auto n_m = static_cast<Index>(m.map.size());
  m.map_pressure = nan1(n_m);
  m.map_pressure.head(size.n_levels) = m.level_pressure;
  m.map_tilt_x = m.map_tilt_z = m.map_noise = m.map_missing = m.map_spikes = Array1(n_m);
  m.map_shift = m.map_shift_uncertainty = m.map_shift_across = m.map_rotation = Array1(n_m);
  m.map_shift_across_uncertainty = m.map_rotation_uncertainty = m.map_unmended = Array1(n_m);
  m.map_mended = m.map_rim_bend = m.map_rim_bend_uncertainty = Array1(n_m);
  for (Index map = 0; map < n_m; ++map) {
    m.map_tilt_x(map) = 3e-5 * noise.normal();
    m.map_tilt_z(map) = 8e-5 * noise.normal();
    m.map_noise(map) = 20e-9 * (1.0 + 0.02 * noise.normal());
    m.map_missing(map) = noise.uniform(0.0, 0.02);
    m.map_spikes(map) = noise.uniform(0.0, 0.001);
    m.map_shift(map) = noise.uniform(-8e-6, 8e-6);
    m.map_shift_uncertainty(map) = 0.3e-6;
    m.map_shift_across(map) = noise.uniform(-8e-6, 8e-6);
    m.map_shift_across_uncertainty(map) = 0.4e-6;
    m.map_rotation(map) = 1e-4 * noise.normal();
    m.map_rotation_uncertainty(map) = 5e-5;
    m.map_unmended(map) = noise.uniform(0.0, 0.0005);
    m.map_mended(map) = noise.uniform(0.0, 0.002);
    m.map_rim_bend(map) = 1e-9 * noise.normal();
    m.map_rim_bend_uncertainty(map) = 1e-9;
    m.inputs += m.map[static_cast<std::size_t>(map)] + "  " + std::string(64, 'a') + "\n";
  }
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same(double a, double b) { return same_bits(a, b); }
bool same(const std::vector<std::string>& a, const std::vector<std::string>& b) { return a == b; }
bool same(const std::vector<int>& a, const std::vector<int>& b) { return a == b; }
template <class Derived>
bool same(const Eigen::DenseBase<Derived>& a, const Eigen::DenseBase<Derived>& b) {
  if (a.size() == 0 && b.size() == 0) return true;
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  for (Index row = 0; row < a.rows(); ++row) {
    for (Index column = 0; column < a.cols(); ++column) {
      if constexpr (std::is_same_v<typename Derived::Scalar, double>) {
        if (!same_bits(a.derived()(row, column), b.derived()(row, column))) return false;
      } else {
        if (a.derived()(row, column) != b.derived()(row, column)) return false;
      }
    }
  }
  return true;
}
template <class Layer>
bool same(const std::vector<Layer>& a, const std::vector<Layer>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Layer& left, const Layer& right) { return same(left, right); });
}

}  // namespace

Measurement example_measurement(const ExampleSize& size) {
  Measurement m;
  m.title = "S1 <example> & \"friends\"";
  m.source = "manoscope 0.1.0 (0123456789ab)";
  m.history = "manoscope measure S1 -o S1/result";
  m.experiment = "manoscope = 1\nname = \"S1 µ\"\n";
  m.reading = "through the influence operator of a clamped wall fitted to the calibration";
  m.settings = "read_pressure.coverage = 0.95\nseed = 1\n";
  m.warnings = {"run Q5: 12 stations near the outlet are ambiguous: the wall snaps through there",
                "h03.gsf: 2 % of the pixels are missing"};
  m.channel_length = kLength;
  m.channel_width = kWidth;
  m.channel_height = kHeight;
  m.channel_height_uncertainty = 0.5e-6;
  m.viscosity = kViscosity;
  m.viscosity_uncertainty = 5e-6;
  m.density = kDensity;
  m.x = (Array1::LinSpaced(size.n_x, 0.0, static_cast<double>(size.n_x - 1)) + 0.5) * kLength /
        static_cast<double>(size.n_x);
  add_calibration(m, size);
  add_empty_runs(m, size.n_runs, size.n_x);
  for (Index run = 0; run < size.n_runs; ++run) add_run(m, run, size);
  add_crossings(m, size.crossings);
  add_maps(m, size);
  add_response(m);
  add_example_flow(m);
  add_example_checks(m, size.seed);
  return m;
}

std::string first_difference(const Measurement& a, const Measurement& b) {
  for (const auto& text : results::global_texts()) {
    if (a.*text.member != b.*text.member) return std::string(text.name);
  }
  if (a.warnings != b.warnings) return "warnings";
  for (const auto& variable : results::variables()) {
    const bool equal =
        std::visit([&](auto member) { return same(a.*member, b.*member); }, variable.member);
    if (!equal) return std::string(variable.name);
  }
  return {};
}

}  // namespace manoscope::test_support
