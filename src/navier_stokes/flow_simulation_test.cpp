#include "flow_simulation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/duct_resistance.hpp"
#include "manoscope/flow/parasitic.hpp"
#include "tests/support/quiet_traps.hpp"
#include "tests/support/reference_table.hpp"

namespace manoscope::navier_stokes {
namespace {

constexpr flow::Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};

/// Width-averaged deflection of the reference flows.
double bulge(double x) {
  const double length = kChannel.length.si(), end = 0.6e-3;
  return 33e-6 * (1.0 - 0.6 * x / length) * (1.0 - std::exp(-x / end)) *
         (1.0 - std::exp(-(length - x) / end));
}

/// The roof of that average, a parabola across in three dimensions.
double bulged_roof(double x, double z, int dim) {
  const double s = 2.0 * z / kChannel.width.si();
  return dim == 2 ? bulge(x) : 1.5 * (1.0 - s * s) * bulge(x);
}

SimulatedChannel channel_at(double mL_per_minute, int dim = 2) {
  SimulatedChannel channel;
  channel.channel = kChannel;
  channel.zeta = [dim](double x, double z) { return bulged_roof(x, z, dim); };
  channel.flow_rate = mL_per_minute * mL_per_min;
  return channel;
}

/// Rows of a shared reference flow, none where it is absent. Columns: x, gap, p on the roof, on the
/// floor, in the middle, mean, and the references' own errors of the four.
std::vector<std::vector<double>> reference(const std::string& name) {
  const auto path = shared_file("data/flow/" + name);
  if (!std::filesystem::exists(path)) return {};
  return read_table(path);
}

Array1 stations_of(const std::vector<std::vector<double>>& rows) {
  Array1 x(static_cast<Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) x[static_cast<Index>(i)] = rows[i][0];
  return x;
}

/// Largest difference from the reference, of its largest pressure; values that the reference itself
/// does not hold to a tenth of `tolerance` are left out.
struct Agreement {
  double mean = 0.0, wall = 0.0, drop = 0.0, drop_in_uncertainties = 0.0;
};

Agreement agreement(const SimulatedFlow& flow, const std::vector<std::vector<double>>& rows,
                    double tolerance) {
  double scale = 0.0;
  for (const auto& row : rows) scale = std::max(scale, row[5]);
  Agreement result;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto k = static_cast<Index>(i);
    const double mean = std::abs(flow.mean_pressure[k] - rows[i][5]) / scale;
    const double wall = std::abs(flow.wall_pressure[k] - rows[i][2]) / scale;
    if (rows[i][9] < 0.1 * tolerance * scale) result.mean = std::max(result.mean, mean);
    if (rows[i][6] < 0.1 * tolerance * scale) result.wall = std::max(result.wall, wall);
  }
  const double drop = rows.front()[5] - rows.back()[5];
  result.drop = flow.drop / drop - 1.0;
  result.drop_in_uncertainties =
      std::abs(flow.drop - drop) / (flow.drop_uncertainty + rows.front()[9]);
  return result;
}

/// Leaves the figures of docs/simulation.md in the output of the tests (--gtest_output=json:FILE).
void record(const std::string& name, const Agreement& found, const SimulatedFlow& flow) {
  const auto keep = [&](const char* what, double share) {
    testing::Test::RecordProperty(name + ' ' + what, std::to_string(100.0 * share));
  };
  keep("mean, %", found.mean);
  keep("wall, %", found.wall);
  keep("drop, %", found.drop);
  keep("u of the drop, %", flow.drop_uncertainty / flow.drop);
}

class SimulateFlow : public testing::Test {
  test::QuietTraps traps_;  // MUMPS scales rows by what may be 0 / 0
};

TEST_F(SimulateFlow, OfABulgedGapIsWithin005PercentOfIndependentSolutions) {
  constexpr double kTolerance = 5e-4;
  for (const auto& [name, flow_rate, lead_mm] : {std::tuple{"caseB0_Q5.csv", 5.0, 0.0},
                                                 {"caseB0_Q70.csv", 70.0, 0.0},
                                                 {"caseB1_Q5.csv", 5.0, 1.75},
                                                 {"caseB1_Q70.csv", 70.0, 1.75}}) {
    const auto rows = reference(name);
    if (rows.empty()) GTEST_SKIP() << "no reference flow " << name;
    SimulatedChannel channel = channel_at(flow_rate);
    channel.lead_in = channel.lead_out = lead_mm * mm;
    const SimulatedFlow flow = simulate(channel, stations_of(rows), MeshOptions{});
    const Agreement found = agreement(flow, rows, kTolerance);
    record(name, found, flow);
    EXPECT_LT(found.mean, kTolerance) << name;
    EXPECT_LT(found.wall, kTolerance) << name;
    EXPECT_LT(std::abs(found.drop), kTolerance) << name;
    EXPECT_LT(found.drop_in_uncertainties, 2.0) << name;
    EXPECT_TRUE(flow.converged) << name;
  }
}

TEST_F(SimulateFlow, OfAFlatGapIsExact) {
  SimulatedChannel channel = channel_at(70.0);
  channel.zeta = [](double, double) { return 0.0; };
  const Array1 stations = Array1::LinSpaced(11, 0.0, kChannel.length.si());
  const SimulatedFlow flow = simulate(channel, stations, MeshOptions{});
  const double h = kChannel.height.si();
  const double slope = 12.0 * channel.fluid.viscosity.si() * channel.flow_rate.si() /
                       (kChannel.width.si() * h * h * h);
  const Array1 exact = slope * (kChannel.length.si() - stations);
  EXPECT_LT((flow.mean_pressure - exact).abs().maxCoeff(), 1e-8 * exact[0]);  // round-off
  EXPECT_LT((flow.wall_pressure - exact).abs().maxCoeff(), 1e-8 * exact[0]);
  EXPECT_LT((flow.wall_shear - 0.5 * h * slope).abs().maxCoeff(), 1e-8 * 0.5 * h * slope);
  EXPECT_LT(flow.drop_uncertainty, 1e-8 * flow.drop);
}

TEST_F(SimulateFlow, DevelopsFromAUniformProfileAsAnIndependentSolutionDoes) {
  for (const auto& [name, flow_rate] :
       {std::pair{"caseA3_sliplead_Q5.csv", 5.0}, {"caseA3_sliplead_Q70.csv", 70.0}}) {
    auto rows = reference(name);
    if (rows.empty()) GTEST_SKIP() << "no reference flow " << name;
    rows.erase(rows.begin());  // x = 0, the edge itself
    SimulatedChannel channel = channel_at(flow_rate);
    channel.zeta = [](double, double) { return 0.0; };
    channel.inlet = flow::InletProfile::uniform;
    channel.lead_in = 3.0 * kChannel.height;
    channel.lead_in_slips = true;
    const SimulatedFlow flow = simulate(channel, stations_of(rows), MeshOptions{});
    const Agreement found = agreement(flow, rows, 1e-3);
    record(name, found, flow);
    EXPECT_LT(found.mean, 1e-3) << name;
    EXPECT_LT(found.wall, 1e-3) << name;
  }
}

/// Solves case D and holds it against the reference: p within `mean` of the largest pressure, the
/// drop within `drop` of itself and twice its own uncertainty.
void expect_case_d(double flow_rate, MeshOptions mesh, double mean, double drop) {
  const std::string name = fmt::format("caseD_Q{:g}.csv", flow_rate);
  const auto rows = reference(name);
  if (rows.empty()) GTEST_SKIP() << "no reference flow " << name;
  mesh.dim = 3;
  const SimulatedFlow flow = simulate(channel_at(flow_rate, 3), stations_of(rows), mesh);
  const Agreement found = agreement(flow, rows, mean);
  record(fmt::format("{}, order {}", name, mesh.order), found, flow);
  EXPECT_LT(found.mean, mean) << name;
  EXPECT_LT(std::abs(found.drop), drop) << name;
  EXPECT_LT(found.drop_in_uncertainties, 2.0) << name;
}

TEST_F(SimulateFlow, InThreeDimensionsIsNearAnIndependentSolutionOnACoarseMesh) {
  MeshOptions mesh;
  mesh.cells_along = 30;
  mesh.cells_up = 3;
  mesh.cells_across = 5;
  expect_case_d(5.0, mesh, 3e-3, 2e-3);
}

/// Minutes: `make simulation-check` runs them.
TEST_F(SimulateFlow, DISABLED_InThreeDimensionsAgreesWithIndependentSolutions) {
  for (const double flow_rate : {5.0, 70.0}) expect_case_d(flow_rate, MeshOptions{}, 2e-3, 1e-3);
}

TEST_F(SimulateFlow, DISABLED_OfCubicOrderIsWithin01PercentAtHighFlowRate) {
  MeshOptions mesh;
  mesh.order = 3;
  mesh.cells_along = 18;
  mesh.cells_up = 3;
  mesh.cells_across = 5;
  expect_case_d(70.0, mesh, 1e-3, 1e-3);
}

TEST_F(SimulateFlow, CoversTheErrorOfAFewCellsUpAndAcross) {
  SimulatedChannel channel = channel_at(5.0, 3);
  channel.zeta = [](double, double) { return 0.0; };
  const double duct = flow::passage_drop(channel.fluid.viscosity, channel.flow_rate,
                                         {kChannel.length, kChannel.width, kChannel.height})
                          .si();
  MeshOptions mesh;
  mesh.dim = 3;
  mesh.cells_along = 6;
  for (const auto& [up, across, factor] : {std::tuple{3, 3, 2.0}, {4, 3, 3.0}, {3, 4, 3.0}}) {
    mesh.cells_up = up;
    mesh.cells_across = across;
    const SimulatedFlow flow = simulate(channel, Array1::Zero(1), mesh);
    // All of the error lies up and across. It falls at least with the first power of the cells.
    EXPECT_LT(std::abs(flow.drop - duct), flow.drop_uncertainty) << up << " x " << across;
    EXPECT_NEAR(flow.drop_uncertainty / std::abs(flow.drop - flow.coarse_drop), factor, 1e-9);
  }
}

TEST_F(SimulateFlow, RefusesAGapThatClosesAndNamesTheFirstPlace) {
  SimulatedChannel channel = channel_at(5.0);
  const double length = channel.channel.length.si();
  for (const double closed_from : {0.0, 0.5, 0.9}) {
    channel.zeta = [&](double x, double) { return x < closed_from * length ? 0.0 : -180e-6; };
    try {
      simulate(channel, Array1::Zero(1), MeshOptions{});
      FAIL() << "flows through a closed gap";
    } catch (const InputError& error) {
      const auto at = error.found().find("x = ");
      ASSERT_NE(at, std::string::npos) << error.what();
      // The mesh sees the roof at nodes, at most a cell of the coarser mesh apart.
      const double place = std::stod(error.found().substr(at + 4)) * 1e-3;
      EXPECT_NEAR(place, closed_from * length, 0.05 * length) << error.what();
    }
  }
}

TEST_F(SimulateFlow, RefusesARoofTooSteepForItsCells) {
  SimulatedChannel channel = channel_at(5.0);
  // A step of 60 um within 20 um, where cells are 0.2 mm long.
  channel.zeta = [](double x, double) { return 30e-6 * (1.0 + std::tanh((x - 7.7e-3) / 10e-6)); };
  try {
    simulate(channel, Array1::Zero(1), MeshOptions{});
    FAIL() << "flows below a roof that the mesh does not have";
  } catch (const InputError& error) {
    const auto at = error.found().find("x = ");
    ASSERT_NE(at, std::string::npos) << error.what();
    EXPECT_NEAR(std::stod(error.found().substr(at + 4)), 7.7, 0.3) << error.what();
    EXPECT_NE(error.mend().find("--cells-along"), std::string::npos);
  }
}

TEST_F(SimulateFlow, CallsNothingConvergedThatIsNot) {
  MeshOptions mesh;
  mesh.cells_along = 8;
  mesh.cells_up = 3;
  mesh.tolerance = 1e-4;
  const SimulatedFlow flow = simulate(channel_at(70.0), Array1::Zero(1), mesh);
  EXPECT_FALSE(flow.converged);
  EXPECT_GT(flow.drop_uncertainty, 1e-4 * flow.drop);
}

}  // namespace
}  // namespace manoscope::navier_stokes
