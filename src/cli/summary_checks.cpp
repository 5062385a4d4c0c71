#include "summary_checks.hpp"

#include "manoscope/report/advice.hpp"
#include "manoscope/report/check_summary.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
using results::Measurement;

std::string checks_text(const Measurement& m, const Screen& screen) {
  std::string text;
  for (const std::string& line : report::check_lines(m)) text += line + '\n';
  text = wrapped(text + report::advice_text(m), screen.columns);
  return text.empty() ? text : "\nChecks without truth\n" + text;
}

}  // namespace manoscope::cli
