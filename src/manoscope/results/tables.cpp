#include "manoscope/results/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "manoscope/core/flags.hpp"

namespace manoscope::results {
namespace {

/// "true section" as a column is called: true_section.
std::string as_column(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char letter) { return letter == ' ' || letter == '-'; }, '_');
  return name;
}

void add_numbers(std::string& table, std::initializer_list<double> values) {
  for (const double value : values) table += ',' + csv_cell(value);
}

}  // namespace

std::string csv_cell(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"') quoted += '"';
    quoted += letter;
  }
  return quoted + '"';
}

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
    const std::string head = csv_cell(m.run[run]) + ',' + csv_cell(m.flow_rate(ir));
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
  struct Column {
    std::string name;
    std::function<double(Index)> value;
  };
  std::vector<Column> columns;
  const auto add = [&columns](std::string name, const Array1& values) {
    columns.push_back({std::move(name), [&values](Index run) { return values(run); }});
  };
  const auto add_row = [&columns](std::string name, const Array2& values, std::size_t row) {
    columns.push_back({std::move(name),
                       [&values, row](Index run) { return values(static_cast<Index>(row), run); }});
  };
  add("flow_rate_m3_s", m.flow_rate);
  add("reynolds", m.reynolds);
  columns.push_back({"x_start_m", [&m](Index run) { return m.test_section(run, 0); }});
  columns.push_back({"x_end_m", [&m](Index run) { return m.test_section(run, 1); }});
  add("extracted_drop_Pa", m.extracted_drop);
  add("extracted_drop_uncertainty_Pa", m.extracted_drop_uncertainty);
  add("resistance_drop_Pa", m.resistance_drop);
  add("resistance_drop_uncertainty_Pa", m.resistance_drop_uncertainty);
  add("transducer_drop_Pa", m.transducer_drop);
  add("parasitic_drop_Pa", m.parasitic_drop);
  add("en_number", m.en_number);
  add("reduced_reynolds", m.reduced_reynolds);
  add("parasitic_drop_uncertainty_Pa", m.parasitic_drop_uncertainty);
  add("compliant_drop_Pa", m.compliant_drop);
  add("compliant_drop_uncertainty_Pa", m.compliant_drop_uncertainty);
  add("predicted_drop_Pa", m.predicted_drop);
  add("predicted_drop_uncertainty_Pa", m.predicted_drop_uncertainty);
  add("predicted_en_number", m.predicted_en_number);
  add("inferred_flow_rate_m3_s", m.inferred_flow_rate);
  add("inferred_flow_rate_uncertainty_m3_s", m.inferred_flow_rate_uncertainty);
  add("friction_drag_N", m.friction_drag);
  add("relative_friction_drag", m.relative_friction_drag);
  for (std::size_t k = 0; k < m.correction.size(); ++k) {
    add_row(as_column(m.correction[k]) + "_Pa", m.correction_drop, k);
    add_row(as_column(m.correction[k]) + "_uncertainty_Pa", m.correction_uncertainty, k);
  }
  for (std::size_t f = 0; f < m.flow_model.size(); ++f) {
    const std::string model = as_column(m.flow_model[f]) + "_model_";
    add_row(model + "drop_Pa", m.model_drop, f);
    add_row(model + "drop_uncertainty_Pa", m.model_drop_uncertainty, f);
    add_row(model + "en_number", m.model_en_number, f);
    add_row(model + "p_value", m.model_p_value, f);
  }
  std::string table = "run";
  for (const Column& column : columns) table += ',' + column.name;
  table += ",verdict\n";
  for (std::size_t run = 0; run < m.run.size(); ++run) {
    table += csv_cell(m.run[run]);
    for (const Column& column : columns) {
      table += ',' + csv_cell(column.value(static_cast<Index>(run)));
    }
    table += ',' + (run < m.verdict.size() ? csv_cell(m.verdict[run]) : std::string()) + '\n';
  }
  return table;
}

}  // namespace manoscope::results
