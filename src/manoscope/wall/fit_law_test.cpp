#include "manoscope/wall/fit_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::wall {
namespace {

WallSection nitride() { return {1.7 * mm, 0.2 * um, 250.0 * GPa, 0.23, 80.0 * MPa}; }
WallSection silicone() { return {1.7 * mm, 200.0 * um, 1.5 * MPa, 0.49, 10.0 * kPa, 5.0 / 6.0}; }

/// Virtual calibration: law at true pressures, normal errors added if a stream is given.
HydrostaticData calibration(const AnyWallLaw& law, double lowest, double highest, Index n,
                            double sigma_p, double sigma_z, RandomStream* random) {
  HydrostaticData data;
  data.pressure = Array1::LinSpaced(n, lowest, highest);
  data.deflection =
      data.pressure.unaryExpr([&](double p) { return deflection(law, Pressure::from_si(p)).si(); });
  data.sigma_pressure = Array1::Constant(n, sigma_p);
  data.sigma_deflection = Array1::Constant(n, sigma_z);
  if (random != nullptr) {
    for (Index i = 0; i < n; ++i) {
      data.pressure(i) += sigma_p * random->normal();
      data.deflection(i) += sigma_z * random->normal();
    }
  }
  return data;
}

TEST(FitLaw, FindsTheWallFromExactDataWhereverItStarts) {
  const struct {
    LawKind kind;
    WallSection truth;
    double highest;
  } rows[] = {{LawKind::long_membrane, nitride(), 20e3},
              {LawKind::plate_strip, nitride(), 20e3},
              {LawKind::plate_strip, silicone(), 5e3},
              {LawKind::circular_membrane, nitride(), 20e3},
              {LawKind::square_membrane, nitride(), 20e3}};
  for (const auto& row : rows) {
    const AnyWallLaw law = make_wall_law(row.kind, row.truth);
    const HydrostaticData data =
        calibration(law, 0.02 * row.highest, row.highest, 12, 5.0, 20e-9, nullptr);
    for (const double factor : {0.3, 1.0, 4.0}) {
      WallSection start = row.truth;
      start.youngs_modulus = factor * start.youngs_modulus;
      start.prestress = Pressure{};
      const LawFit fit = fit_law(row.kind, start, data);
      EXPECT_TRUE(fit.converged) << name(row.kind) << factor;
      // The solver's tolerance, not noise: data are exact.
      EXPECT_NEAR(fit.section.youngs_modulus / row.truth.youngs_modulus, 1.0, 1e-5)
          << name(row.kind) << factor;
      EXPECT_NEAR(fit.section.prestress / row.truth.prestress, 1.0, 1e-4)
          << name(row.kind) << factor;
      EXPECT_LT(fit.chi2, 1e-6);
      EXPECT_EQ(fit.n_dof, 10);
      EXPECT_EQ(fit.n_undetermined, 0);
    }
  }
}

/// Mean and spread of pulls, and coverage of +-1 and +-2 sigma, over virtual calibrations.
struct Pulls {
  int n = 0, within_1 = 0, within_2 = 0;
  double sum = 0.0, squares = 0.0;
  void add(const FitParameter& found, double truth) {
    const double pull = (found.value - truth) / found.sigma;
    ++n;
    within_1 += std::abs(pull) < 1.0;
    within_2 += std::abs(pull) < 2.0;
    sum += pull;
    squares += pull * pull;
  }
  /// Five standard errors of each at n = 600.
  void expect_standard_normal(const std::string& what) const {
    EXPECT_NEAR(sum / n, 0.0, 0.21) << what;
    EXPECT_NEAR(squares / n, 1.0, 0.29) << what;
    EXPECT_NEAR(double(within_1) / n, 0.683, 0.095) << what;
    EXPECT_NEAR(double(within_2) / n, 0.954, 0.043) << what;
  }
};

TEST(FitLaw, PullsAndCoverageHoldWithErrorsInBothVariables) {
  const struct {
    LawKind kind;
    WallSection truth;
    double highest, sigma_p, sigma_z;
  } rows[] = {
      // Errors in pressure count as much as those in deflection (3 nm/Pa and 6 nm/Pa here). E comes
      // out to 2 % and 4 %, where the laws are nearly linear over the errors.
      {LawKind::long_membrane, nitride(), 5e3, 30.0, 60e-9},
      {LawKind::plate_strip, silicone(), 20e3, 20.0, 100e-9},
  };
  const int n_draws = 600;
  for (const auto& row : rows) {
    const AnyWallLaw law = make_wall_law(row.kind, row.truth);
    RandomStream random(17, name(row.kind));
    Pulls modulus, prestress;
    double chi2 = 0.0;
    for (int i = 0; i < n_draws; ++i) {
      const HydrostaticData data =
          calibration(law, 0.02 * row.highest, row.highest, 14, row.sigma_p, row.sigma_z, &random);
      const LawFit fit = fit_law(row.kind, row.truth, data);
      ASSERT_TRUE(fit.converged);
      ASSERT_FALSE(fit.parameters[0].at_bound || fit.parameters[1].at_bound);
      modulus.add(fit.parameters[0], row.truth.youngs_modulus.si());
      prestress.add(fit.parameters[1], row.truth.prestress.si());
      chi2 += fit.chi2;
    }
    modulus.expect_standard_normal("E");
    prestress.expect_standard_normal("s0");
    // Mean chi2 is n - k = 12, its standard error sqrt(24/600) = 0.2.
    EXPECT_NEAR(chi2 / n_draws, 12.0, 1.0) << name(row.kind);
  }
}

TEST(FitLaw, CovarianceIsTheSpreadOfTheEstimates) {
  const AnyWallLaw law = make_wall_law(LawKind::long_membrane, nitride());
  RandomStream random(29, "covariance");
  const int n_draws = 400;
  Matrix spread = Matrix::Zero(2, 2), stated = Matrix::Zero(2, 2);
  const double e = nitride().youngs_modulus.si(), s = nitride().prestress.si();
  for (int i = 0; i < n_draws; ++i) {
    const LawFit fit = fit_law(LawKind::long_membrane, nitride(),
                               calibration(law, 100.0, 5e3, 14, 30.0, 60e-9, &random));
    const Eigen::Vector2d off(fit.parameters[0].value / e - 1.0, fit.parameters[1].value / s - 1.0);
    spread += off * off.transpose() / n_draws;
    const Eigen::Vector2d unit(1.0 / e, 1.0 / s);
    stated += unit.asDiagonal() * fit.covariance * unit.asDiagonal() / n_draws;
  }
  const double expected = stated(0, 1) / std::sqrt(stated(0, 0) * stated(1, 1));
  const double found = spread(0, 1) / std::sqrt(spread(0, 0) * spread(1, 1));
  EXPECT_LT(expected, -0.5);  // stiffer or tighter: they trade
  // Standard error of a correlation (1 - r^2)/sqrt(400) < 0.04.
  EXPECT_NEAR(found, expected, 0.15);
  EXPECT_NEAR(std::sqrt(spread(0, 0) / stated(0, 0)), 1.0, 0.18);  // five of 1/sqrt(800)
}

TEST(FitLaw, PreloadIsFoundBesideTheModulus) {
  const AnyWallLaw law = make_wall_law(LawKind::long_membrane, nitride());
  HydrostaticData data = calibration(law, -200.0, 5e3, 20, 2.0, 10e-9, nullptr);
  data.pressure += 150.0;  // the wall answers to p - 150 Pa
  FitLawOptions options;
  options.preload = true;
  const LawFit fit = fit_law(LawKind::long_membrane, nitride(), data, options);
  EXPECT_NEAR(fit.preload.si(), 150.0, 1e-3);
  EXPECT_NEAR(fit.section.prestress / nitride().prestress, 1.0, 1e-4);
  ASSERT_NE(fit.find("preload"), nullptr);
  EXPECT_TRUE(fit.find("preload")->determined);
  EXPECT_EQ(fit.find("thickness"), nullptr);
}

TEST(FitLaw, ThicknessIsFoundOnlyWhereBendingAndStretchingAreBothSeen) {
  WallSection wall{1.7 * mm, 20.0 * um, 100.0 * GPa, 0.25};
  FitLawOptions options;
  options.thickness = true;
  options.prestress = false;
  const PlateStrip law(wall);
  // From a thousandth to three thicknesses: E t^3 of the start, E t of the end.
  const double high = law.pressure(60.0 * um).si();
  const LawFit both =
      fit_law(LawKind::plate_strip, wall,
              calibration(law, 1e-3 * high, high, 20, 0.0, 20e-9, nullptr), options);
  EXPECT_EQ(both.n_undetermined, 0);
  EXPECT_TRUE(both.find("thickness")->determined);
  EXPECT_LT(both.find("thickness")->sigma, 0.05 * 20e-6);
  // Small deflections know E t^3 alone.
  const double low = law.pressure(0.02 * um).si();
  const HydrostaticData bent = calibration(law, 0.1 * low, low, 20, 0.0, 0.1e-9, nullptr);
  const LawFit ridge = fit_law(LawKind::plate_strip, wall, bent, options);
  EXPECT_EQ(ridge.n_undetermined, 1);
  EXPECT_FALSE(ridge.find("thickness")->determined);
  EXPECT_FALSE(ridge.find("youngs_modulus")->determined);
  EXPECT_TRUE(ridge.covariance.allFinite());
  // What the bounds leave on the ridge ln E = -3 ln t: t from half to twice has sigma 2 ln 2 /
  // sqrt(12) = 0.400 in ln, E from a tenth to ten times 1.329: 1/sqrt(0.4^-2 + 9/1.329^2) = 0.297.
  EXPECT_NEAR(ridge.find("thickness")->sigma / ridge.find("thickness")->value, 0.297, 0.002);
  // The stiffness they share is as good as the data: its error in ln is far below one.
  const double e = ridge.find("youngs_modulus")->value, t = ridge.find("thickness")->value;
  const Eigen::Vector2d gradient(1.0 / e, 3.0 / t);
  EXPECT_LT(std::sqrt(gradient.dot(ridge.covariance * gradient)), 0.01);
}

TEST(FitLaw, ModulusIsNotClaimedWherePrestressCarriesEverything) {
  WallSection tight = nitride();
  tight.prestress = 500.0 * MPa;
  const AnyWallLaw law = make_wall_law(LawKind::long_membrane, tight);
  const LawFit fit =
      fit_law(LawKind::long_membrane, tight, calibration(law, 1.0, 20.0, 10, 0.1, 1e-9, nullptr));
  EXPECT_EQ(fit.n_undetermined, 1);
  EXPECT_FALSE(fit.find("youngs_modulus")->determined);
  EXPECT_TRUE(fit.find("prestress")->determined);
  EXPECT_LT(fit.find("prestress")->sigma, 0.05 * 500e6);
}

TEST(FitLaw, StaysWithinItsBoundsAndSaysSo) {
  const AnyWallLaw law = make_wall_law(LawKind::long_membrane, nitride());
  FitLawOptions options;
  options.youngs_modulus_range = PressureRange{260.0 * GPa, 280.0 * GPa};
  const LawFit fit = fit_law(LawKind::long_membrane, nitride(),
                             calibration(law, 100.0, 20e3, 12, 5.0, 20e-9, nullptr), options);
  EXPECT_NEAR(fit.find("youngs_modulus")->value, 260e9, 1e3);
  EXPECT_TRUE(fit.find("youngs_modulus")->at_bound);
  EXPECT_FALSE(fit.find("prestress")->at_bound);
}

TEST(FitLaw, TakesExactPressuresAndTheUnloadedPointOfASlackMembrane) {
  WallSection slack = nitride();
  slack.prestress = Pressure{};
  const AnyWallLaw law = make_wall_law(LawKind::long_membrane, slack);
  const LawFit fit =
      fit_law(LawKind::long_membrane, slack, calibration(law, 0.0, 5e3, 11, 0.0, 20e-9, nullptr));
  EXPECT_NEAR(fit.section.youngs_modulus.in(GPa), 250.0, 0.01);
  EXPECT_TRUE((fit.pressure == Array1::LinSpaced(11, 0.0, 5e3)).all());
}

TEST(FitLaw, SameInputGivesTheSameBytes) {
  RandomStream random(2, "bytes");
  const AnyWallLaw law = make_wall_law(LawKind::plate_strip, silicone());
  const HydrostaticData data = calibration(law, 100.0, 4e3, 12, 10.0, 1e-7, &random);
  const LawFit one = fit_law(LawKind::plate_strip, silicone(), data);
  const LawFit two = fit_law(LawKind::plate_strip, silicone(), data);
  EXPECT_EQ(one.chi2, two.chi2);
  EXPECT_TRUE(one.covariance == two.covariance);
  EXPECT_TRUE((one.residual == two.residual).all());
}

TEST(FitLaw, RefusesWhatItCannotFit) {
  const AnyWallLaw law = make_wall_law(LawKind::long_membrane, nitride());
  const HydrostaticData good = calibration(law, 100.0, 5e3, 8, 1.0, 1e-8, nullptr);
  const auto refused = [&](auto change, const FitLawOptions& options = {}) {
    HydrostaticData data = good;
    change(data);
    EXPECT_THROW(fit_law(LawKind::long_membrane, nitride(), data, options), InputError);
  };
  refused([](HydrostaticData& d) { d.deflection.conservativeResize(7); });
  refused([](HydrostaticData& d) { d.pressure(2) = std::nan(""); });
  refused([](HydrostaticData& d) { d.sigma_deflection(0) = 0.0; });
  refused([](HydrostaticData& d) { d.sigma_pressure(0) = -1.0; });
  refused([](HydrostaticData& d) {
    d = {d.pressure.head(2), d.sigma_pressure.head(2), d.deflection.head(2),
         d.sigma_deflection.head(2)};
  });
  refused([](HydrostaticData& d) { d = {}; });
  FitLawOptions upside_down;
  upside_down.youngs_modulus_range = PressureRange{2.0 * GPa, 1.0 * GPa};
  refused([](HydrostaticData&) {}, upside_down);
  FitLawOptions negative;
  negative.youngs_modulus_range = PressureRange{-2.0 * GPa, 1.0 * GPa};
  refused([](HydrostaticData&) {}, negative);
  WallSection compressed = nitride();
  compressed.prestress = -1000.0 * MPa;
  FitLawOptions held;
  held.prestress = false;
  EXPECT_THROW(fit_law(LawKind::plate_strip, compressed, good, held), InputError);
}

}  // namespace
}  // namespace manoscope::wall
