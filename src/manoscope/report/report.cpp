#include "manoscope/report/report.hpp"

#include <optional>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/report/figures.hpp"
#include "manoscope/report/html.hpp"

namespace manoscope::report {

std::vector<results::ExtraFile> make_report(const results::Measurement& measurement,
                                            const ReportOptions& options) {
  std::vector<results::ExtraFile> files;
  std::vector<ShownFigure> shown;
  std::vector<std::string> notes;
  for (Figure& figure : figures(measurement)) {
    std::optional<DrawnFigure> drawn;
    try {
      drawn = draw(figure, options.pdf);
    } catch (const InternalError& error) {
      // Hours of measurement are not lost for a figure: the page says what is missing.
      notes.emplace_back(error.what());
      continue;
    }
    if (!drawn) {
      notes.emplace_back(
          "gnuplot is not installed: this report holds no figures. Install gnuplot and "
          "make the report again.");
      break;
    }
    files.push_back({"figures/" + figure.name + ".svg", drawn->svg});
    if (options.pdf && drawn->pdf.empty() && notes.empty()) {
      notes.emplace_back("gnuplot has no PDF terminal here: the figures are there as SVG only.");
    }
    if (!drawn->pdf.empty()) files.push_back({"figures/" + figure.name + ".pdf", drawn->pdf});
    shown.push_back({std::move(figure), std::move(drawn->svg)});
  }
  files.push_back({"report.html", html_page(measurement, shown, notes, options.interactive)});
  return files;
}

}  // namespace manoscope::report
