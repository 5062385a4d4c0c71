#include "manoscope/report/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>

#include "manoscope/report/figures.hpp"
#include "manoscope/report/gnuplot.hpp"
#include "manoscope/report/html_text.hpp"
#include "manoscope/report/wording.hpp"
#include "tests/support/changed_environment.hpp"
#include "tests/support/example_measurement.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::report {
namespace {

using results::ExtraFile;
using results::Measurement;
using test_support::example_measurement;
using test_support::TemporaryFolder;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool gnuplot_is_missing() { return !run_gnuplot("exit"); }

const std::string& page_of(const std::vector<ExtraFile>& files) {
  for (const ExtraFile& file : files) {
    if (file.name == "report.html") return file.bytes;
  }
  throw std::runtime_error("no report.html");
}

std::set<std::string> names_of(const std::vector<ExtraFile>& files) {
  std::set<std::string> names;
  for (const ExtraFile& file : files) names.insert(file.name.generic_string());
  return names;
}

/// Python's own XML parser accepts every SVG: an independent judge of well-formedness.
void expect_well_formed(const std::vector<ExtraFile>& files) {
  const TemporaryFolder folder;
  std::string paths;
  for (const ExtraFile& file : files) {
    if (file.name.extension() != ".svg") continue;
    const auto path = folder / file.name.filename();
    std::ofstream(path) << file.bytes;
    paths += " '" + path.string() + "'";
  }
  if (paths.empty()) return;
  const std::string command =
      std::string(test_paths::python) +
      " -c 'import sys, xml.dom.minidom as d; [d.parse(p) for p in sys.argv[1:]]'" + paths;
  EXPECT_EQ(std::system(command.c_str()), 0);
}

/// Every element that is opened is closed, in order: the page is well formed.
void expect_balanced(const std::string& page) {
  const TemporaryFolder folder;
  std::ofstream(folder / "page.html") << page;
  std::ofstream(folder / "check.py") << R"(
import html.parser, sys
VOID = {"meta", "br", "link", "img", "input", "hr"}
class Check(html.parser.HTMLParser):
    def __init__(self):
        super().__init__(); self.open = []; self.ids = set(); self.scripts = 0
    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ("src", "href", "xlink:href", "data", "action") and not value.startswith(("#", "data:image/png;base64,")):
                sys.exit(f"loads {value}")
            if name == "id":
                if value in self.ids: sys.exit(f"id {value} twice")
                self.ids.add(value)
            if name.startswith("on"): sys.exit(f"script in {name}")
        if tag == "script": self.scripts += not dict(attrs).get("type")
        if tag in ("iframe", "object", "embed", "link"): sys.exit(f"element {tag}")
        if tag not in VOID: self.open.append(tag)
    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID: self.open.pop()
    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag: sys.exit(f"stray </{tag}> at {self.getpos()}")
check = Check(); text = open(sys.argv[1], encoding="utf-8").read()
if "url(http" in text or "@import" in text: sys.exit("style loads something")
check.feed(text); check.close()
if check.scripts != 1: sys.exit(f"{check.scripts} scripts")
sys.exit(f"left open: {check.open}" if check.open else 0)
)";
  const std::string command = std::string(test_paths::python) + " " +
                              (folder / "check.py").string() + " " +
                              (folder / "page.html").string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(Report, HoldsAFigureForEachOfThePaper) {
  if (gnuplot_is_missing()) GTEST_SKIP() << "gnuplot is not installed";
  const auto files = make_report(example_measurement());
  const auto names = names_of(files);
  for (const char* name :
       {"fig1d_static_profiles", "fig1ef_crest_deflection", "fig2a_pressure_drop",
        "fig2b_flow_profiles", "fig3a_profiles_overlaid", "fig3b_pressure_lowest_flow",
        "fig3c_pressure_highest_flow", "fig4_drop_agreement", "pressure_all_runs", "channel_place",
        "flow_corrections", "wall_shear"}) {
    EXPECT_TRUE(names.contains(std::string("figures/") + name + ".svg")) << name;
  }
  EXPECT_TRUE(names.contains("report.html"));
  expect_well_formed(files);
}

TEST(Report, IsOnePageThatLoadsNothingAndRunsItsOwnScriptAlone) {
  expect_balanced(page_of(make_report(example_measurement())));
}

TEST(Report, HasTheSameBytesEveryTime) {
  const auto measurement = example_measurement({.n_x = 60});
  const auto first = make_report(measurement, {.pdf = true}),
             second = make_report(measurement, {.pdf = true});
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].name, second[i].name);
    EXPECT_TRUE(first[i].bytes == second[i].bytes) << first[i].name;
  }
}

TEST(Report, WritesPdfWhereAsked) {
  if (gnuplot_is_missing()) GTEST_SKIP() << "gnuplot is not installed";
  const auto measurement = example_measurement({.n_x = 40, .n_levels = 3, .n_runs = 1});
  int n_pdf = 0;
  for (const ExtraFile& file : make_report(measurement, {.pdf = true})) {
    if (file.name.extension() != ".pdf") continue;
    EXPECT_EQ(file.bytes.substr(0, 5), "%PDF-");
    EXPECT_EQ(file.bytes.find("CreationDate (D:20"), std::string::npos);
    ++n_pdf;
  }
  if (n_pdf == 0) GTEST_SKIP() << "this gnuplot has no PDF terminal";
  EXPECT_GT(n_pdf, 5);
  EXPECT_FALSE(names_of(make_report(measurement)).contains("figures/fig1d_static_profiles.pdf"));
}

TEST(Report, ShowsEveryTextOfTheUserAsText) {
  auto measurement = example_measurement({.n_x = 40, .n_levels = 3, .n_runs = 2});
  const std::string hostile = "<script>alert('x')</script>\"&`ls`";
  measurement.title = measurement.source = measurement.history = hostile;
  measurement.settings = measurement.inputs = measurement.experiment = hostile;
  measurement.warnings = {hostile};
  measurement.run[0] = measurement.map[0] = measurement.budget_source[0] = hostile;
  const auto files = make_report(measurement);
  for (const ExtraFile& file : files) {
    EXPECT_EQ(file.bytes.find("<script>alert"), std::string::npos) << file.name;
  }
  expect_balanced(page_of(files));
  const std::string escaped = "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&quot;&amp;`ls`";
  std::size_t n = 0;
  const std::string& page = page_of(files);
  for (auto at = page.find(escaped); at != std::string::npos; at = page.find(escaped, at + 1)) ++n;
  EXPECT_GE(n, 10u);  // title twice, source twice, six texts, run twice, map, source of the budget
}

TEST(Report, WithoutGnuplotHoldsTheTablesAndSaysSo) {
  const test_support::ChangedEnvironment path("PATH", "/nonexistent");
  const auto files = make_report(example_measurement({.n_x = 40, .n_levels = 3, .n_runs = 2}));
  EXPECT_EQ(names_of(files), std::set<std::string>{"report.html"});
  const std::string& page = page_of(files);
  EXPECT_NE(page.find("gnuplot is not installed"), std::string::npos);
  EXPECT_NE(page.find(">Q10<"), std::string::npos);
  EXPECT_EQ(page.find("<figure"), std::string::npos);
}

TEST(Report, ManagesWithLittleOrBrokenData) {
  std::vector<Measurement> cases;
  cases.push_back(example_measurement({.n_x = 40, .n_levels = 5, .n_runs = 0}));
  cases.push_back(example_measurement({.n_x = 40, .n_levels = 5, .n_runs = 1}));
  cases.push_back(example_measurement({.n_x = 40, .n_levels = 1, .n_runs = 1, .crossings = false}));
  cases.push_back(example_measurement({.n_x = 1, .n_levels = 1, .n_runs = 1}));
  auto blind = example_measurement({.n_x = 40, .n_levels = 5, .n_runs = 2});  // nothing was read
  for (Array2* array :
       {&blind.pressure, &blind.pressure_uncertainty, &blind.pressure_lower, &blind.pressure_upper,
        &blind.resistance_pressure, &blind.deflection, &blind.test_section}) {
    array->setConstant(kNan);
  }
  for (Array1* array :
       {&blind.extracted_drop, &blind.extracted_drop_uncertainty, &blind.resistance_drop,
        &blind.transducer_drop, &blind.en_number, &blind.channel_resistance_drop}) {
    array->setConstant(kNan);
  }
  cases.push_back(blind);
  auto buckled =
      example_measurement({.n_x = 40, .n_levels = 5, .n_runs = 2});  // negative throughout
  buckled.crest_deflection = -buckled.crest_deflection.abs();
  buckled.extracted_drop = -buckled.extracted_drop;
  cases.push_back(buckled);
  auto flat = example_measurement({.n_x = 40, .n_levels = 5, .n_runs = 3});  // all numbers equal
  flat.flow_rate.setConstant(1e-7);
  flat.static_deflection.setZero();
  flat.crest_deflection.setZero();
  flat.deflection.setZero();
  flat.pressure.setZero();
  flat.pressure_uncertainty.setZero();
  flat.extracted_drop.setZero();
  flat.resistance_drop.setZero();
  cases.push_back(flat);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(i);
    const auto files = make_report(cases[i]);
    EXPECT_EQ(page_of(files).find("gnuplot refused"), std::string::npos) << page_of(files);
    expect_well_formed(files);
    expect_balanced(page_of(files));
  }
}

TEST(Report, ShowsADropWithItsExpandedUncertainty) {
  auto measurement = example_measurement({.n_x = 40, .n_levels = 5, .n_runs = 1});
  measurement.extracted_drop(0) = 14234.9;
  measurement.extracted_drop_uncertainty(0) = 59.3;  // times 2: 119
  measurement.en_number(0) = 1.7;
  const std::string page = page_of(make_report(measurement));
  EXPECT_NE(page.find("<td>14.23 ± 0.12</td>"), std::string::npos);
  EXPECT_NE(page.find("beyond U"), std::string::npos);
  // What eq. (4) is off by itself is not in that E_n, and the table says so.
  EXPECT_NE(page.find("may be the formula's"), std::string::npos);
  EXPECT_EQ(page.find("disagrees"), std::string::npos);
}

TEST(Report, GivesNoVerdictOnRunsWhoseGapIsNotKnown) {
  auto measurement = example_measurement({.n_x = 40, .n_levels = 5, .n_runs = 2});
  measurement.channel_height_uncertainty = 0.0;
  measurement.en_number.setConstant(kNan);
  measurement.model_en_number.setConstant(kNan);
  const std::string page = page_of(make_report(measurement));
  EXPECT_NE(page.find("No run could be judged against the flow: the uncertainty of the gap "
                      "(channel.height_uncertainty) is missing"),
            std::string::npos);
  EXPECT_NE(page.find("it leaves out the gap, whose uncertainty is not stated"), std::string::npos);
  EXPECT_EQ(page.find("U(QR) holds gap"), std::string::npos);
}

TEST(ResistanceUncertaintyText, SaysWhatCountsAsExact) {
  results::Measurement m;
  m.channel_height_uncertainty = 0.5e-6;
  m.flow_rate_uncertainty = Array1::Zero(2);
  const auto says = [&](const std::string& part) {
    EXPECT_NE(resistance_uncertainty_text(m).find(part), std::string::npos)
        << resistance_uncertainty_text(m);
  };
  says("flow rate and viscosity count as exact");
  m.viscosity_uncertainty = 1e-5;
  says("viscosity; the flow rate counts as exact");
  m.flow_rate_uncertainty[0] = 1e-9;  // a run at rest has 0
  EXPECT_EQ(resistance_uncertainty_text(m).find("exact"), std::string::npos);
  m.viscosity_uncertainty = 0.0;
  says("flow rate; the viscosity counts as exact");
}

TEST(EscapeHtml, LeavesNoMarkupAndNoControlCharacters) {
  EXPECT_EQ(escape_html("a<b>&\"'\n\tµ"), "a&lt;b&gt;&amp;&quot;&#39;\n\tµ");
  EXPECT_EQ(escape_html(std::string("\x01", 1)), "\xEF\xBF\xBD");
}

TEST(InlineSvg, GivesIdentifiersOfItsOwnAndNoProlog) {
  const std::string svg =
      "<?xml version='1.0'?>\n<svg width=\"1\"><path id='a'/><use xlink:href='#a'/></svg>";
  EXPECT_EQ(inline_svg(svg, "fig"),
            "<svg role=\"img\" width=\"1\"><path id='fig-a'/><use xlink:href='#fig-a'/></svg>");
}

}  // namespace
}  // namespace manoscope::report
