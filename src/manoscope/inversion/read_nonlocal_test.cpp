#include "manoscope/inversion/read_nonlocal.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/inversion/test_calibrated_wall.hpp"

namespace manoscope::inversion {
namespace {

using test_support::CalibratedChannel;
using test_support::channel;

constexpr double kNoise = 5e-9;  // m, of one column: a tenth of a pascal to a pascal

struct Zone {
  double from, to;  ///< m from the nearer end
};
constexpr Zone kEnds{0.15e-3, 1e-3}, kInside{1e-3, 4e-3};

/// Root mean square of f over the answered stations of a zone.
template <class F>
double rms(const PressureReading& reading, const Zone& zone, const F& f) {
  double squares = 0.0, count = 0.0;
  for (Index i = 0; i < reading.x.size(); ++i) {
    const double distance = std::min(reading.x[i], 8e-3 - reading.x[i]);
    if (!reading.answered(i) || distance < zone.from || distance > zone.to) continue;
    squares += std::pow(f(i), 2);
    count += 1.0;
  }
  return std::sqrt(squares / count);
}

double rms_error(const PressureReading& reading, const Zone& zone) {
  return rms(reading, zone, [&](Index i) {
    return reading.pressure[i] - CalibratedChannel::true_pressure(reading.x[i]);
  });
}

struct Readings {
  PressureReading local;
  std::optional<NonlocalReading> nonlocal;
};

/// The wall of the first experiment: what it makes of non-uniform pressure is the same in all.
const NonlocalWall& fitted_wall() {
  static const NonlocalWall wall = [] {
    std::string reason;
    auto made =
        make_nonlocal_wall(channel().curves(kNoise, 5.0, 100), channel().known(), {}, {}, reason);
    if (!made) throw std::runtime_error(reason);
    return *made;
  }();
  return wall;
}

Readings read(std::uint64_t seed, double label_noise) {
  const auto curves = channel().curves(kNoise, label_noise, seed);
  Readings made;
  made.local = read_pressure(curves, channel().flow(kNoise, seed));
  made.nonlocal = read_nonlocal(made.local, fitted_wall(), 0.95);
  return made;
}

TEST(ReadNonlocal, ReadsToTheEndsWhereEachStationOnItsOwnCannot) {
  const Readings readings = read(1, 0.0);
  ASSERT_TRUE(readings.nonlocal);
  const PressureReading& reading = readings.nonlocal->pressure;
  const double local = rms_error(readings.local, kEnds), here = rms_error(reading, kEnds);
  EXPECT_GT(local, 50.0);
  EXPECT_LT(here, local / 5.0);
  EXPECT_LT(rms_error(reading, kInside), rms_error(readings.local, kInside));
  EXPECT_LT(rms_error(reading, kInside), 3.0);
  // A plate that stretches and shears: half of a ripple of 1.5 to 2 widths.
  EXPECT_GT(readings.nonlocal->half_wavelength, 1.2e-3);
  EXPECT_LT(readings.nonlocal->half_wavelength, 2.2e-3);
}

TEST(ReadNonlocal, HasBarsThatHold) {
  // Stations of one experiment share labels: 24 experiments are some 24 independent ones inside.
  constexpr int kExperiments = 24;
  double inside = 0.0, ends = 0.0;
  for (int k = 0; k < kExperiments; ++k) {
    const Readings readings = read(100 + static_cast<std::uint64_t>(k), 5.0);
    ASSERT_TRUE(readings.nonlocal) << k;
    const PressureReading& reading = readings.nonlocal->pressure;
    const Array1 sigma = reading.uncertainty.standard();
    const auto pull = [&](Index i) {
      return (reading.pressure[i] - CalibratedChannel::true_pressure(reading.x[i])) / sigma[i];
    };
    inside += std::pow(rms(reading, kInside, pull), 2) / kExperiments;
    ends += std::pow(rms(reading, kEnds, pull), 2) / kExperiments;
  }
  // Mean squares of 24 normal draws at least: 1 +- 0.29 (one standard error); the bars also hold a
  // model error that this wall does not have, and may be wide by it.
  EXPECT_LT(inside, 1.0 + 3.0 * 0.29);
  EXPECT_GT(inside, 0.25);
  EXPECT_LT(ends, 1.0 + 3.0 * 0.29);
  EXPECT_GT(ends, 0.05);
}

TEST(ReadNonlocal, LeavesSilentStationsSilentAndKeepsTheirFlags) {
  const auto curves = channel().curves(kNoise, 0.0, 2);
  Profile flow = channel().flow(kNoise, 2);
  flow.flags.segment(200, 7).setConstant(StationFlag::no_data);
  const auto local = read_pressure(curves, flow);
  const auto nonlocal = read_nonlocal(local, fitted_wall(), 0.95);
  ASSERT_TRUE(nonlocal);
  for (Index i = 0; i < local.x.size(); ++i) {
    // Within 8 % of the width from an end the wall hardly rises.
    const bool at_end = std::min(local.x[i], 8e-3 - local.x[i]) <= 0.08e-3;
    const FlagBits added = at_end && local.answered(i) ? ReadingFlag::insensitive : FlagBits{0};
    EXPECT_EQ(nonlocal->pressure.flags[i], local.flags[i] | added) << i;
  }
  EXPECT_FALSE(nonlocal->pressure.answered(203));
  EXPECT_EQ(nonlocal->pressure.pressure[203], 0.0);
  EXPECT_EQ(nonlocal->pressure.uncertainty.standard()[203], 0.0);
  EXPECT_LT(rms_error(nonlocal->pressure, kInside), 3.0);
}

TEST(ReadNonlocal, GivesTheSameBytesAgain) {
  const Readings one = read(3, 5.0), two = read(3, 5.0);
  ASSERT_TRUE(one.nonlocal && two.nonlocal);
  EXPECT_TRUE((one.nonlocal->pressure.pressure == two.nonlocal->pressure.pressure).all());
  EXPECT_TRUE((one.nonlocal->pressure.lower == two.nonlocal->pressure.lower).all());
}

TEST(ReadNonlocal, IsNotOfferedWhereNoClampedWallAnswersAsTheCalibrationDid) {
  // Every station stands where mid-channel does: a wall without ends.
  std::vector<calibration::Level> levels;
  for (std::size_t k = 0; k < channel().levels.size(); ++k) {
    Profile profile = channel().levels[k];
    const double middle = profile.zeta[200];
    profile.zeta.setConstant(middle);
    profile.uncertainty.independent.setConstant(1e-9);
    levels.push_back(test::level("h" + std::to_string(k), channel().pressures[k], 0.0, profile));
  }
  std::string reason;
  EXPECT_FALSE(
      make_nonlocal_wall(calibration::fit_curves(levels), channel().known(), {}, {}, reason));
  EXPECT_NE(reason.find("near the ends"), std::string::npos) << reason;
}

TEST(ReadNonlocal, NamesAnOptionOutOfRange) {
  ReadNonlocalOptions options;
  options.finest_ripple = 0.0;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.largest_model_error = 2.0;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace manoscope::inversion
