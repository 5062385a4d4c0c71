#include "manoscope/twin/map_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/options.hpp"
#include "manoscope/twin/interferometer.hpp"

namespace manoscope::twin {
namespace {

const flow::Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};

InterferometerOptions perfect() {
  InterferometerOptions options;
  options.n_along = 240;
  options.n_across = 80;
  return options.without_errors();
}

ChannelCurve flat() { return {kChannel.length, Array1::Zero(8)}; }
ChannelCurve bulged() {
  const Array1 s = Array1::LinSpaced(801, 0.0, M_PI);
  return {kChannel.length, 30e-6 * s.sin() * (1.0 + 0.2 * s)};
}

HeightMap record(const InterferometerOptions& options, std::uint64_t index = 2,
                 const ChannelCurve& zeta = bulged()) {
  return record_map(kChannel, zeta, options, 5, index);
}

using Switch = std::function<void(InterferometerOptions&)>;
struct NamedSwitch {
  std::string name;
  Switch on;
};

/// Errors that add to a height, whatever else is on.
std::vector<NamedSwitch> additive_errors() {
  return {
      {"noise", [](auto& o) { o.noise = 20.0 * nm; }},
      {"correlated_noise", [](auto& o) { o.correlated_noise = 15.0 * nm; }},
      {"tilt", [](auto& o) { o.tilt = Angle::from_si(1e-3); }},
      {"tilt_drift", [](auto& o) { o.tilt_drift = Angle::from_si(1e-5); }},
      {"piston", [](auto& o) { o.piston = 1.0 * um; }},
      {"piston_drift", [](auto& o) { o.piston_drift = 0.1 * um; }},
      {"curvature", [](auto& o) { o.curvature = 50.0 * nm; }},
      {"spikes", [](auto& o) { o.spikes = 0.01; }},
      {"fringe_jumps", [](auto& o) { o.fringe_jumps = 0.02; }},
  };
}

/// Errors that act on what is seen or recorded.
std::vector<NamedSwitch> other_errors() {
  return {
      {"blur", [](auto& o) { o.blur = 60.0 * um; }},
      {"shift", [](auto& o) { o.shift = 15.0 * um; }},
      {"shift_drift", [](auto& o) { o.shift_drift = 5.0 * um; }},
      {"rotation_scatter", [](auto& o) { o.rotation_scatter = Angle::from_si(1e-3); }},
      {"dropouts", [](auto& o) { o.dropouts = 0.02; }},
      {"blobs", [](auto& o) { o.blobs = 0.02; }},
      {"quantisation", [](auto& o) { o.quantisation = 5.0 * nm; }},
  };
}

std::vector<NamedSwitch> all_errors() {
  auto all = additive_errors();
  for (const NamedSwitch& other : other_errors()) all.push_back(other);
  return all;
}

TEST(MapErrors, EachSwitchAloneChangesTheMapAndNoneLeavesTheWallAlone) {
  const HeightMap still = record(perfect());
  EXPECT_EQ(still.height()(0, 0), 0.0);
  EXPECT_EQ((still.flags() != 0).count(), 0);
  for (const NamedSwitch& error : all_errors()) {
    InterferometerOptions options = perfect();
    error.on(options);
    const HeightMap map = record(options);
    EXPECT_TRUE((map.height() != still.height()).any() || (map.flags() != 0).any()) << error.name;
    const HeightMap off = record(options.without_errors());
    EXPECT_TRUE((off.height() == still.height()).all()) << error.name;
    EXPECT_EQ((off.flags() != 0).count(), 0) << error.name;
  }
}

TEST(MapErrors, AnErrorThatAddsIsTheSameAloneAndAmongAllOthers) {
  const HeightMap none = record(perfect());
  for (const NamedSwitch& error : additive_errors()) {
    InterferometerOptions alone = perfect(), others = perfect();
    error.on(alone);
    for (const NamedSwitch& other : all_errors()) {
      // Rounding ends all sums, and lost pixels have no height to compare.
      if (other.name != error.name && other.name != "quantisation" && other.name != "dropouts" &&
          other.name != "blobs") {
        other.on(others);
      }
    }
    InterferometerOptions together = others;
    error.on(together);
    const Array2 by_itself = record(alone).height() - none.height();
    const Array2 in_company = record(together).height() - record(others).height();
    // Tangents of two tilts add up to tilt^2 drift: (2e-3)^2 times 2e-5 on 8 mm is 7e-13 m.
    // For all others, round-off of 100 um.
    const double tolerance = error.name.rfind("tilt", 0) == 0 ? 2e-12 : 1e-18;
    EXPECT_LT((by_itself - in_company).abs().maxCoeff(), tolerance) << error.name;
  }
}

TEST(MapErrors, LosesTheSamePixelsWhateverElseIsOn) {
  for (const std::string name : {"dropouts", "blobs"}) {
    InterferometerOptions alone = perfect(), company = perfect();
    for (const NamedSwitch& error : all_errors()) {
      if (error.name == name) error.on(alone);
      if (error.name == name || (error.name != "dropouts" && error.name != "blobs")) {
        error.on(company);
      }
    }
    EXPECT_TRUE((record(alone).flags() == record(company).flags()).all()) << name;
  }
}

TEST(MapErrors, SwitchesAreInTheOneListOfOptions) {
  const auto list = list_options(InterferometerOptions{});
  for (const NamedSwitch& error : all_errors()) {
    EXPECT_TRUE(std::any_of(list.begin(), list.end(), [&](const OptionInfo& info) {
      return info.name == error.name;
    })) << error.name;
  }
}

TEST(MapErrors, CorrelatedNoiseHasItsDeviationAndLengthInMetresOnPixelsThatAreNotSquare) {
  InterferometerOptions options = perfect();  // pixels of 68 by 31 um
  options.correlated_noise = 15.0 * nm;
  options.correlation_length = 250.0 * um;
  double variance = 0.0, across = 0.0;
  const int n_maps = 20;
  for (int i = 0; i < n_maps; ++i) {
    const HeightMap map = record(options, static_cast<std::uint64_t>(i), flat());
    const Array2& h = map.height();
    variance += h.square().mean() / n_maps;
    across += (h.topRows(72) * h.bottomRows(72)).mean() / n_maps;  // 8 pixels: 250 um
  }
  const double independent = n_maps * (16.3e-3 * 2.5e-3) / (0.5 * M_PI * 250e-6 * 250e-6);
  const double five = 5.0 * std::sqrt(2.0 / independent);  // five standard errors of a variance
  EXPECT_NEAR(variance / (15e-9 * 15e-9), 1.0, five);
  EXPECT_NEAR(across / (15e-9 * 15e-9), std::exp(-1.0), five);
}

TEST(MapErrors, CurvatureIsOneQuadraticFormForAllMaps) {
  InterferometerOptions options = perfect();
  options.curvature = 50.0 * nm;
  const Array2 first = record(options, 0, flat()).height();
  EXPECT_TRUE((first == record(options, 9, flat()).height()).all());
  // Second differences of a quadratic form are one number each.
  const Index n = first.cols();
  const Array2 along =
      first.rightCols(n - 2) - 2.0 * first.middleCols(1, n - 2) + first.leftCols(n - 2);
  EXPECT_LT(along.maxCoeff() - along.minCoeff(), 1e-21);  // round-off of 100 nm
  EXPECT_NE(along(0, 0), 0.0);
}

TEST(MapErrors, CurvatureHasItsDeviationOverManySeeds) {
  InterferometerOptions options = perfect();
  options.curvature = 50.0 * nm;
  options.n_along = options.n_across = 8;
  double square = 0.0;
  const int n = 400;
  for (int seed = 0; seed < n; ++seed) {
    const Array2 h =
        record_map(kChannel, flat(), options, static_cast<std::uint64_t>(seed), 0).height();
    // a (u1^2 - u4^2) of row 0 with v and u v cancelling between the two ends.
    const double a = 0.5 * ((h(0, 0) + h(0, 7)) - (h(0, 3) + h(0, 4))) / (49.0 / 64.0 - 1.0 / 64.0);
    square += a * a / n;
  }
  EXPECT_NEAR(square / (50e-9 * 50e-9), 1.0, 5.0 * std::sqrt(2.0 / n));  // five standard errors
}

TEST(MapErrors, FringeJumpsAreHalfAWavelengthOverTheirFraction) {
  InterferometerOptions options = perfect();
  options.fringe_jumps = 0.05;
  options.wavelength = 550.0 * nm;
  double share = 0.0;
  const int n_maps = 20;
  for (int i = 0; i < n_maps; ++i) {
    const HeightMap map = record(options, static_cast<std::uint64_t>(i), flat());
    const Array2& h = map.height();
    EXPECT_TRUE((h == 0.0 || (h.abs() - 275e-9).abs() < 1e-20).all());
    share += static_cast<double>((h != 0.0).count()) / static_cast<double>(h.size()) / n_maps;
  }
  // Patches of 145 pixels, 6.6 a map: overlaps take half the fraction of it and the map's edge
  // 4/pi r (1/240 + 1/80)/2 = 7 %; areas scatter by 0.6 of themselves (five standard errors).
  EXPECT_NEAR(share, 0.05, 0.05 * (0.12 + 5.0 * 0.6 / std::sqrt(n_maps * 6.6)));
}

TEST(MapErrors, QuantisedHeightsAreWholeSteps) {
  InterferometerOptions options = perfect();
  options.noise = 20.0 * nm;
  InterferometerOptions coarse = options;
  coarse.quantisation = 5.0 * nm;
  const Array2 smooth = record(options).height(), rounded = record(coarse).height();
  EXPECT_LE((smooth - rounded).abs().maxCoeff(), 2.5e-9 * (1.0 + 1e-9));
  const Array2 steps = rounded / 5e-9;
  EXPECT_LT((steps - steps.round()).abs().maxCoeff(), 1e-9);  // round-off of 2e4 steps
}

TEST(MapErrors, BlurWidensTheEdgeAndKeepsTheVolume) {
  InterferometerOptions options = perfect();
  const Array2 sharp = record(options).height();
  options.blur = 60.0 * um;
  const Array2 soft = record(options).height();
  EXPECT_NEAR(soft.sum() / sharp.sum(), 1.0, 1e-12);  // mirrored edges, weights of sum 1
  EXPECT_GT(soft.row(12).maxCoeff(), 0.0);            // 10 um outside the channel's edge
  EXPECT_EQ(sharp.row(11).abs().maxCoeff(), 0.0);
  EXPECT_GT(soft.row(11).maxCoeff(), 1e-8);
  // The crest of a parabola falls by half its curvature times the variance: crest sigma^2/a^2,
  // to 5 % as the form along x adds 1 % and the edges are 14 sigma away.
  const double crest = sharp(40, 120);
  const double expected = crest * 60e-6 * 60e-6 / (0.85e-3 * 0.85e-3);
  EXPECT_NEAR(crest - soft(40, 120), expected, 0.05 * expected);
}

TEST(MapErrors, DriftsWalkFromMapToMap) {
  InterferometerOptions options = perfect();
  options.piston_drift = 0.1 * um;
  options.n_along = options.n_across = 8;
  EXPECT_EQ(record(options, 0, flat()).height().abs().maxCoeff(), 0.0);
  double steps = 0.0, before = 0.0;
  const int n = 400;
  for (int i = 1; i <= n; ++i) {
    const double now = record(options, static_cast<std::uint64_t>(i), flat()).height()(3, 3);
    steps += std::pow(now - before, 2) / n;
    before = now;
  }
  EXPECT_NEAR(steps / 1e-14, 1.0, 5.0 * std::sqrt(2.0 / n));  // five standard errors
}

TEST(MapErrors, RotationIsDrawnMapByMapAboutTheCentre) {
  InterferometerOptions options = perfect();
  options.rotation_scatter = Angle::from_si(5e-3);
  const HeightMap map = record(options);
  // The centre stays; the centre line at a quarter of the length moves across by 3.9 mm times the
  // angle, the other way at three quarters.
  const auto crest = [](const HeightMap& m, Index ix) {
    double sum = 0.0, first = 0.0;
    for (Index iy = 0; iy < m.grid().ny; ++iy) {
      sum += m.height()(iy, ix);
      first += static_cast<double>(iy) * m.height()(iy, ix);
    }
    return first / sum;
  };
  const double left = crest(map, 60) - crest(record(perfect()), 60);
  const double right = crest(map, 179) - crest(record(perfect()), 179);
  EXPECT_NEAR(left, -right, 1e-2 * std::abs(left));  // pixels; the form is lopsided along x
  EXPECT_GT(std::abs(left), 1e-2);
  EXPECT_TRUE((map.height() != record(options, 3).height()).any());
}

TEST(Camera, IsResizedByPixelsOrByAShareOverTheSameView) {
  const InterferometerOptions camera;
  EXPECT_EQ(resized(camera, "512x96").n_along, 512);
  EXPECT_EQ(resized(camera, "512x96").n_across, 96);
  EXPECT_EQ(resized(camera, "0.25").n_along, 256);
  EXPECT_EQ(resized(camera, "0.25").n_across, 48);
  EXPECT_EQ(resized(camera, "512x96").rim, camera.rim);
  for (const char* bad :
       {"", "x", "512", "512x", "x96", "-0.5", "0", "512x96x2", "nan", "4x4", "1e9x96", "0.25 "}) {
    EXPECT_THROW(resized(camera, bad), InputError) << bad;
  }
}

TEST(MapErrors, RefusesSwitchesOutOfRangeByName) {
  const auto refused = [](const Switch& change, const std::string& name) {
    InterferometerOptions options;
    change(options);
    try {
      options.validate();
      ADD_FAILURE() << name << " passed";
    } catch (const InputError& error) {
      EXPECT_NE(error.found().find(name), std::string::npos) << error.what();
    }
  };
  refused([](auto& o) { o.blur = -1.0 * um; }, "blur");
  refused([](auto& o) { o.correlated_noise = 1.0 * metre; }, "correlated_noise");
  refused([](auto& o) { o.correlation_length = 2.0 * metre; }, "correlation_length");
  refused([](auto& o) { o.curvature = -1.0 * nm; }, "curvature");
  refused([](auto& o) { o.fringe_jumps = 0.9; }, "fringe_jumps");
  refused([](auto& o) { o.wavelength = Length{}; }, "wavelength");
  refused([](auto& o) { o.quantisation = -1.0 * nm; }, "quantisation");
  refused([](auto& o) { o.rotation_scatter = 1.0 * rad; }, "rotation_scatter");
}

}  // namespace
}  // namespace manoscope::twin
