#include "manoscope/report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "manoscope/report/html_checks.hpp"
#include "manoscope/report/html_flow.hpp"
#include "manoscope/report/html_interactive.hpp"
#include "manoscope/report/html_style.hpp"
#include "manoscope/report/html_tables.hpp"
#include "manoscope/report/html_text.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

/// How many runs agree, in a sentence.
std::string agreement_sentence(const Measurement& m) {
  if (m.run.empty()) {
    return "<p>The experiment has no flow runs: what follows is the calibration alone.</p>\n";
  }
  Index n_judged = 0, n_agree = 0;
  for (Index run = 0; run < m.en_number.size(); ++run) {
    if (!std::isfinite(m.en_number(run))) continue;
    ++n_judged;
    n_agree += m.en_number(run) <= 1.0 ? 1 : 0;
  }
  if (n_judged == 0) {
    const bool no_gap = !std::isgreater(m.channel_height_uncertainty, 0.0);
    return fmt::format("<p>No run could be judged against the flow: {} is missing.</p>\n",
                       no_gap ? "the uncertainty of the gap (channel.height_uncertainty)"
                              : "a drop or its uncertainty");
  }
  return fmt::format(
      "<p>In {} of {} runs the pressure drop read off the wall lies within the expanded "
      "uncertainty "
      "of <i>QR</i> of the measured gap, the paper's eq. (4) taken as exact.</p>\n",
      n_agree, n_judged);
}

/// How many doubts there are, for the summary.
std::string warnings_sentence(const Measurement& m, const std::vector<std::string>& notes) {
  const std::size_t n = m.warnings.size() + notes.size();
  if (n == 0) return {};
  return fmt::format("<p><a href=\"#warnings\">{} {}</a> below.</p>\n", n,
                     n == 1 ? "warning" : "warnings");
}

std::string warnings_list(const Measurement& m, const std::vector<std::string>& notes) {
  std::string items;
  for (const auto* list : {&m.warnings, &notes}) {
    for (const std::string& text : *list) items += "<li>" + escape_html(text) + "</li>\n";
  }
  if (items.empty()) return "<p id=\"warnings\">No warnings.</p>\n";
  return "<h2 id=\"warnings\">Warnings</h2>\n<ul class=\"warnings\">\n" + items + "</ul>\n";
}

/// The subscripts of our own captions.
std::string with_subscripts(std::string text) {
  for (const auto& [plain_text, html] : {std::pair{"Δp_e", "Δ<i>p</i><sub>e</sub>"},
                                         {"E_n", "<i>E</i><sub>n</sub>"},
                                         {"ζ_p", "<i>ζ</i><sub>p</sub>"}}) {
    const std::string_view from(plain_text), to(html);
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
  }
  return text;
}

std::string figures_part(const std::vector<ShownFigure>& shown) {
  if (shown.empty()) return {};
  std::string part = "<h2 id=\"figures\">Figures</h2>\n<div class=\"figures\">\n";
  for (const ShownFigure& entry : shown) {
    part += fmt::format("<figure{} id=\"{}\">\n{}\n<figcaption><b>{}</b>{}</figcaption></figure>\n",
                        entry.figure.width > 700 ? " class=\"wide\"" : "", entry.figure.name,
                        inline_svg(entry.svg, entry.figure.name), escape_html(entry.figure.title),
                        with_subscripts(escape_html(entry.figure.caption)));
  }
  return part + "</div>\n";
}

std::string opening_part() {
  return R"page(<h2 id="open">Opening the result</h2>
<p>Everything is in <code>result.nc</code> (NetCDF-4, SI units), next to this page;
<code>pressure.csv</code> and <code>drops.csv</code> hold the main numbers as plain tables.</p>
<p>Python:</p>
<pre>import xarray
result = xarray.open_dataset("result.nc")
result.pressure.sel(run=result.run[0])          # p(x) of the first run, Pa
result.pressure_uncertainty                     # standard uncertainty, k = 1
result.pressure_covariance                      # (run, x, x_other), Pa2</pre>
<p>MATLAB:</p>
<pre>x = ncread("result.nc", "x");                   % m
p = ncread("result.nc", "pressure");            % Pa, size (x, run)
u = ncread("result.nc", "pressure_uncertainty");
plot(1e3*x, p/1e3); xlabel("x (mm)"); ylabel("p (kPa)")</pre>
)page";
}

std::string details(const char* summary, const std::string& content) {
  if (content.empty()) return {};
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", summary, content);
}

std::string text_details(const char* summary, const std::string& text) {
  return details(summary, text.empty() ? "" : "<pre>" + escape_html(text) + "</pre>\n");
}

}  // namespace

std::string html_page(const Measurement& m, const std::vector<ShownFigure>& shown,
                      const std::vector<std::string>& notes, bool interactive) {
  const std::string name = escape_html(m.title.empty() ? "Measurement" : m.title);
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  page += "<title>" + name + " – pressure in the channel</title>\n";
  page += std::string("<style>") + kStyle + "</style>\n" +
          (interactive ? interactive_head() : std::string()) + "</head>\n<body>\n<main>\n";
  page += "<h1>" + name + "</h1>\n";
  page +=
      "<p class=\"by\">Gauge pressure inside a micro-channel, read off the deflection of its "
      "wall. " +
      escape_html(m.source) + "</p>\n";
  page +=
      "<nav aria-label=\"Contents\"><a href=\"#summary\">Summary</a><a "
      "href=\"#warnings\">Warnings</a>";
  page += shown.empty() ? "" : "<a href=\"#figures\">Figures</a>";
  const std::string flow = flow_part(m);
  page += flow.empty() ? "" : "<a href=\"#flow\">Flow models</a>";
  page += m.run.empty() ? "" : "<a href=\"#budget\">Uncertainty</a>";
  const std::string checks = checks_part(m);
  page += checks.empty() ? "" : "<a href=\"#checks\">Checks</a>";
  page +=
      "<a href=\"#maps\">Maps</a><a href=\"#flags\">Flags</a><a href=\"#open\">Opening the "
      "result</a>"
      "<a href=\"#provenance\">Provenance</a></nav>\n";
  page += "<section class=\"card\" id=\"summary\">\n" + agreement_sentence(m) +
          verdict_sentence(m) + warnings_sentence(m, notes) + facts_list(m) + "</section>\n";
  page += runs_table(m);
  page += reading_list(m);
  page += warnings_list(m, notes);
  if (interactive) page += interactive_place(m);
  page += figures_part(shown);
  page += flow;
  if (const auto budget = budget_table(m); !budget.empty()) {
    page += "<h2 id=\"budget\">Where the uncertainty comes from</h2>\n" + budget;
  }
  if (const auto law = tube_law_table(m); !law.empty()) {
    page += "<h2 id=\"tube-law\">Tube law</h2>\n" + law;
  }
  page += checks;
  page += "<h2 id=\"maps\">Maps</h2>\n" + maps_table(m);
  page += "<h2 id=\"flags\">Flags</h2>\n" + flags_table(m);
  page += opening_part();
  page += "<h2 id=\"provenance\">Provenance</h2>\n";
  page += "<dl class=\"facts\"><dt>Made by</dt><dd>" + escape_html(m.source) +
          "</dd><dt>Command</dt><dd><code>" + escape_html(m.history) + "</code></dd></dl>\n";
  page += text_details("Settings in force", m.settings);
  page += text_details("experiment.toml", m.experiment);
  page += text_details("Input files and their SHA-256", m.inputs);
  page += "</main>\n";
  if (interactive) page += interactive_tail(m);
  return page + "</body>\n</html>\n";
}

}  // namespace manoscope::report
