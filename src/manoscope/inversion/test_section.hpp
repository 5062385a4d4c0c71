#pragma once

#include <optional>

#include "manoscope/core/units.hpp"
#include "manoscope/inversion/read_pressure.hpp"

namespace manoscope::inversion {

struct TestSectionOptions {
  std::optional<Length> start, end;  ///< auto: found from the data
  double clearance = 3.0;            ///< in decay lengths w/pi
  double least_sensitivity = 0.5;    ///< share of the median over the middle half

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("section-start", start, "start of the test section, from the inlet edge");
    visit("section-end", end, "end of the test section, from the inlet edge");
    visit("clearance", clearance,
          "distance of the test section from the clamped ends, in decay lengths width/pi");
    visit("least-sensitivity", least_sensitivity,
          "least slope of the constitutive curve in the test section, as a share of its median");
  }
  /// @throws InputError naming the option out of range, or an end before the start.
  void validate() const;
};

/// First and last station at which p(x) is trusted.
struct TestSection {
  Index first = 0, last = 0;
};

/// A piece of the channel along x.
struct Stretch {
  Length start{}, end{};
};

/// Where the test section is looked for: between the given ends, else `clearance` decay lengths
/// w/pi from the clamped ends of the wall.
Stretch wanted_stretch(Length channel_length, Length channel_width,
                       const TestSectionOptions& options = {});

/// The stretch of the channel where the wall answers and its clamped ends are not felt.
///
/// A clamped end dies out along a tensioned wall as exp(-pi x / w) (the longest-lived mode of a
/// membrane held along both sides), so the section keeps `clearance` decay lengths w/pi from both
/// ends: 5 % of the end effect is left at 3. It begins and ends at a station that has an answer and
/// whose slope of the constitutive curve is at least `least_sensitivity` of its median over the
/// middle half. Stations without answer inside stay in it, flagged.
/// @return nullopt if no two stations qualify.
std::optional<TestSection> find_test_section(const PressureReading& reading, Length channel_length,
                                             Length channel_width,
                                             const TestSectionOptions& options = {});

/// Sets outside_test_section on every station outside (on all if there is no section).
void flag_outside(PressureReading& reading, const std::optional<TestSection>& section);

}  // namespace manoscope::inversion
