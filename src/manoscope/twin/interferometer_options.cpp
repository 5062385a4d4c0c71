#include "manoscope/twin/interferometer_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope::twin {
namespace {

constexpr int kMostPixels = 20000;            // along one axis
constexpr double kMostArea = 8e6;             // pixels a map
constexpr double kWidestSpread = 1e-3;        // m, of blur and correlation
constexpr double kLargestHeightError = 1e-3;  // m

void require(bool holds, const std::string& found, const char* mend) {
  if (!holds) throw InputError("interferometer", found, mend);
}

void require_size(int n, const char* name) {
  require(n >= 8 && n <= kMostPixels, fmt::format("{} is {}", name, n), "Choose 8 to 20000 pixels");
}

void require_height_error(Length value, const char* name) {
  require(std::isfinite(value.si()) && value.si() >= 0.0 && value.si() <= kLargestHeightError,
          fmt::format("{} is {:g} m", name, value.si()), "Give 0 m (off) or more, at most 1 mm");
}

void require_spread(Length value, const char* name) {
  require(std::isfinite(value.si()) && value.si() >= 0.0 && value.si() <= kWidestSpread,
          fmt::format("{} is {:g} m", name, value.si()), "Give 0 m (off) or more, at most 1 mm");
}

void require_small_angle(Angle value, const char* name) {
  require(std::isfinite(value.si()) && value.si() >= 0.0 && value.si() < 0.1,
          fmt::format("{} is {:g} rad", name, value.si()),
          "Give 0 rad (off) or more, less than 0.1 rad");
}

void require_fraction(double value, const char* name) {
  require(std::isfinite(value) && value >= 0.0 && value <= 0.5,
          fmt::format("{} is {:g}", name, value), "Choose a fraction of the pixels in [0, 0.5]");
}

}  // namespace

void InterferometerOptions::validate() const {
  require_size(n_along, "n_along");
  // All maps of an experiment are in memory until they are written.
  require(static_cast<double>(n_along) * n_across <= kMostArea,
          fmt::format("n_along is {}, n_across {}: {:.3g} million pixels a map", n_along, n_across,
                      1e-6 * n_along * n_across),
          "Choose 8 million pixels a map or fewer");
  require_size(n_across, "n_across");
  require(rim.si() >= 0.0 && rim.si() <= 0.1, fmt::format("rim is {:g} m", rim.si()),
          "Give 0 m or more, at most 10 cm");
  require_spread(blur, "blur");
  require_height_error(noise, "noise");
  require_height_error(correlated_noise, "correlated_noise");
  require_spread(correlation_length, "correlation_length");
  require_small_angle(tilt, "tilt");
  require_height_error(piston, "piston");
  require_height_error(curvature, "curvature");
  require_spread(shift, "shift");
  require_small_angle(rotation_scatter, "rotation_scatter");
  require_small_angle(tilt_drift, "tilt_drift");
  require_height_error(piston_drift, "piston_drift");
  require_spread(shift_drift, "shift_drift");
  require_fraction(dropouts, "dropouts");
  require_fraction(blobs, "blobs");
  require_fraction(spikes, "spikes");
  require_height_error(spike_height, "spike_height");
  require_fraction(fringe_jumps, "fringe_jumps");
  require(wavelength > 100.0 * nm && wavelength < 100.0 * um,
          fmt::format("wavelength is {:g} m", wavelength.si()),
          "Choose one between 100 nm and 100 um");
  require_height_error(quantisation, "quantisation");
  require(std::abs(rotation.si()) < 0.2, fmt::format("rotation is {:g} rad", rotation.si()),
          "Choose a small angle, less than 0.2 rad");
}

InterferometerOptions InterferometerOptions::without_errors() const {
  InterferometerOptions clean = *this;
  clean.blur = clean.noise = clean.correlated_noise = Length{};
  clean.piston = clean.curvature = clean.shift = Length{};
  clean.piston_drift = clean.shift_drift = clean.quantisation = Length{};
  clean.tilt = clean.rotation_scatter = clean.tilt_drift = Angle{};
  clean.dropouts = clean.blobs = clean.spikes = clean.fringe_jumps = 0.0;
  return clean;
}

InterferometerOptions resized(InterferometerOptions camera, const std::string& size) {
  const auto refuse = [&] {
    throw InputError(
        "size", fmt::format("\"{}\" is no size", size.substr(0, 40)),
        "Write pixels along x across, such as 512x96, or a share of both, such as 0.25");
  };
  const char* const end = size.data() + size.size();
  if (const auto cross = size.find('x'); cross != std::string::npos) {
    const char* const middle = size.data() + cross;
    const auto along = std::from_chars(size.data(), middle, camera.n_along);
    const auto across = std::from_chars(middle + 1, end, camera.n_across);
    if (along.ec != std::errc{} || along.ptr != middle || across.ec != std::errc{} ||
        across.ptr != end) {
      refuse();
    }
  } else {
    double share = 0.0;
    const auto read = std::from_chars(size.data(), end, share);
    if (read.ec != std::errc{} || read.ptr != end || !std::isfinite(share) ||
        !(share > 0.0 && share <= 4.0))
      refuse();
    camera.n_along = static_cast<int>(std::lround(share * camera.n_along));
    camera.n_across = static_cast<int>(std::lround(share * camera.n_across));
  }
  camera.validate();
  return camera;
}

}  // namespace manoscope::twin
