#include "manoscope/results/tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <iterator>
#include <string_view>

#include "manoscope/core/flags.hpp"

namespace manoscope::results {
namespace {

std::string cell(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

std::string cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"') quoted += '"';
    quoted += letter;
  }
  return quoted + '"';
}

void add_numbers(std::string& table, std::initializer_list<double> values) {
  for (const double value : values) table += ',' + cell(value);
}

}  // namespace

std::string flag_names(FlagBits bits) {
  std::string names;
  unsigned int rest = bits;
  const auto add = [&names](std::string_view name) {
    if (!names.empty()) names += '|';
    names += name;
  };
  for (const FlagName& flag : kReadingFlags) {
    if ((rest & flag.bit) == 0U) continue;
    add(flag.name);
    rest &= ~static_cast<unsigned int>(flag.bit);
  }
  for (unsigned int bit = 0; bit < 8; ++bit) {
    if ((rest >> bit & 1U) != 0U) add(fmt::format("bit_{}", bit));
  }
  return names;
}

std::string pressure_table(const Measurement& m) {
  std::string table =
      "run,flow_rate_m3_s,x_m,pressure_Pa,pressure_uncertainty_Pa,pressure_lower_Pa,"
      "pressure_upper_Pa,deflection_m,flags\n";
  for (std::size_t run = 0; run < m.run.size(); ++run) {
    const auto ir = static_cast<Index>(run);
    const std::string head = cell(m.run[run]) + ',' + cell(m.flow_rate(ir));
    for (Index ix = 0; ix < m.x.size(); ++ix) {
      table += head;
      add_numbers(table,
                  {m.x(ix), m.pressure(ir, ix), m.pressure_uncertainty(ir, ix),
                   m.pressure_lower(ir, ix), m.pressure_upper(ir, ix), m.deflection(ir, ix)});
      table += ',' + flag_names(m.pressure_flags(ir, ix)) + '\n';
    }
  }
  return table;
}

std::string drops_table(const Measurement& m) {
  std::string table =
      "run,flow_rate_m3_s,reynolds,x_start_m,x_end_m,extracted_drop_Pa,"
      "extracted_drop_uncertainty_Pa,resistance_drop_Pa,resistance_drop_uncertainty_Pa,"
      "transducer_drop_Pa,parasitic_drop_Pa,en_number\n";
  for (std::size_t run = 0; run < m.run.size(); ++run) {
    const auto ir = static_cast<Index>(run);
    table += cell(m.run[run]);
    add_numbers(table,
                {m.flow_rate(ir), m.reynolds(ir), m.test_section(ir, 0), m.test_section(ir, 1),
                 m.extracted_drop(ir), m.extracted_drop_uncertainty(ir), m.resistance_drop(ir),
                 m.resistance_drop_uncertainty(ir), m.transducer_drop(ir), m.parasitic_drop(ir),
                 m.en_number(ir)});
    table += '\n';
  }
  return table;
}

}  // namespace manoscope::results
