#include "manoscope/report/page_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "manoscope/report/html_interactive.hpp"
#include "manoscope/report/page_bundle.hpp"
#include "manoscope/report/report.hpp"
#include "manoscope/results/write.hpp"
#include "tests/support/example_measurement.hpp"
#include "tests/support/example_pictures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::report {
namespace {

using nlohmann::json;
using results::Measurement;
using test_support::example_measurement;

Measurement with_pictures() {
  auto m = example_measurement({.n_x = 60, .n_levels = 5, .n_runs = 2});
  test_support::add_example_pictures(m);
  return m;
}

TEST(PageData, HoldsTheNumbersOfTheResult) {
  const Measurement m = with_pictures();
  const json data = json::parse(page_data(m));
  ASSERT_EQ(data["x"].size(), 60u);
  ASSERT_EQ(data["runs"].size(), 2u);
  Index n_numbers = 0;
  for (Index run = 0; run < 2; ++run) {
    const json& own = data["runs"][static_cast<std::size_t>(run)];
    for (Index ix = 0; ix < 60; ++ix) {
      const json& p = own["pressure"][static_cast<std::size_t>(ix)];
      if (std::isnan(m.pressure(run, ix))) {
        EXPECT_TRUE(p.is_null());
        continue;
      }
      ++n_numbers;
      EXPECT_NEAR(p.get<double>(), m.pressure(run, ix), 1e-5 * std::abs(m.pressure(run, ix)));
    }
  }
  EXPECT_GT(n_numbers, 60);
  EXPECT_LT(n_numbers, 120);  // some stations have none: null was seen
  EXPECT_EQ(data["maps"]["list"].size(), m.map.size());
  EXPECT_TRUE(data["maps"]["list"].back()["pressure"].is_null());
}

TEST(PageData, GoesIntoThePageWithoutEndingItsElement) {
  Measurement m = with_pictures();
  const std::string hostile = "</script><script>alert(1)</script><!-- \xff";
  m.title = m.run[0] = m.map[0] = m.budget_source[0] = hostile;
  const json data = json::parse(page_data(m));
  EXPECT_EQ(data["runs"][0]["name"], "</script><script>alert(1)</script><!-- \xEF\xBF\xBD");
  const std::string tail = interactive_place(m) + interactive_tail(m);
  std::size_t n = 0;  // our own elements and none besides: data, maps, script
  for (auto at = tail.find("<script"); at != std::string::npos; at = tail.find("<script", at + 1)) {
    ++n;
  }
  EXPECT_EQ(n, m.map.size() + 2);
  EXPECT_EQ(tail.find("alert(1)"), std::string::npos);
}

TEST(PageData, OfACalibrationAloneHasNoRuns) {
  const json data =
      json::parse(page_data(example_measurement({.n_x = 40, .n_levels = 4, .n_runs = 0})));
  EXPECT_EQ(data["runs"].size(), 0u);
  EXPECT_TRUE(data["maps"].is_null());
  EXPECT_EQ(data["levels"]["deflection"].size(), 4u);
}

TEST(PageBundle, CanStandInAPage) {
  const std::string_view script = page_script();
  EXPECT_GT(script.size(), 10000u);
  EXPECT_LE(script.size(), 150000u);
  for (const char* end : {"</script", "<!--", "<script"}) {
    EXPECT_EQ(script.find(end), std::string_view::npos) << end;
  }
  EXPECT_EQ(script.find('\r'), std::string_view::npos);  // a page reads it as \n: another hash
  EXPECT_EQ(page_style().find("</style"), std::string_view::npos);
  EXPECT_EQ(page_style().find("url(http"), std::string_view::npos);
}

std::string page_of(const Measurement& m, bool interactive = true) {
  return make_report(m, {.interactive = interactive}).back().bytes;
}

TEST(InteractiveReport, IsTheSameFromTheResultReadBack) {
  const test_support::TemporaryFolder folder;
  const Measurement m = with_pictures();
  const auto files = make_report(m);
  results::write_result(folder.path(), m, files);
  Measurement back = results::read_result(folder.path());
  back.map_picture = results::read_maps(folder.path(), back);
  EXPECT_TRUE(page_of(back) == files.back().bytes);
}

TEST(InteractiveReport, SaysWhereItHasNoMaps) {
  Measurement m = with_pictures();
  EXPECT_EQ(page_of(m).find("maps are not at hand"), std::string::npos);
  EXPECT_NE(page_of(m).find("id=\"map-6\""), std::string::npos);
  m.map_picture.clear();
  const std::string page = page_of(m);
  EXPECT_NE(page.find("maps are not at hand"), std::string::npos);
  EXPECT_EQ(page.find("id=\"map-0\""), std::string::npos);
}

TEST(InteractiveReport, ForbidsRequestsAndOtherScripts) {
  const std::string page = page_of(with_pictures());
  EXPECT_NE(page.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
  EXPECT_EQ(page.find("unsafe-eval"), std::string::npos);
}

TEST(InteractiveReport, HoldsNoScriptWhereNotWanted) {
  const std::string page = page_of(with_pictures(), false);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("id=\"explore\""), std::string::npos);
}

}  // namespace
}  // namespace manoscope::report
