// Real pressurised membranes seen by image correlation: four specimens at 20 known pressures. Each
// interior pressure is left out in turn and read back off the curves of the others, pixel by pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/numerics/robust.hpp"
#include "tests/support/npy.hpp"
#include "tests/support/paths.hpp"

namespace manoscope {
namespace {

using calibration::Level;

constexpr std::size_t kLevels = 20, kPixels = 28 * 28, kComponents = 3;
constexpr std::array<double, kLevels> kPressureBar{
    0.0914, 0.2120, 0.3325, 0.4380, 0.5586, 0.6792, 0.7847, 0.9052, 1.0258, 1.1313,
    1.2518, 1.3724, 1.4930, 1.5985, 1.7190, 1.8396, 1.9451, 2.0656, 2.1862, 2.2917};
constexpr double kBar = 1e5, kHectopascal = 100.0;

std::filesystem::path folder() {
  return std::filesystem::path(test_paths::shared) / "data" / "membrane_dic";
}

/// Standard deviation of the noise of one pixel from the roughness of its curve: residuals of each
/// level from the cubic through its four neighbours (evenly spaced), scaled by their noise gain.
double roughness(const std::vector<double>& zeta) {
  std::vector<double> residuals;
  for (std::size_t k = 2; k + 2 < zeta.size(); ++k) {
    const double cubic = (4.0 * (zeta[k - 1] + zeta[k + 1]) - zeta[k - 2] - zeta[k + 2]) / 6.0;
    residuals.push_back(zeta[k] - cubic);
  }
  return numerics::mad_sigma(residuals, 0.0) / std::sqrt(1.0 + 34.0 / 36.0);
}

struct Specimen {
  std::vector<Level> levels;   ///< stations are the pixels that have data at every level
  std::vector<bool> monotone;  ///< by pixel: deflection rises from each level to the next
};

Specimen load(int number) {
  const auto data = test::read_npy(folder() / ("test" + std::to_string(number) + ".npy"));
  EXPECT_EQ(data.shape, (std::vector<std::size_t>{kLevels, 28, 28, kComponents}));
  const auto outward = [&](std::size_t k, std::size_t pixel) {
    return 1e-3 * data.values[(k * kPixels + pixel) * kComponents + 2];  // mm
  };
  std::vector<std::vector<double>> curves;
  Specimen specimen;
  for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
    std::vector<double> zeta;
    for (std::size_t k = 0; k < kLevels; ++k) zeta.push_back(outward(k, pixel));
    if (std::count(zeta.begin(), zeta.end(), 0.0) > 0) continue;
    specimen.monotone.push_back(
        std::adjacent_find(zeta.begin(), zeta.end(), std::greater_equal<>()) == zeta.end());
    curves.push_back(std::move(zeta));
  }
  const auto n = static_cast<Index>(curves.size());
  for (std::size_t k = 0; k < kLevels; ++k) {
    Profile profile;
    profile.x = Array1::LinSpaced(n, 0.0, static_cast<double>(n - 1));
    profile.zeta = profile.uncertainty.independent = Array1::Zero(n);
    profile.flags = Flags1::Zero(n);
    for (Index i = 0; i < n; ++i) {
      const auto& curve = curves[static_cast<std::size_t>(i)];
      profile.zeta[i] = curve[k];
      profile.uncertainty.independent[i] = roughness(curve);
    }
    specimen.levels.push_back({"frame " + std::to_string(k),
                               Pressure::from_si(kPressureBar[k] * kBar), Pressure{}, profile});
  }
  return specimen;
}

struct Errors {
  double squares = 0.0;
  int n = 0, unanswered = 0, covered = 0;
  double rms_hPa() const { return std::sqrt(squares / n) / kHectopascal; }
};

class MembraneDic : public ::testing::TestWithParam<std::pair<int, double>> {};

TEST_P(MembraneDic, LeavingOnePressureOutReadsItBackAsWellAsAMonotoneCubic) {
  if (!std::filesystem::exists(folder())) GTEST_SKIP() << "no folder " << folder();
  const auto [number, reference_hPa] = GetParam();
  const Specimen specimen = load(number);
  Errors monotone, other;
  std::vector<double> whole;  // one reading a map, from all pixels
  for (std::size_t k = 1; k + 1 < kLevels; ++k) {
    auto levels = specimen.levels;
    levels.erase(levels.begin() + static_cast<Index>(k));
    const auto reading =
        inversion::read_pressure(calibration::fit_curves(levels), specimen.levels[k].profile);
    const double truth = specimen.levels[k].pressure.si();
    std::vector<double> answers;
    for (Index i = 0; i < reading.x.size(); ++i) {
      Errors& errors = specimen.monotone[static_cast<std::size_t>(i)] ? monotone : other;
      if (!reading.answered(i)) {
        ++errors.unanswered;
        continue;
      }
      const double error = reading.pressure[i] - truth;
      errors.squares += error * error;
      errors.n += 1;
      errors.covered += reading.lower[i] <= truth && truth <= reading.upper[i];
      answers.push_back(reading.pressure[i]);
    }
    whole.push_back(numerics::median(answers) - truth);
  }
  double whole_squares = 0.0;
  for (const double error : whole) whole_squares += error * error;
  // The reference: pressure interpolated over deflection by a monotone cubic (PCHIP), rms over the
  // 18 interior levels and all pixels whose 20 levels are monotone.
  EXPECT_LE(monotone.rms_hPa(), reference_hPa);
  EXPECT_LE(monotone.unanswered, 0.01 * (monotone.n + monotone.unanswered));
  // Errors of a map are common to its pixels, so that 18 maps tell little more than this.
  EXPECT_GE(monotone.covered, 0.9 * monotone.n);
  RecordProperty("rms_hPa", std::to_string(monotone.rms_hPa()));
  RecordProperty("reference_hPa", std::to_string(reference_hPa));
  RecordProperty("covered", std::to_string(static_cast<double>(monotone.covered) / monotone.n));
  std::printf(
      "specimen %d: rms %.2f hPa over %d readings (%d without answer, coverage %.2f); pixels "
      "not monotone: %d readings, rms %.2f hPa, %d without answer; median of a map: rms %.2f "
      "hPa\n",
      number, monotone.rms_hPa(), monotone.n, monotone.unanswered,
      static_cast<double>(monotone.covered) / monotone.n, other.n,
      other.n > 0 ? other.rms_hPa() : 0.0, other.unanswered,
      std::sqrt(whole_squares / static_cast<double>(whole.size())) / kHectopascal);
}

INSTANTIATE_TEST_SUITE_P(Specimens, MembraneDic,
                         ::testing::Values(std::pair{0, 2.6}, std::pair{1, 3.2}, std::pair{2, 2.6},
                                           std::pair{3, 4.3}));

}  // namespace
}  // namespace manoscope
