#include "manoscope/flow/channel_resistance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "manoscope/core/error.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::flow {
namespace {

const Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};
const Fluid kWater{1.0 * mPa_s, 998.0 * kg_per_m3};
const FlowRate kFlowRate = 20.0 * mL_per_min;

double bulge(double x) {
  const double l = 15.5e-3, end = 0.6e-3;
  return 33e-6 * (1.0 - 0.6 * x / l) * (1.0 - std::exp(-x / end)) *
         (1.0 - std::exp(-(l - x) / end));
}

/// Stations on [0, l], closer together near the inlet.
Array1 graded_stations(Index n) {
  const Array1 s = Array1::LinSpaced(n, 0.0, 1.0);
  return 15.5e-3 * (0.5 * s + 0.5 * s * s);
}

/// The same drop by Simpson's rule on 20000 even steps: fourth order, far below every tolerance.
double reference_drop(double x1, double x2) {
  const int n = 20000;
  double sum = 0.0;
  for (int i = 0; i <= n; ++i) {
    const double x = x1 + (x2 - x1) * i / n;
    const double h = 175e-6 + bulge(x), w = 1.7e-3;
    const double r = 12.0 * 1e-3 / (w * h * h * h) / (1.0 - 0.63 * h / w);
    sum += (i == 0 || i == n ? 1.0 : i % 2 ? 4.0 : 2.0) * r;
  }
  return kFlowRate.si() * sum * (x2 - x1) / n / 3.0;
}

TEST(IntervalWeights, IntegrateStraightLinesExactlyBetweenAnyBounds) {
  const Array1 x = graded_stations(23);
  const Array1 line = 2.0 + 300.0 * x;
  for (const auto& [x1, x2] : {std::pair{0.0, 15.5e-3}, {1.6e-3, 13e-3}, {4.01e-3, 4.02e-3}}) {
    const Array1 weights = interval_weights(x, Length::from_si(x1), Length::from_si(x2));
    const double exact = 2.0 * (x2 - x1) + 150.0 * (x2 * x2 - x1 * x1);
    EXPECT_NEAR((weights * line).sum() / exact, 1.0, 1e-13);
    EXPECT_NEAR(weights.sum(), x2 - x1, 1e-16);
  }
}

TEST(IntervalWeights, ReachHalfAPixelBeyondTheOuterStations) {
  const Array1 x = Array1::LinSpaced(100, 0.5, 99.5);
  const Array1 weights = interval_weights(x, Length{}, Length::from_si(100.0));
  EXPECT_NEAR(weights.sum(), 100.0, 1e-12);
  EXPECT_NEAR((weights - 1.0).abs().maxCoeff(), 0.0, 1e-12);  // pixel centres: the midpoint rule
  EXPECT_THROW(interval_weights(x, Length::from_si(-1.0), Length::from_si(50.0)), InputError);
  EXPECT_THROW(interval_weights(x, Length::from_si(1.0), Length::from_si(101.0)), InputError);
}

TEST(IntervalWeights, RefuseStationsOutOfOrder) {
  Array1 x(3);
  x << 0.0, 2.0, 1.0;
  EXPECT_THROW(interval_weights(x, Length{}, Length::from_si(1.0)), InputError);
  x << 0.0, 1.0, 1.0;
  EXPECT_THROW(interval_weights(x, Length{}, Length::from_si(1.0)), InputError);
  EXPECT_THROW(interval_weights(Array1::Zero(1), Length{}, Length::from_si(1.0)), InputError);
  x << 0.0, 1.0, 2.0;
  EXPECT_THROW(interval_weights(x, Length::from_si(1.0), Length::from_si(1.0)), InputError);
}

TEST(ResistanceDrop, ConvergesWithSecondOrderOnUnevenStations) {
  const double exact = reference_drop(1.6e-3, 13.0e-3);
  double before = 0.0;
  for (const Index n : {101, 201, 401}) {
    const Array1 x = graded_stations(n);
    const double drop = resistance_drop(kChannel, kWater.viscosity, kFlowRate, x,
                                        x.unaryExpr(&bulge), 1.6 * mm, 13.0 * mm)
                            .drop.si();
    const double error = std::abs(drop - exact);
    EXPECT_LT(error, 2e-4 * exact);
    // Second order gives 4; the bounds fall at varying places between stations, hence the band.
    if (before > 0.0) {
      EXPECT_NEAR(before / error, 4.0, 1.0);
    }
    before = error;
  }
}

TEST(ResistanceDrop, IsSumOfItsParts) {
  const Array1 x = graded_stations(60), zeta = x.unaryExpr(&bulge);
  const auto drop = [&](Length a, Length b) {
    return resistance_drop(kChannel, kWater.viscosity, kFlowRate, x, zeta, a, b).drop.si();
  };
  EXPECT_NEAR(drop(0.0 * mm, 5.0 * mm) + drop(5.0 * mm, 15.5 * mm), drop(0.0 * mm, 15.5 * mm),
              1e-9);
  const Array1 running = running_resistance_drop(kChannel, kWater.viscosity, kFlowRate, x, zeta);
  EXPECT_EQ(running(0), 0.0);
  EXPECT_NEAR(running(59), drop(0.0 * mm, 15.5 * mm), 1e-9);
  EXPECT_NEAR(running(30), drop(0.0 * mm, Length::from_si(x(30))), 1e-9);
}

TEST(ResistanceDrop, GradientsAreDerivatives) {
  const Array1 x = graded_stations(40), zeta = x.unaryExpr(&bulge);
  for (const DuctFormula formula : {DuctFormula::wide_duct, DuctFormula::series}) {
    const auto drop = [&](const Channel& channel, const Array1& deflection) {
      return resistance_drop(channel, kWater.viscosity, kFlowRate, x, deflection, 1.6 * mm,
                             13.0 * mm, formula);
    };
    const ResistanceDrop here = drop(kChannel, zeta);
    const double step = 1e-9;
    for (Index i = 0; i < x.size(); ++i) {
      Array1 up = zeta, down = zeta;
      up(i) += step;
      down(i) -= step;
      const double difference =
          (drop(kChannel, up).drop.si() - drop(kChannel, down).drop.si()) / (2.0 * step);
      // Round-off of the difference: 4000 Pa * 1e-15 / 1e-9 m = 4e-3 Pa/m of 1e6 Pa/m.
      EXPECT_NEAR(here.zeta_gradient(i), difference, 0.1) << i;
    }
    Channel higher = kChannel, lower = kChannel;
    higher.height += 1.0 * nm;
    lower.height -= 1.0 * nm;
    const double difference =
        (drop(higher, zeta).drop.si() - drop(lower, zeta).drop.si()) / (2.0 * step);
    EXPECT_NEAR(here.height_gradient / difference, 1.0, 1e-7);
    // The physics behind it: r ~ h^-3, so a micrometre is 1.5 to 1.8 % of the drop here.
    EXPECT_NEAR(-here.height_gradient * 1e-6 / here.drop.si(), 0.0162, 0.0016);
  }
}

TEST(ResistanceDrop, RefusesProfilesThatDoNotFit) {
  const Array1 x = graded_stations(10);
  const auto drop = [&](const Channel& channel, const Array1& zeta) {
    return resistance_drop(channel, kWater.viscosity, kFlowRate, x, zeta, 1.6 * mm, 13.0 * mm);
  };
  EXPECT_THROW(drop(kChannel, Array1::Zero(9)), InputError);
  EXPECT_THROW(drop(kChannel, Array1::Constant(10, -176e-6)),
               InputError);  // wall through the floor
  EXPECT_THROW(drop(Channel{15.5 * mm, 1.7 * mm, Length{}}, Array1::Zero(10)), InputError);
}

TEST(ChannelReynolds, OfAFlatChannelIsTheFormulaOfTableOne) {
  const Array1 x = graded_stations(10);
  const Fluid fluid{1.0 * mPa_s, 1000.0 * kg_per_m3};  // nu = 1e-6 m2/s
  const double re = channel_reynolds(kChannel, fluid, 70.0 * mL_per_min, x, Array1::Zero(10));
  EXPECT_NEAR(re, 2.0 * 70e-6 / 60.0 / (1e-6 * (1.7e-3 + 175e-6)), 1e-9);
  EXPECT_NEAR(re, 1200.0, 60.0);  // table I, S1 at its largest flow rate, rounded to two digits
}

TEST(ChannelReynolds, AgreesWithAnIndependentExperiment) {
  const auto folder = std::filesystem::path(test_paths::shared) / "data/practice/S1/truth";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no practice experiment " << folder;
  std::ifstream file(folder / "truth.csv");
  std::string line;
  std::getline(file, line);
  std::vector<double> x, zeta;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    x.push_back(row.front() * 1e-3);
    zeta.push_back(row.back() * 1e-6);  // the last column: 70 mL/min
  }
  const auto n = static_cast<Index>(x.size());
  const Fluid fluid{1.0 * mPa_s, 1000.0 * kg_per_m3};
  const double re = channel_reynolds(Channel{15.5 * mm, 1.7 * mm, 175.0 * um}, fluid,
                                     70.0 * mL_per_min, Eigen::Map<const Array1>(x.data(), n),
                                     Eigen::Map<const Array1>(zeta.data(), n));
  EXPECT_NEAR(re, 1227.2, 2.0);  // Re_mean there; its height may differ by 1 um, 0.05 % of Re
}

}  // namespace
}  // namespace manoscope::flow
