#include "manoscope/flow/duct_resistance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::flow {
namespace {

/// The Fourier series summed term by term; the tail beyond n = 4000 is below 1e-15.
double brute_force_factor(double ratio) {
  double sum = 0.0;
  for (int n = 3999; n >= 1; n -= 2) {
    sum += std::tanh(0.5 * n * std::numbers::pi / ratio) / std::pow(n, 5);
  }
  return 1.0 - 192.0 / std::pow(std::numbers::pi, 5) * ratio * sum;
}

TEST(DuctResistance, SeriesEqualsItsTermByTermSum) {
  for (const double ratio : {1e-6, 0.01, 0.05, 0.1, 0.3, 0.5, 0.8, 1.0}) {
    // Round-off: both sums carry a few units in the last place of 1.
    EXPECT_NEAR(duct_flow_factor(ratio, DuctFormula::series), brute_force_factor(ratio), 2e-14)
        << "h/w = " << ratio;
  }
}

TEST(DuctResistance, OfADuctTurnedOverIsTheSame) {
  const double flat = duct_resistance(1.0 * mPa_s, 2.0 * mm, 0.5 * mm, DuctFormula::series);
  const double tall = duct_resistance(1.0 * mPa_s, 0.5 * mm, 2.0 * mm, DuctFormula::series);
  EXPECT_NEAR(tall / flat, 1.0, 1e-13);
}

TEST(DuctResistance, OfASquareDuctIsThePublishedOne) {
  // f Re = 14.227 on the hydraulic diameter (Shah & London 1978, square duct), Fanning friction:
  // r = 2 f Re eta / (A Dh^2) = 2 * 14.227 eta / a^4; the table's last digit gives 4e-5.
  const double r = duct_resistance(1.0 * mPa_s, 1.0 * mm, 1.0 * mm, DuctFormula::series);
  EXPECT_NEAR(r * 1e-12 / 1e-3, 2.0 * 14.227, 2.0 * 0.0005);
}

TEST(DuctResistance, TendsToParallelPlatesForAThinGap) {
  const double r =
      duct_resistance(1.0 * mPa_s, Length::from_si(1.0), 1.0 * um, DuctFormula::series);
  EXPECT_NEAR(r / (12.0 * 1e-3 / 1e-18), 1.0, 1e-6);  // side walls: 0.63 h/w = 6.3e-7
}

TEST(DuctResistance, OfEquationFourStaysWithinItsStatedErrorOfTheSeries) {
  struct Claim {
    double h_over_w, low, high;
  };
  // The bands of the docstring of duct_flow_factor().
  for (const Claim& claim :
       {Claim{0.01, -8e-5, 0.0}, Claim{0.05, -8e-5, 0.0}, Claim{0.1, -2.75e-5, -2.55e-5},
        Claim{0.25, -8e-5, 0.0}, Claim{0.3, -8e-5, 8e-5}, Claim{0.35, -8e-5, 8e-5},
        Claim{0.5, 1.4e-3, 1.6e-3}, Claim{1.0, 0.135, 0.145}}) {
    const Length w = 2.0 * mm, h = claim.h_over_w * w;
    const double error = duct_resistance(1.0 * mPa_s, w, h) /
                             duct_resistance(1.0 * mPa_s, w, h, DuctFormula::series) -
                         1.0;
    EXPECT_GE(error, claim.low) << claim.h_over_w;
    EXPECT_LE(error, claim.high) << claim.h_over_w;
  }
}

TEST(DuctResistance, OfEquationFourIsTheFormulaOfThePaper) {
  const double h = 0.2e-3, w = 1.7e-3, eta = 0.89e-3;
  EXPECT_DOUBLE_EQ(duct_resistance(0.89 * mPa_s, 1.7 * mm, 0.2 * mm),
                   1.0 / (1.0 - 0.63 * h / w) * 12.0 * eta / (w * h * h * h));
}

TEST(DuctResistance, SlopeIsTheDerivative) {
  for (const DuctFormula formula : {DuctFormula::wide_duct, DuctFormula::series}) {
    for (const double h : {20e-6, 175e-6, 0.8e-3, 1.69e-3, 3e-3}) {
      if (formula == DuctFormula::wide_duct && h > 1.7e-3) continue;
      const double step = 1e-5 * h;
      const auto r = [&](double gap) {
        return duct_resistance(1.0 * mPa_s, 1.7 * mm, Length::from_si(gap), formula);
      };
      const double difference = (r(h + step) - r(h - step)) / (2.0 * step);
      const double slope =
          duct_resistance_slope(1.0 * mPa_s, 1.7 * mm, Length::from_si(h), formula);
      // Central difference: truncation about 10 step^2/h^2 = 1e-9, round-off eps/1e-5 = 2e-11.
      EXPECT_NEAR(slope / difference, 1.0, 5e-9) << "gap " << h;
    }
  }
}

TEST(DuctResistance, OfManyGapsIsThatOfEach) {
  const Array1 gap = Array1::LinSpaced(7, 100e-6, 250e-6);
  for (const DuctFormula formula : {DuctFormula::wide_duct, DuctFormula::series}) {
    const Array1 r = duct_resistance(1.0 * mPa_s, 1.7 * mm, gap, formula);
    const Array1 slope = duct_resistance_slope(1.0 * mPa_s, 1.7 * mm, gap, formula);
    for (Index i = 0; i < gap.size(); ++i) {
      const Length h = Length::from_si(gap(i));
      EXPECT_EQ(r(i), duct_resistance(1.0 * mPa_s, 1.7 * mm, h, formula));
      EXPECT_EQ(slope(i), duct_resistance_slope(1.0 * mPa_s, 1.7 * mm, h, formula));
    }
  }
}

TEST(DuctResistance, RefusesAGapOutsideItsRangeAndNamesTheStation) {
  EXPECT_THROW(duct_resistance(1.0 * mPa_s, 1.7 * mm, Length{}), InputError);
  EXPECT_THROW(duct_resistance(1.0 * mPa_s, 1.7 * mm, -1.0 * um), InputError);
  EXPECT_THROW(duct_resistance(1.0 * mPa_s, 1.7 * mm, 1.8 * mm), InputError);
  EXPECT_NO_THROW(duct_resistance(1.0 * mPa_s, 1.7 * mm, 1.8 * mm, DuctFormula::series));
  EXPECT_THROW(duct_resistance(Viscosity{}, 1.7 * mm, 1.0 * um), InputError);
  EXPECT_THROW(duct_resistance(1.0 * mPa_s, -1.0 * mm, 1.0 * um), InputError);
  Array1 gap(3);
  gap << 100e-6, -3e-6, 100e-6;
  try {
    duct_resistance(1.0 * mPa_s, 1.7 * mm, gap);
    FAIL() << "a negative gap passed";
  } catch (const InputError& error) {
    EXPECT_NE(error.found().find("station 1 is -3 um"), std::string::npos) << error.what();
  }
}

TEST(DuctResistance, AgreesWithTheReferenceTableOfRectangles) {
  const auto path = std::filesystem::path(test_paths::shared) / "data/flow/caseC.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference table " << path;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  int rows = 0;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    ASSERT_GE(row.size(), 4u);
    const double ratio = row[0];
    // The table holds ten digits.
    EXPECT_NEAR(duct_flow_factor(ratio, DuctFormula::series), row[1], 1e-10) << ratio;
    const Length w = 1.7 * mm, h = ratio * w;
    const double error = duct_resistance(1.0 * mPa_s, w, h) /
                             duct_resistance(1.0 * mPa_s, w, h, DuctFormula::series) -
                         1.0;
    EXPECT_NEAR(error, row[3], 1e-10) << ratio;
    ++rows;
  }
  EXPECT_GT(rows, 5);
}

}  // namespace
}  // namespace manoscope::flow
