#include "manoscope/inversion/end_doubt.hpp"

#include <cmath>
#include <numbers>

namespace manoscope::inversion {

void add_end_doubt(PressureReading& reading, const TestSection& section, Length channel_length,
                   Length channel_width, double coverage) {
  const double decay = channel_width.si() / std::numbers::pi;
  const double gradient = (reading.pressure[section.first] - reading.pressure[section.last]) /
                          (reading.x[section.last] - reading.x[section.first]);
  const auto add = [&](const char* end, const Array1& distance) {
    ErrorMode mode{std::string("wall stiffness at the ") + end, "end effect",
                   gradient * decay * (-distance / decay).exp()};
    for (Index ix = 0; ix < reading.x.size(); ++ix) {
      if (!reading.answered(ix)) mode.effect[ix] = 0.0;
    }
    reading.uncertainty.modes.push_back(std::move(mode));
  };
  add("inlet", reading.x);
  add("outlet", channel_length.si() - reading.x);
  form_interval(reading, coverage);
}

}  // namespace manoscope::inversion
