#include "manoscope/flow/plane_march.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "tests/support/reference_table.hpp"

namespace manoscope::flow {
namespace {

const Fluid kWater{1.0 * mPa_s, 998.0 * kg_per_m3};
constexpr double kLength = 15.5e-3, kHeight = 175e-6, kWidth = 1.7e-3;

double flow_per_width(double mL_per_minute) { return mL_per_minute * 1e-6 / 60.0 / kWidth; }

/// Deflection of the reference flows.
Array1 bulge(const Array1& x) {
  const double end = 0.6e-3;
  return 33e-6 * (1.0 - 0.6 * x / kLength) * (1.0 - (-x / end).exp()) *
         (1.0 - (-(kLength - x) / end).exp());
}

PlaneMarch march_bulge(Index n, double mL_per_minute, const PlaneMarchOptions& options = {}) {
  const Array1 x = Array1::LinSpaced(n, 0.0, kLength);
  return march_plane(x, kHeight + bulge(x), Array1::Ones(n), flow_per_width(mL_per_minute), kWater,
                     options);
}

double at(const Array1& x, const Array1& f, double where) {
  Index j = 0;
  while (j + 2 < x.size() && x(j + 1) <= where) ++j;
  return f(j) + (where - x(j)) / (x(j + 1) - x(j)) * (f(j + 1) - f(j));
}

TEST(PlaneMarch, KeepsPoiseuilleFlowInAFlatGap) {
  const Index n = 40;
  const Array1 x = Array1::LinSpaced(n, 0.0, kLength);
  const double q = flow_per_width(70.0), F = 0.93;
  const PlaneMarch march =
      march_plane(x, Array1::Constant(n, kHeight), Array1::Constant(n, F), q, kWater);
  const Array1 exact = 12.0 * 1e-3 * q / (F * std::pow(kHeight, 3)) * (kLength - x);
  // Exact for any spacing: round-off of Newton's iteration.
  EXPECT_LT((march.pressure - exact).abs().maxCoeff(), 1e-9 * exact(0));
  EXPECT_LT((march.roof_pressure - exact).abs().maxCoeff(), 1e-6 * exact(0));
  EXPECT_LT((march.momentum_factor - 1.2).abs().maxCoeff(), 1e-10);
  EXPECT_NEAR(march.wall_shear(n - 1), 6.0 * 1e-3 * q / (kHeight * kHeight), 1e-6);
  EXPECT_EQ((march.flags != 0).count(), 0);
}

TEST(PlaneMarch, IsLubricationTheoryForASlowFlow) {
  const Index n = 2001;
  const Array1 x = Array1::LinSpaced(n, 0.0, kLength);
  const Array1 gap = kHeight + bulge(x);
  const double q = flow_per_width(1e-4);
  const PlaneMarch march = march_plane(x, gap, Array1::Ones(n), q, kWater);
  Array1 creeping = Array1::Zero(n);
  for (Index i = n - 1; i-- > 0;) {
    const double mean = 0.5 * (std::pow(gap(i), -3) + std::pow(gap(i + 1), -3));
    creeping(i) = creeping(i + 1) + 12.0 * 1e-3 * q * mean * (x(i + 1) - x(i));
  }
  // Inertia: 13 % at 70 mL/min, so 2e-7 here; implicit steps of 8 um in a gap that opens over
  // 0.6 mm.
  EXPECT_LT((march.pressure - creeping).abs().maxCoeff(), 3e-5 * creeping(0));
}

/// Slender Jeffery-Hamel flow in h = k x: u = f(t) q/(k x) with
///   f'' /(Re k) + f^2 = constant, here p = p_inf - P/(2 x^2), found by shooting.
struct Wedge {
  double start_slope = 0.0, constant = 0.0;  ///< f'(0); c in f'' = Re (c - f^2)
};

double wedge_flux(double reynolds, double slope, double constant, double& end) {
  const int n = 4000;
  const double step = 1.0 / n;
  double f = 0.0, g = slope, flux = 0.0;
  const auto bend = [&](double value) { return reynolds * (constant - value * value); };
  for (int i = 0; i < n; ++i) {  // Runge-Kutta 4
    const double k1 = g, l1 = bend(f);
    const double k2 = g + 0.5 * step * l1, l2 = bend(f + 0.5 * step * k1);
    const double k3 = g + 0.5 * step * l2, l3 = bend(f + 0.5 * step * k2);
    const double k4 = g + step * l3, l4 = bend(f + step * k3);
    const double next = f + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    flux += step / 6.0 * (f + 4.0 * (f + 0.5 * step * k2) + next);
    f = next;
    g += step / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
  }
  end = f;
  return flux;
}

Wedge solve_wedge(double reynolds) {
  Wedge wedge{6.0, -12.0 / reynolds};
  for (int newton = 0; newton < 30; ++newton) {
    double end = 0.0, end_a = 0.0, end_b = 0.0;
    const double flux = wedge_flux(reynolds, wedge.start_slope, wedge.constant, end);
    const double da = 1e-6, db = 1e-6 * std::abs(wedge.constant);
    const double flux_a = wedge_flux(reynolds, wedge.start_slope + da, wedge.constant, end_a);
    const double flux_b = wedge_flux(reynolds, wedge.start_slope, wedge.constant + db, end_b);
    const double a11 = (flux_a - flux) / da, a12 = (flux_b - flux) / db;
    const double a21 = (end_a - end) / da, a22 = (end_b - end) / db;
    const double det = a11 * a22 - a12 * a21;
    const double r1 = 1.0 - flux, r2 = -end;
    wedge.start_slope += (r1 * a22 - r2 * a12) / det;
    wedge.constant += (a11 * r2 - a21 * r1) / det;
  }
  return wedge;
}

TEST(PlaneMarch, BecomesJefferyHamelFlowInAWedge) {
  // h = k x; u = q f(t)/(k x): then psi = q int f has no x in it, u u_x = -q^2 f^2/(k^2 x^3), so
  //   nu f'' q/(k x)^3 = p'/rho - q^2 f^2/(k^2 x^3): f'' = Re (c - f^2), Re = q k/nu,
  //   p' = c rho q^2/(k^2 x^3).
  const double k = 0.02;
  for (const double reynolds : {1.0, 5.0}) {
    const Wedge wedge = solve_wedge(reynolds);
    const double q = reynolds * 1e-3 / 998.0 / k;
    double before = 0.0;
    for (const Index n : {101, 201, 401}) {
      // From 5 mm on: the parabola at the inlet is forgotten over decades of x.
      const Array1 x = 5e-3 * (Array1::LinSpaced(n, 0.0, std::log(400.0))).exp();
      const PlaneMarch march = march_plane(x, k * x, Array1::Ones(n), q, kWater);
      const Index last = n - 1, first = n - 1 - (n - 1) / 4;
      const double drop = march.pressure(first) - march.pressure(last);
      const double exact = wedge.constant * 998.0 * q * q / (k * k) * 0.5 *
                           (1.0 / (x(last) * x(last)) - 1.0 / (x(first) * x(first)));
      const double slope = march.wall_shear(last) / 1e-3 * std::pow(k * x(last), 2) / q;
      const double error = std::abs(slope / wedge.start_slope - 1.0);
      if (n == 401) {
        // Steps of 1.5 % of x, second order: 1.5 %^2 times a few.
        EXPECT_NEAR(drop / exact, 1.0, 2e-3) << reynolds;
        EXPECT_LT(error, 1e-3) << reynolds;
        // Second order gives 4.
        EXPECT_NEAR(before / error, 4.0, 0.7) << reynolds;
      }
      before = error;
    }
  }
}

TEST(PlaneMarch, ConvergesWithSecondOrderInTheSpacing) {
  const double finest = march_bulge(4001, 70.0).pressure(0);
  const double coarse = std::abs(march_bulge(251, 70.0).pressure(0) - finest);
  const double fine = std::abs(march_bulge(501, 70.0).pressure(0) - finest);
  EXPECT_NEAR(coarse / fine, 4.0, 1.0);
  EXPECT_LT(fine, 1e-4 * finest);
}

TEST(PlaneMarch, ConvergesSpectrallyAcrossTheGap) {
  PlaneMarchOptions options;
  options.degree = 32;
  const double finest = march_bulge(501, 70.0, options).pressure(0);
  options.degree = 10;
  EXPECT_NEAR(march_bulge(501, 70.0, options).pressure(0) / finest, 1.0, 1e-4);
  EXPECT_NEAR(march_bulge(501, 70.0).pressure(0) / finest, 1.0, 1e-7);
}

/// Bounds of the greatest error along the channel, % of the largest pressure: of the mean over the
/// gap, on the roof and on the floor with the pressure across the stream, and on the roof without.
struct Reach {
  const char* file;
  double mL_per_minute, mean, roof, floor, roof_without;
};

/// Greatest errors from 1/40 of the length to as far from the outlet.
void expect_within(const Reach& reach, const Array1& x, const PlaneMarch& march,
                   const std::vector<std::array<double, 4>>& rows) {
  double largest = 0.0, mean = 0.0, roof = 0.0, floor = 0.0, without = 0.0;
  for (const auto& row : rows) largest = std::max(largest, row[3]);
  for (const auto& [where, on_floor, on_roof, middle] : rows) {
    if (where < 0.0249 * kLength || where > 0.976 * kLength) continue;
    const auto error = [&, place = where](const Array1& p, double truth) {
      return 100.0 * std::abs(at(x, p, place) - truth) / largest;
    };
    mean = std::max(mean, error(march.pressure, middle));
    roof = std::max(roof, error(march.roof_pressure, on_roof));
    floor = std::max(floor, error(march.floor_pressure, on_floor));
    without = std::max(without, error(march.pressure, on_roof));
  }
  EXPECT_LT(mean, reach.mean) << reach.file;
  EXPECT_LT(roof, reach.roof) << reach.file;
  EXPECT_LT(floor, reach.floor) << reach.file;
  EXPECT_LT(without, reach.roof_without) << reach.file;
}

TEST(PlaneMarch, IsNavierStokesInABulgedGap) {
  // B0 forces v = 0 on its inlet, where the gap opens with a slope of 0.055 already: its flow is
  // not slender there. B1 has a lead-in. The bounds are what was found, rounded up; the targets
  // were 0.05 and 0.4.
  for (const Reach& reach : {Reach{"caseB0_Q5.csv", 5.0, 0.015, 0.010, 0.025, 0.015},
                             Reach{"caseB1_Q5.csv", 5.0, 0.015, 0.010, 0.020, 0.015},
                             Reach{"caseB0_Q70.csv", 70.0, 0.31, 0.35, 0.28, 0.12},
                             Reach{"caseB1_Q70.csv", 70.0, 0.10, 0.13, 0.10, 0.13}}) {
    const auto path = shared_file(std::string("data/flow/") + reach.file);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference flow " << path;
    std::vector<std::array<double, 4>> rows;
    for (const auto& row : read_table(path)) rows.push_back({row[0], row[3], row[2], row[5]});
    const Index n = 1001;
    expect_within(reach, Array1::LinSpaced(n, 0.0, kLength), march_bulge(n, reach.mL_per_minute),
                  rows);
  }
}

std::vector<std::array<double, 4>> own_reference(const std::string& name) {
  const auto path = std::filesystem::path(test_paths::source) / "tests/reference" / name;
  std::vector<std::array<double, 4>> rows;
  for (const auto& row : read_table(path)) rows.push_back({row[0], row[1], row[2], row[3]});
  return rows;
}

TEST(PlaneMarch, IsNavierStokesBetweenTheFlowRatesOfTheReference) {
  // Found values rounded up; the target at 20 mL/min was 0.1.
  for (const Reach& reach :
       {Reach{"plane_bulge_Q20.csv", 20.0, 0.070, 0.050, 0.090, 0.035},
        Reach{"plane_bulge_Q20_lead_in.csv", 20.0, 0.030, 0.025, 0.040, 0.040}}) {
    const auto rows = own_reference(reach.file);
    ASSERT_GT(rows.size(), 30u);
    const Index n = 1001;
    expect_within(reach, Array1::LinSpaced(n, 0.0, kLength), march_bulge(n, reach.mL_per_minute),
                  rows);
  }
}

TEST(PlaneMarch, IsWorstWhereTheInletForbidsTheFlowThatTheRoofAsksFor) {
  // A roof that leaves the rim with a slope of 0.14: 1.4 % in the mean with v = 0 forced there, 0.4
  // % behind a straight lead-in. So what is off at a steep inlet is the inlet, not the march. The
  // pressure across the stream (1 %) is overestimated next to the kink.
  const Index n = 1001;
  const Array1 x = Array1::LinSpaced(n, 0.0, kLength);
  const double end = 0.6e-3;
  const Array1 gap = 244e-6 + 86e-6 * (1.0 - 0.75 * x / kLength) * (1.0 - (-x / end).exp()) *
                                  (1.0 - (-(kLength - x) / end).exp());
  const PlaneMarch march = march_plane(x, gap, Array1::Ones(n), flow_per_width(50.0), kWater);
  EXPECT_FALSE(march.first_separated.has_value());
  for (const Reach& reach : {Reach{"plane_steep_Q50.csv", 50.0, 1.5, 2.4, 1.3, 1.4},
                             Reach{"plane_steep_Q50_lead_in.csv", 50.0, 0.40, 1.0, 0.40, 0.30}}) {
    const auto rows = own_reference(reach.file);
    ASSERT_GT(rows.size(), 30u);
    expect_within(reach, x, march, rows);
  }
}

TEST(PlaneMarch, IsNavierStokesUnderAClampedWallOfTheSizesOfS4) {
  // The same sizes, but the roof leaves the rim without a slope.
  const Index n = 1001;
  const Array1 x = Array1::LinSpaced(n, 0.0, kLength);
  const auto rise = [](const Array1& s) {
    return Array1(1.0 - (-s / 0.4e-3).exp() * (1.0 + s / 0.4e-3));
  };
  const Array1 gap = 244e-6 + 86e-6 * (1.0 - 0.75 * x / kLength) * rise(x) * rise(kLength - x);
  const PlaneMarch march = march_plane(x, gap, Array1::Ones(n), flow_per_width(50.0), kWater);
  for (const Reach& reach :
       {Reach{"plane_clamped_Q50.csv", 50.0, 0.26, 0.57, 0.23, 0.49},
        Reach{"plane_clamped_Q50_lead_in.csv", 50.0, 0.13, 0.45, 0.28, 0.39}}) {
    const auto rows = own_reference(reach.file);
    ASSERT_GT(rows.size(), 30u);
    expect_within(reach, x, march, rows);
  }
}

TEST(PlaneMarch, DevelopsFromAUniformInletAsNavierStokes) {
  for (const double rate : {5.0, 70.0}) {
    const auto path = shared_file(rate == 5.0 ? "data/flow/caseA3_sliplead_Q5.csv"
                                              : "data/flow/caseA3_sliplead_Q70.csv");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference flow " << path;
    const Index n = 601;
    const Array1 x = Array1::LinSpaced(n, 0.0, kLength);
    PlaneMarchOptions options;
    options.inlet = InletProfile::uniform;
    options.degree = 40;
    const PlaneMarch march = march_plane(x, Array1::Constant(n, kHeight), Array1::Ones(n),
                                         flow_per_width(rate), kWater, options);
    const auto rows = read_table(path);
    // The reference's flow leaves a lead-in without friction, where it senses what comes: 0.12 % at
    // 0.78 mm and 70 mL/min, less downstream. At 5 mL/min it is developed there, to round-off.
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const double error = (at(x, march.pressure, rows[i][0]) - rows[i][5]) / rows[1][5];
      EXPECT_LT(std::abs(error), rate == 5.0 ? 1e-5 : 1.3e-3) << rows[i][0];
      if (rows[i][0] > 3e-3) {
        EXPECT_LT(std::abs(error), 3e-4) << rows[i][0];
      }
    }
  }
}

TEST(PlaneMarch, SaysWhereTheFlowSeparates) {
  // A gap that doubles within 0.3 mm at 70 mL/min: Re h' = 680 * 0.6.
  const Index n = 801;
  const Array1 x = Array1::LinSpaced(n, 0.0, kLength);
  const Array1 gap = kHeight * (1.5 + 0.5 * ((x - 5e-3) / 0.15e-3).tanh());
  const PlaneMarch march = march_plane(x, gap, Array1::Ones(n), flow_per_width(70.0), kWater);
  ASSERT_TRUE(march.first_separated.has_value());
  const double where = x(*march.first_separated);
  EXPECT_GT(where, 4.5e-3);
  EXPECT_LT(where, 5.5e-3);
  EXPECT_EQ(march.flags(*march.first_separated - 1), 0);
  EXPECT_NE(march.flags(n - 1) & MarchFlag::after_separation, 0);
  EXPECT_TRUE((march.flags(n - 1) & MarchFlag::no_answer) != 0 || std::isfinite(march.pressure(0)));
  // The same gap at a hundredth of the flow rate keeps its flow attached.
  const PlaneMarch slow = march_plane(x, gap, Array1::Ones(n), flow_per_width(0.7), kWater);
  EXPECT_FALSE(slow.first_separated.has_value());
}

TEST(PlaneMarch, RefusesWhatItCannotMarch) {
  const Array1 x = Array1::LinSpaced(5, 0.0, 1e-3), gap = Array1::Constant(5, 1e-4),
               one = Array1::Ones(5);
  EXPECT_THROW(march_plane(x, gap, one, -1.0, kWater), InputError);
  EXPECT_THROW(march_plane(x, gap.head(4), one, 1e-6, kWater), InputError);
  EXPECT_THROW(march_plane(x, -gap, one, 1e-6, kWater), InputError);
  EXPECT_THROW(march_plane(-x, gap, one, 1e-6, kWater), InputError);
  PlaneMarchOptions options;
  options.degree = 2;
  EXPECT_THROW(march_plane(x, gap, one, 1e-6, kWater, options), InputError);
}

}  // namespace
}  // namespace manoscope::flow
