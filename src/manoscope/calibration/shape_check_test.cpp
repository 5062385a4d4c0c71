#include "manoscope/calibration/shape_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "manoscope/calibration/shape_verdict.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::calibration {
namespace {

constexpr double kWidth = 1.7e-3, kLength = 15.5e-3, kNoise = 4e-9;
constexpr Index kStretches = 73, kBins = 16;
using Deformation = std::function<double(double x, double z)>;

/// Cells of a wall that passes from a plate to a membrane as pressure rises, linear in p^(1/2),
/// seen with noise and `added` to it.
class Wall {
 public:
  /// One station stands under p(x).
  CrossSections seen(const std::function<double(double)>& pressure, const Deformation& added = {}) {
    CrossSections cells;
    cells.x = Array1::LinSpaced(kStretches, 0.1e-3, kLength - 0.1e-3);
    cells.z = Array1::LinSpaced(kBins, -0.45 * kWidth, 0.45 * kWidth);
    cells.zeta = Array2(kBins, kStretches);
    for (Index b = 0; b < kBins; ++b) {
      for (Index j = 0; j < kStretches; ++j) {
        const double x = cells.x[j], z = cells.z[b];
        cells.zeta(b, j) = zeta(z, pressure(x)) + kNoise * random_.normal();
        if (added) cells.zeta(b, j) += added(x, z);
      }
    }
    cells.sigma = Array2::Constant(kBins, kStretches, kNoise);
    cells.flags = Flags2::Zero(kBins, kStretches);
    return cells;
  }
  CrossSections level(double pressure, const Deformation& added = {}) {
    return seen([pressure](double) { return pressure; }, added);
  }

  static double zeta(double z, double pressure) {
    const double u = 2.0 * z / kWidth, parabola = 1.0 - u * u;
    const double share = pressure / (pressure + 3000.0);
    return 4e-7 * std::sqrt(pressure) * parabola * (share + (1.0 - share) * 1.25 * parabola);
  }

 private:
  RandomStream random_{3, "wall"};
};

constexpr double kPressures[] = {0.0,    200.0,  450.0,  800.0,  1300.0,
                                 2000.0, 3000.0, 4400.0, 6300.0, 9000.0};

struct Calibration {
  std::vector<CrossSections> cells;
  std::vector<ShapedMap> levels;

  explicit Calibration(Wall& wall, Index spoilt = -1, const Deformation& added = {}) {
    for (const double pressure : kPressures) {
      const bool is_spoilt = static_cast<Index>(cells.size()) == spoilt;
      cells.push_back(wall.level(pressure, is_spoilt ? added : Deformation{}));
    }
    for (std::size_t k = 0; k < cells.size(); ++k) {
      levels.push_back({kPressures[k], &cells[k], 0.0, 1e-7});
    }
  }
};

/// Dust of 200 nm, a quarter of the width off the middle, 0.15 mm wide.
double dust(double x, double z) {
  const double dx = (x - 6e-3) / 0.15e-3, dz = (z - 0.25 * kWidth) / 0.15e-3;
  return 200e-9 * std::exp(-0.5 * (dx * dx + dz * dz));
}
double falling(double x) { return 7000.0 * (1.0 - x / kLength) + 400.0; }

ShapeVerdict verdict_on(const ShapeMisfit& misfit, const CrossSections& cells) {
  return shape_verdict(misfit, cells.x, 1.6e-3, 13.9e-3);
}

TEST(CalibratedShapes, SeldomBlameAMapThatIsBentByPressure) {
  Wall wall;
  const Calibration calibration(wall);
  const CalibratedShapes shapes(calibration.levels, kWidth);
  int n_blamed = 0;
  double chi_square = 0.0, dof = 0.0;
  constexpr int kTrials = 100;
  for (int trial = 0; trial < kTrials; ++trial) {
    const CrossSections run = wall.seen(falling);
    const ShapeVerdict verdict = verdict_on(shapes.misfit({0.0, &run, 0.0, 1e-7}), run);
    n_blamed += verdict.p_value < 0.05;
    chi_square += verdict.chi_square;
    dof += verdict.dof;
  }
  // 5 of 100 and three times the root of 5; the runs share the noise of the levels.
  EXPECT_LE(n_blamed, 12);
  EXPECT_NEAR(chi_square / dof, 1.0, 0.03);
}

TEST(CalibratedShapes, FindDustWhereItLiesAndWhatItDoesToTheReading) {
  Wall wall;
  const Calibration calibration(wall);
  const CalibratedShapes shapes(calibration.levels, kWidth);
  const CrossSections run = wall.seen(falling, dust);
  const ShapeMisfit misfit = shapes.misfit({0.0, &run, 0.0, 1e-7});
  const ShapeVerdict verdict = verdict_on(misfit, run);
  EXPECT_LT(verdict.p_value, 1e-12);
  EXPECT_GT(verdict.worst_end, 6.0e-3);
  EXPECT_LT(verdict.worst_start, 6.0e-3);
  EXPECT_LT(verdict.worst_end - verdict.worst_start, 1.3e-3);
  // Its average over the width where it is highest, over the wall's compliance there.
  double average = 0.0, rise = 0.0;
  Index at = 0;
  (run.x - 6e-3).abs().minCoeff(&at);
  for (const double z : run.z) {
    average += dust(run.x[at], z) / static_cast<double>(kBins);
    rise += (Wall::zeta(z, falling(6e-3) + 50.0) - Wall::zeta(z, falling(6e-3) - 50.0)) / 100.0 /
            static_cast<double>(kBins);
  }
  // The root mean square of a misfit of few bins is larger than its mean, but the free shapes take
  // a part of it.
  EXPECT_GT(verdict.reading_shift, 0.7 * average / rise);
  EXPECT_LT(verdict.reading_shift, 3.0 * average / rise);
}

TEST(CalibratedShapes, BlameALevelForItsOwnFaultAndNoRun) {
  Wall wall;
  const Index spoilt = 6;
  const Calibration calibration(wall, spoilt, dust);
  const CalibratedShapes shapes(calibration.levels, kWidth);
  for (Index k = 1; k + 1 < static_cast<Index>(calibration.levels.size()); ++k) {
    const double chance = verdict_on(shapes.misfit_of_level(k), calibration.cells[0]).p_value;
    if (k == spoilt) {
      EXPECT_LT(chance, 1e-12);
    } else {
      EXPECT_GT(chance, 1e-4) << k;
    }
  }
  // Under flow the wall has that level's average where the level has its dust.
  const double there = kPressures[spoilt];
  const auto through = [&](double x) { return there + 3e5 * (6e-3 - x); };
  const CrossSections run = wall.seen(through);
  EXPECT_GT(verdict_on(shapes.misfit({0.0, &run, 0.0, 1e-7}), run).p_value, 1e-4);
}

TEST(CalibratedShapes, AllowForAMapThatLiesElsewhereAcross) {
  Wall wall;
  const Calibration calibration(wall);
  const CalibratedShapes shapes(calibration.levels, kWidth);
  // 0.5 um: 40 nm at the sides of a wall of 30 um.
  const CrossSections run = wall.seen(falling, [](double x, double z) {
    return Wall::zeta(z + 0.5e-6, falling(x)) - Wall::zeta(z, falling(x));
  });
  EXPECT_GT(verdict_on(shapes.misfit({0.0, &run, 0.0, 1e-7}), run).p_value, 1e-3);
}

TEST(CalibratedShapes, SeeAnotherChannel) {
  Wall wall;
  const Calibration calibration(wall);
  const CalibratedShapes shapes(calibration.levels, kWidth);
  // The same averages, as a parabola.
  const CrossSections run =
      wall.seen([](double) { return 0.0; },
                [](double x, double z) {
                  double average = 0.0;
                  for (int i = 0; i < 64; ++i)
                    average += Wall::zeta(kWidth * (i - 31.5) / 64.0, falling(x)) / 64.0;
                  const double u = 2.0 * z / kWidth;
                  return 1.5 * average * (1.0 - u * u);
                });
  const ShapeVerdict verdict = verdict_on(shapes.misfit({0.0, &run, 0.0, 1e-7}), run);
  EXPECT_LT(verdict.p_value, 1e-12);
  EXPECT_GT(verdict.worst_end - verdict.worst_start, 5e-3);
}

TEST(CalibratedShapes, HaveNoVerdictWithoutEnoughLevelsOrCells) {
  Wall wall;
  const Calibration calibration(wall);
  const CalibratedShapes two({calibration.levels[3], calibration.levels[7]}, kWidth);
  CrossSections run = wall.seen(falling);
  EXPECT_TRUE(two.misfit({0.0, &run, 0.0, 1e-7}).chi_square.isNaN().all());
  const CalibratedShapes shapes(calibration.levels, kWidth);
  run.flags.setConstant(PixelFlag::no_data);
  const ShapeMisfit misfit = shapes.misfit({0.0, &run, 0.0, 1e-7});
  EXPECT_TRUE(misfit.chi_square.isNaN().all());
  const ShapeVerdict verdict = verdict_on(misfit, run);
  EXPECT_EQ(verdict.dof, 0.0);
  EXPECT_EQ(verdict.p_value, 1.0);
  // The outermost levels have no neighbours on one side.
  EXPECT_TRUE(shapes.misfit_of_level(0).chi_square.isNaN().all());
}

TEST(ShapeVerdict, StatesHowOftenChanceMakesAsLargeAMisfit) {
  RandomStream random(5, "verdict");
  constexpr int kTrials = 2000;
  int n_below = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    ShapeMisfit misfit;
    misfit.chi_square = misfit.reading_shift = Array1::Zero(50);
    misfit.dof = Array1::Constant(50, 10.0);
    for (double& value : misfit.chi_square) {
      for (int k = 0; k < 10; ++k) value += std::pow(random.normal(), 2);
    }
    n_below += shape_verdict(misfit, Array1::LinSpaced(50, 0.0, 1.0), 0.0, 1.0).p_value < 0.1;
  }
  // Two looks at the same numbers, each counted twice: at most 0.1, hardly less. 4 sigma of 200.
  EXPECT_LT(n_below, 0.1 * kTrials + 4.0 * std::sqrt(0.09 * kTrials));
  EXPECT_GT(n_below, 0.07 * kTrials);
}

}  // namespace
}  // namespace manoscope::calibration
