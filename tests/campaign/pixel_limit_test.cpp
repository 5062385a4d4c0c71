#include "tests/campaign/pixel_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "manoscope/pipeline/judged_stretch.hpp"
#include "tests/campaign/member.hpp"
#include "tests/campaign/varied_scenario.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::campaign {
namespace {

class PixelLimit : public ::testing::TestWithParam<const char*> {};

double rms_where(const Flags1& counts, const Array1& values) {
  return std::sqrt((counts != 0).select(values.square(), 0.0).sum() /
                   static_cast<double>((counts != 0).count()));
}

/// Near the ends the limit is none: a spline with such knots cannot follow p(x) there.
TEST_P(PixelLimit, IsNearlyReachedByWhatPixelNoiseDoesToTheReading) {
  twin::Scenario scenario = varied_scenario(GetParam(), 0);
  scenario.camera = twin::resized(scenario.camera, "512x96");
  scenario.flow_rates = {scenario.flow_rates.back()};
  RecordProperty("sample", GetParam());
  const twin::SolvedScenario solved = twin::solve_scenario(scenario);
  const test_support::TemporaryFolder scratch;
  const MeasuredMember member =
      measure_member({GetParam(), 0, 1}, scenario, solved, scratch.path());
  const results::Measurement& m = member.measurement;
  const Array1& truth = member.truth.runs.front().pressure;
  const Array1 limit = pixel_limit(scenario, member.truth.x, truth, m.x);
  Array1 variance = Array1::Zero(m.x.size());
  for (std::size_t s = 0; s < m.budget_source.size(); ++s) {
    if (m.budget_source[s] == "pixel noise") variance = m.pressure_variance[s].row(0);
  }
  for (const Stretch& stretch : kStretches) {
    const Flags1 counts = pipeline::answers(pipeline::within(m.x, stretch.start, stretch.end),
                                            Array1(m.pressure.row(0)));
    const double ours = rms_where(counts, variance.sqrt()), least = rms_where(counts, limit);
    RecordProperty(std::string("pixel_part_over_limit_") + stretch.name,
                   std::to_string(ours * ours / (least * least)));
    if (&stretch == &kStretches[0]) {
      // Beyond the limit: a width average is no best estimate across the wall (1.2 to 1.4), levels
      // have noise as well (1.5), and neighbouring stations whose errors go together count for
      // fewer. Below it: a smooth p(x) is preferred to any with knots half a millimetre apart.
      EXPECT_LT(ours * ours, 5.0 * least * least);
      EXPECT_GT(ours * ours, 0.8 * least * least);
    }
    std::printf("%s %-7s pixels' part %.2f Pa, limit %.2f Pa: %.2f of its variance\n", GetParam(),
                stretch.name, ours, least, ours * ours / (least * least));
  }
}

INSTANTIATE_TEST_SUITE_P(Of, PixelLimit, ::testing::Values("S1", "S5"));
// The others as well in `make goals`.
INSTANTIATE_TEST_SUITE_P(DISABLED_Of, PixelLimit, ::testing::Values("S2", "S3", "S4"));

}  // namespace
}  // namespace manoscope::campaign
