#include "manoscope/report/html_checks.hpp"

#include <fmt/format.h>

#include <cmath>

#include "manoscope/core/uncertainty.hpp"
#include "manoscope/report/advice.hpp"
#include "manoscope/report/check_summary.hpp"
#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/html_elements.hpp"
#include "manoscope/report/html_text.hpp"
#include "manoscope/report/number_text.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

std::string pull_text(double pull) {
  if (!std::isfinite(pull)) return "–";
  const std::string text = number_text(pull, 2);
  return std::abs(pull) > 3.0 ? "<span class=\"bad\">" + text + "</span>" : text;
}

std::string left_out_table(const Measurement& m) {
  std::string body;
  Index n = 0;
  for (Index k = 0; k < m.left_out_mean_error.size(); ++k) {
    const double error = m.left_out_mean_error[k], u = m.left_out_mean_uncertainty[k];
    if (!std::isfinite(error)) continue;
    ++n;
    body += "<tr>" + cell(short_number_text(m.level_pressure[k])) +
            cell(number_text(m.level_pressure_uncertainty[k], 2)) +
            cell(number_text(m.level_estimate[k] - m.level_pressure[k], 2)) +
            cell(number_text_with_uncertainty(error, kExpansion * u)) +
            cell(pull_text(u > 0.0 ? error / u : std::nan(""))) + "</tr>\n";
  }
  if (n == 0) return {};
  return table(
      fmt::format(
          "Every level but the outermost left out: what its map reads on the curves of the "
          "others, minus its label, ± expanded uncertainty (k = {:.0f}), that of the label "
          "in it. The curves then span twice the distance. Pulls: the difference in standard "
          "uncertainties.",
          kExpansion),
      column_head("Level (Pa)") + column_head("u(label) (Pa)") +
          column_head("All labels − label (Pa)") + column_head("Left out − label (Pa)") +
          column_head("Pull"),
      body, n > 14);
}

std::string shapes_table(const Measurement& m) {
  std::string body;
  Index n = 0;
  for (std::size_t i = 0; i < m.map.size() && i < m.map_run.size(); ++i) {
    const auto map = static_cast<Index>(i);
    if (!std::isfinite(m.shape_p_value[map])) continue;
    ++n;
    const int run = m.map_run[i];
    const bool of_run = run >= 0 && static_cast<std::size_t>(run) < m.run.size();
    body += "<tr>" + row_head(m.map[i]) +
            cell(of_run ? escape_html(m.run[static_cast<std::size_t>(run)]) : "level") +
            cell(number_text(m.shape_reduced_chi_square[map], 3)) +
            cell(chance_text(m.shape_p_value[map], 1e-4)) +
            cell(fmt::format("{:.2f} to {:.2f}", m.shape_worst(map, 0) * 1e3,
                             m.shape_worst(map, 1) * 1e3)) +
            cell(number_text(m.shape_reading_shift[map], 2)) + "</tr>\n";
  }
  if (n == 0) return {};
  return table(
      "Is it pressure that bends this wall? The wall's cross-section in each map against the shape "
      "of the same width average in the levels' maps (of a level: in those of the others), over "
      "the "
      "test section: chi-square per degree of freedom, how often chance makes as large a misfit, "
      "where it is largest, and by how much the reading there may be off if the misfit is no "
      "pressure (0: no more than chance).",
      column_head("Map") + column_head("Run") + column_head("χ²/ν") + column_head("Chance") +
          column_head("Worst (mm)") + column_head("Reading may be off by (Pa)"),
      body, n > 14);
}

std::string repeats_table(const Measurement& m) {
  std::string body;
  for (std::size_t i = 0; i < m.repeat.size(); ++i) {
    const auto at = static_cast<Index>(i);
    body += "<tr>" + row_head(m.repeat[i]) + cell(fmt::format("{}", m.repeat_maps[i])) +
            cell(number_text(m.repeat_scatter[at], 2)) +
            cell(number_text(m.repeat_chi_square[at], 3)) + cell(number_text(m.repeat_dof[at], 2)) +
            cell(chance_text(m.repeat_p_value[at], 1e-3)) + "</tr>\n";
  }
  if (body.empty()) return {};
  return table(
      "Repeats: standard deviation of the maps' mean pressures; chi-square of their mean pressures "
      "and drops against the bars of each map, and how often chance makes one as large.",
      column_head("State") + column_head("Maps") + column_head("Scatter (Pa)") + column_head("χ²") +
          column_head("ν") + column_head("Chance"),
      body);
}

}  // namespace

std::string checks_part(const Measurement& m) {
  std::string words;
  for (const std::string& line : check_lines(m)) words += "<li>" + escape_html(line) + "</li>\n";
  if (const std::string advice = advice_text(m); !advice.empty()) {
    words += "<li>" + escape_html(advice) + "</li>\n";
  }
  if (words.empty()) return {};
  return "<h2 id=\"checks\">Checks without truth</h2>\n<ul>\n" + words + "</ul>\n" +
         left_out_table(m) + shapes_table(m) + repeats_table(m);
}

}  // namespace manoscope::report
