#pragma once

// For the tests of this folder only: Gwyddion files laid out by hand from their description.

#include <string>
#include <vector>

#include "manoscope/io/test_bytes.hpp"

namespace manoscope::io::testing {

inline std::string gwy_text(const std::string& text) { return text + '\0'; }

inline std::string gwy_object(const std::string& type, const std::string& components) {
  return gwy_text(type) + little(components.size(), 4) + components;
}

inline std::string gwy_component(const std::string& name, char type, const std::string& value) {
  return gwy_text(name) + type + value;
}

inline std::string gwy_double(const std::string& name, double value) {
  return gwy_component(name, 'd', little(value));
}

/// A field of 3 columns; 6 um wide, 8 um high with two rows.
inline std::string gwy_field(const std::vector<double>& values, const std::string& unit_z,
                             const std::string& unit_xy = "m") {
  std::string data = little(values.size(), 4);
  for (const double value : values) data += little(value);
  const auto unit = [](const std::string& text) {
    return gwy_object("GwySIUnit", gwy_component("unitstr", 's', gwy_text(text)));
  };
  return gwy_object("GwyDataField", gwy_component("xres", 'i', little(3, 4)) +
                                        gwy_component("yres", 'i', little(values.size() / 3, 4)) +
                                        gwy_double("xreal", 6e-6) + gwy_double("yreal", 8e-6) +
                                        gwy_double("xoff", 1e-6) +
                                        gwy_component("si_unit_xy", 'o', unit(unit_xy)) +
                                        gwy_component("si_unit_z", 'o', unit(unit_z)) +
                                        gwy_component("data", 'D', data));
}

inline std::string gwy_file(const std::string& components) {
  return "GWYP" + gwy_object("GwyContainer", components);
}

}  // namespace manoscope::io::testing
