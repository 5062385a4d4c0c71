#include "manoscope/inversion/test_section.hpp"

#include <fmt/format.h>

#include <numbers>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::inversion {

void TestSectionOptions::validate() const {
  if (!(clearance >= 0.0)) {
    throw InputError("--clearance", fmt::format("is {}", clearance), "Give 0 or more");
  }
  if (!(least_sensitivity >= 0.0 && least_sensitivity < 1.0)) {
    throw InputError("--least-sensitivity", fmt::format("is {}", least_sensitivity),
                     "Give a share in [0, 1)");
  }
  if (start && end && *end <= *start) {
    throw InputError(
        "--section-end",
        fmt::format("is {:.4g} mm, not beyond the start at {:.4g} mm", end->in(mm), start->in(mm)),
        "Give an end downstream of the start");
  }
}

Stretch wanted_stretch(Length channel_length, Length channel_width,
                       const TestSectionOptions& options) {
  const Length clearance = options.clearance / std::numbers::pi * channel_width;
  return {options.start.value_or(clearance), options.end.value_or(channel_length - clearance)};
}

std::optional<TestSection> find_test_section(const PressureReading& reading, Length channel_length,
                                             Length channel_width,
                                             const TestSectionOptions& options) {
  options.validate();
  const double length = channel_length.si();
  const Stretch wanted = wanted_stretch(channel_length, channel_width, options);
  const double start = wanted.start.si(), end = wanted.end.si();

  std::vector<double> slopes;
  for (Index ix = 0; ix < reading.x.size(); ++ix) {
    const bool middle = reading.x[ix] > 0.25 * length && reading.x[ix] < 0.75 * length;
    if (middle && reading.answered(ix)) slopes.push_back(reading.slope[ix]);
  }
  if (slopes.empty()) return std::nullopt;
  const double least = options.least_sensitivity * numerics::median(slopes);

  std::optional<TestSection> section;
  for (Index ix = 0; ix < reading.x.size(); ++ix) {
    const double x = reading.x[ix];
    if (x < start || x > end || !reading.answered(ix) || reading.slope[ix] < least) continue;
    if (!section) section = TestSection{ix, ix};
    section->last = ix;
  }
  if (section && section->first == section->last) return std::nullopt;
  return section;
}

void flag_outside(PressureReading& reading, const std::optional<TestSection>& section) {
  for (Index ix = 0; ix < reading.x.size(); ++ix) {
    if (!section || ix < section->first || ix > section->last) {
      reading.flags[ix] |= ReadingFlag::outside_test_section;
    }
  }
}

}  // namespace manoscope::inversion
