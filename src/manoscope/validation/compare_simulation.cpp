#include "manoscope/validation/compare_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/validation/error_table.hpp"
#include "manoscope/validation/pieces.hpp"

namespace manoscope::validation {
namespace {

/// (m, n) values at positions from values at ascending stations, straight between them.
Matrix between(const Array1& stations, const Array1& positions) {
  const Index n = stations.size();
  Matrix weights = Matrix::Zero(positions.size(), n);
  for (Index i = 0; i < positions.size(); ++i) {
    const Index above =
        std::upper_bound(stations.begin(), stations.end(), positions[i]) - stations.begin();
    const Index right = std::clamp<Index>(above, 1, n - 1);
    const double share =
        (positions[i] - stations[right - 1]) / (stations[right] - stations[right - 1]);
    weights(i, right - 1) = 1.0 - std::clamp(share, 0.0, 1.0);
    weights(i, right) = std::clamp(share, 0.0, 1.0);
  }
  return weights;
}

Array1 times(const Matrix& weights, const Array1& values) {
  return (weights * values.matrix()).array();
}

/// One line of the budget for each error of the measured deflection.
std::string budget_line(const ErrorMode& mode) {
  constexpr const char* kKept[] = {"channel height", "viscosity", "flow rate"};
  const bool kept = std::find(std::begin(kKept), std::end(kKept), mode.source) != std::end(kKept);
  return kept ? mode.source : "deflection";
}

/// The tables of a setup if they hold these deflections, with room for differences; else new ones.
std::shared_ptr<const flow::SectionTables> covering(const FlowSetup& setup, Length least,
                                                    Length greatest) {
  if (setup.tables) {
    const Length room = 2.0 * setup.tables->step;
    const flow::SectionFamily& family = setup.tables->family;
    if (family.least() <= least - room && greatest + room <= family.greatest()) {
      return setup.tables;
    }
  }
  return with_tables(setup, least, greatest).tables;
}

/// Errors of sums of a simulated pressure.
class Simulated {
 public:
  Simulated(const FlowSetup& setup, FlowRate flow_rate, const SmoothShape& shape,
            const SolvedPressure& solved, const Outlet& outlet)
      : setup_(setup), solved_(solved), outlet_(outlet), roof_(shape.at(shape.positions())) {
    const WallLine line = wall_line(roof_, setup.channel.length);
    setup_.tables = covering(setup, Length::from_si(line.zeta.minCoeff()),
                             Length::from_si(line.zeta.maxCoeff()));
    run_ = modelled_run(flow::FlowModel::plane_march, setup_, flow_rate, line,
                        Array1::Zero(line.x.size()));
    if (solved.plane) {
      const Array1 zeta = shape.zeta(solved.x);
      sides_ = side_wall_pressure(setup_, flow_rate, solved.x, zeta);
      sides_error_ = side_wall_error(setup_, flow_rate, zeta);
    }
  }

  /// Gauge pressure at the solver's stations, side walls added or not.
  Array1 pressure(bool with_sides) const {
    const Array1 own = solved_.pressure + outlet_.pressure.si();
    return with_sides ? Array1(own + sides_) : own;
  }

  /// What the inlet profile does to sums of p, per standard deviation.
  Array1 inlet_effect(const Matrix& weights, const Array1& positions) const {
    return times(weights * between(solved_.x, positions), solved_.inlet);
  }

  /// Adds the errors of weights p; weights (m, n) are those of p at `positions`.
  void add(ErrorTable& table, const Matrix& weights, const Array1& positions, bool with_sides,
           bool with_inlet = true) const {
    const Matrix at_solver = weights * between(solved_.x, positions);
    const auto own = [&](const char* name, const Array1& effect) {
      table.add(name, name, times(at_solver, effect));
    };
    own("numerical", solved_.mesh);
    if (with_inlet) own("inlet profile", solved_.inlet);
    own("outlet pressure", Array1::Constant(solved_.x.size(), outlet_.uncertainty.si()));
    if (with_sides) own("side walls", sides_error_ * sides_);
    if (solved_.roof_across.size() > 0) own("roof across", solved_.roof_across);
    ErrorTable moved(weights.rows());
    ModelErrors which;
    which.model = false;
    add_model(moved, scale(with_sides), weights * between(roof_.x, positions), run_, setup_, roof_,
              which);
    for (const ErrorMode& mode : moved.modes()) {
      table.add(mode.variable, budget_line(mode), mode.effect);
    }
  }

 private:
  /// Drop of the simulation over that of the march whose derivatives are taken.
  double scale(bool with_sides) const {
    const Array1 p = pressure(with_sides);
    return (p[0] - p[p.size() - 1]) / (run_.pressure()[0]);
  }

  FlowSetup setup_;
  const SolvedPressure& solved_;
  Outlet outlet_;
  Profile roof_;
  ModelledRun run_;
  Array1 sides_;
  double sides_error_ = 0.0;
};

ModelAgreement compare(const Simulated& simulated, const SolvedPressure& solved,
                       const SimulationComparison::Variant& variant, bool with_sides,
                       const FlowSetup& setup, const Profile& state,
                       const inversion::PressureReading& reading,
                       const inversion::TestSection& section, const Estimate& extracted,
                       const CompareModelsOptions& options) {
  Matrix ends = Matrix::Zero(1, reading.x.size());
  ends(0, section.first) = 1.0;
  ends(0, section.last) = -1.0;
  const Matrix at_stations = between(solved.x, reading.x);
  const Array1 pressure = times(at_stations, variant.pressure);
  ModelAgreement found;
  found.pressure = variant.pressure;
  found.valid = true;
  ErrorTable own(1), both(1);
  simulated.add(own, ends, reading.x, with_sides);
  found.drop = own.combine(pressure[section.first] - pressure[section.last], Array1::Ones(1));
  found.difference = found.drop.value - extracted.value;
  // Another profile at the inlet moves the drop one way only: it excuses no difference the other.
  const bool excused = found.difference * simulated.inlet_effect(ends, reading.x)[0] <= 0.0;
  simulated.add(both, ends, reading.x, with_sides, excused);
  add_reading(both, -1.0, ends, reading, state);
  found.uncertainty = std::sqrt(both.covariance()(0, 0));
  if (setup.uncertainty.height == Length{}) {
    found.en_number = std::nan("");
    found.words = "no verdict: the gap has no stated uncertainty";
    return found;
  }
  const Matrix pieces = piece_weights(reading, state, section, options.pieces);
  ErrorTable along(pieces.rows());
  simulated.add(along, pieces, reading.x, with_sides, excused);
  add_reading(along, -1.0, pieces, reading, state);
  found.along = chi_square(times(pieces, pressure) - times(pieces, reading.pressure),
                           along.covariance(), kResolution * std::abs(found.drop.value));
  judge(found, extracted, options, "simulation");
  return found;
}

}  // namespace

Array1 side_wall_pressure(const FlowSetup& setup, FlowRate flow_rate, const Array1& x,
                          const Array1& zeta) {
  const flow::SectionsAlong sections =
      flow::sections_along(tables_for(setup, zeta)->family, x, zeta);
  const Array1 plane = 12.0 / (setup.channel.width.si() * sections.mean_gap.cube());
  const Array1 more = setup.fluid.viscosity.si() * flow_rate.si() *
                      (sections.conductance.inverse() - plane);  // Pa/m
  Array1 pressure = Array1::Zero(x.size());
  for (Index i = x.size() - 1; i-- > 0;) {
    pressure[i] = pressure[i + 1] + 0.5 * (more[i] + more[i + 1]) * (x[i + 1] - x[i]);
  }
  return pressure;
}

double side_wall_error(const FlowSetup& setup, FlowRate flow_rate, const Array1& zeta) {
  constexpr double kSlope = 0.03, kLeast = 0.005, kMost = 0.15;
  return std::clamp(kSlope * flow::reduced_reynolds(setup.channel, setup.fluid, flow_rate, zeta),
                    kLeast, kMost);
}

SimulationComparison compare_simulation(const FlowSetup& setup, FlowRate flow_rate,
                                        const SmoothShape& shape, const Profile& state,
                                        const SolvedPressure& solved, const Outlet& outlet,
                                        const inversion::PressureReading& reading,
                                        const std::optional<inversion::TestSection>& section,
                                        const CompareModelsOptions& options) {
  options.validate();
  const Index n = solved.x.size();
  MANO_ASSERT(n >= 2 && solved.pressure.size() == n && solved.mesh.size() == n &&
              solved.inlet.size() == n &&
              (solved.roof_across.size() == 0 || solved.roof_across.size() == n));
  const Simulated simulated(setup, flow_rate, shape, solved, outlet);
  SimulationComparison result;
  if (section) {
    Matrix ends = Matrix::Zero(1, reading.x.size());
    ends(0, section->first) = 1.0;
    ends(0, section->last) = -1.0;
    ErrorTable table(1);
    add_reading(table, 1.0, ends, reading, state);
    result.extracted = table.combine(
        reading.pressure[section->first] - reading.pressure[section->last], Array1::Ones(1));
  }
  for (const bool with_sides : {false, true}) {
    if (with_sides && !solved.plane) continue;
    SimulationComparison::Variant variant;
    variant.name = with_sides ? "side walls added" : "as solved";
    variant.pressure = simulated.pressure(with_sides);
    ErrorTable table(n);
    simulated.add(table, Matrix::Identity(n, n), solved.x, with_sides);
    variant.uncertainty = {Array1::Zero(n), table.modes()};
    if (section) {
      variant.agreement = compare(simulated, solved, variant, with_sides, setup, state, reading,
                                  *section, *result.extracted, options);
    }
    result.variants.push_back(std::move(variant));
  }
  return result;
}

}  // namespace manoscope::validation
