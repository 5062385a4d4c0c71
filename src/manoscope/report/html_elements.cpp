#include "manoscope/report/html_elements.hpp"

#include <fmt/format.h>

#include <cmath>

#include "manoscope/report/html_text.hpp"
#include "manoscope/report/number_text.hpp"

namespace manoscope::report {

std::string cell(const std::string& content) { return "<td>" + content + "</td>"; }

std::string row_head(std::string_view label) {
  return "<th scope=\"row\">" + escape_html(label) + "</th>";
}

std::string column_head(const std::string& content) {
  return "<th scope=\"col\">" + content + "</th>";
}

std::string chance_text(double chance, double least) {
  if (!std::isfinite(chance)) return "–";
  if (chance >= 1e-3) return number_text(chance, 2);
  const std::string text =
      chance > 0.0 ? fmt::format("10<sup>{:.0f}</sup>", std::floor(std::log10(chance))) : "0";
  return chance < least ? "<span class=\"bad\">" + text + "</span>" : text;
}

const char* verdict_style(FlowVerdict verdict) {
  switch (verdict) {
    case FlowVerdict::agrees:
      return "good";
    case FlowVerdict::only_drop:
      return "half";
    case FlowVerdict::differs:
      return "bad";
    case FlowVerdict::none:
      break;
  }
  return "none";
}

std::string agreement_cell(FlowVerdict verdict, bool doubtful, double share, double en_number,
                           double p_value) {
  std::string content =
      fmt::format("<span class=\"{}\">{} {}</span><br>{}", verdict_style(verdict),
                  doubtful ? "○" : "●", verdict_word(verdict), signed_percent_text(share));
  if (verdict != FlowVerdict::none) {
    content += fmt::format("<br><i>E</i><sub>n</sub> {:.2f}, <i>p</i> {}", en_number,
                           chance_text(p_value, 0.0));
  }
  return cell(content);
}

std::string table(const std::string& caption, const std::string& head, const std::string& body,
                  bool tall) {
  return fmt::format(
      "<p class=\"caption\">{}</p>\n<div class=\"scroll{}\"><table>\n<thead><tr>{}</tr></thead>\n"
      "<tbody>\n{}</tbody></table></div>\n",
      caption, tall ? " tall" : "", head, body);
}

}  // namespace manoscope::report
