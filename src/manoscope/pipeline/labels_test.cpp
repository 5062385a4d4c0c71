// What the experiment file says of gauge, fluid and pump, from the file to the error bars.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "manoscope/pipeline/stages.hpp"
#include "manoscope/pipeline/test_experiment.hpp"

namespace manoscope::pipeline {
namespace {

using results::Measurement;

/// The label of the map at 0 Pa, as the list of the virtual experiment has it: vented.
constexpr const char* kVented = "h00.gsf,0.0,0,";

/// u^2 of p by source at a station, 0 for a source that is not in the budget.
double variance_of(const Measurement& m, const std::string& source, Index run, Index ix) {
  const auto at = std::find(m.budget_source.begin(), m.budget_source.end(), source);
  if (at == m.budget_source.end()) return 0.0;
  return m.pressure_variance[static_cast<std::size_t>(at - m.budget_source.begin())](run, ix);
}

/// The lists without any uncertainty of a label.
void forget_label_uncertainties(TestExperiment& test) {
  test.remove_line("pressure_noise");
  std::string csv = "map,pressure [Pa]\n";
  for (std::size_t k = 0; k < test.twin.truth.levels.size(); ++k) {
    const auto& level = test.twin.truth.levels[k];
    csv += level.map + "," + std::to_string(level.label.si()) + "\n";
  }
  test.twin.hydrostatic_csv = csv;
}

TEST(Labels, WithoutAnyUncertaintyAreOneWarningThatNamesTheMend) {
  TestExperiment test;
  const Measurement stated = test.measure();
  EXPECT_TRUE(stated.warnings.empty()) << all_warnings(stated);
  forget_label_uncertainties(test);
  const Measurement m = test.measure();
  ASSERT_EQ(m.warnings.size(), 1u) << all_warnings(m);
  EXPECT_TRUE(warns_of(m, "No pressure label has an uncertainty")) << all_warnings(m);
  EXPECT_TRUE(warns_of(m, "instrument.pressure_noise")) << all_warnings(m);
  EXPECT_TRUE(warns_of(m, "read on the curves of the other levels")) << all_warnings(m);
  // Labels carry 10 Pa: without them the bars lose the whole of that line of the budget.
  const Index middle = m.x.size() / 2;
  // Together they tell three to six numbers: 100 Pa2 times 6/24 and less.
  ASSERT_GT(variance_of(stated, "pressure labels", 0, middle), 3.0);
  ASSERT_LT(variance_of(stated, "pressure labels", 0, middle), 40.0);
  EXPECT_EQ(variance_of(m, "pressure labels", 0, middle), 0.0);
  // The instrument's own figure mends it.
  test.replace("[instrument]\n", "[instrument]\npressure_noise = \"10 Pa\"\n");
  const Measurement mended = test.measure();
  EXPECT_TRUE(mended.warnings.empty()) << all_warnings(mended);
  EXPECT_NEAR(mended.pressure_uncertainty(0, middle) / stated.pressure_uncertainty(0, middle), 1.0,
              2e-2);  // the label at 0 Pa has noise now, too: one of 17, 3 % of their part at most
}

TEST(Labels, AtZeroPressureHaveTheGaugesErrorsUnlessVented) {
  twin::Scenario scenario = small_scenario();
  scenario.flow_rates = {20.0 * mL_per_min};
  TestExperiment test(scenario);
  test.replace("[instrument]\n", "[instrument]\npressure_zero_uncertainty = \"5 Pa\"\n");
  const auto share = [&] {
    const auto experiment = test.read();
    const auto frame = place_channel(experiment).frame;
    const auto reduced = reduce_maps(experiment, frame, {}, 1, {});
    return make_levels(experiment, reduced.hydrostatic)[0];
  };
  EXPECT_EQ(share().gauge_share, 0.0);
  const Measurement vented = test.measure();
  TestExperiment::replace_in(test.twin.hydrostatic_csv, kVented, "h00.gsf,0.0,,");
  EXPECT_EQ(share().gauge_share, 1.0);
  EXPECT_EQ(share().uncertainty, 10.0 * Pa);  // instrument.pressure_noise
  const Measurement read = test.measure();
  EXPECT_EQ(vented.level_pressure_uncertainty[0], 0.0);
  EXPECT_EQ(read.level_pressure_uncertainty[0], 10.0);
  // No label is below the lowest reading by much: at the outlet the reading leans on the level at
  // 0 Pa, and a gauge that is off moves it wholly; far above it moves either wholly.
  Index lowest = 0, highest = 0;
  for (Index ix = 0; ix < read.x.size(); ++ix) {
    if (read.pressure_flags(0, ix) != 0 || vented.pressure_flags(0, ix) != 0) continue;
    if (lowest == 0 || read.pressure(0, ix) < read.pressure(0, lowest)) lowest = ix;
    if (highest == 0 || read.pressure(0, ix) > read.pressure(0, highest)) highest = ix;
  }
  // Moving every label by 5 Pa moves the reading by 5 Pa, but for the curve's bend in between.
  for (const Index ix : {lowest, highest}) {
    EXPECT_NEAR(std::sqrt(variance_of(read, "gauge zero", 0, ix)), 5.0, 0.1);
  }
  // A gauge that is off against an exact level bends the law of all labels: by a quarter here.
  EXPECT_NEAR(std::sqrt(variance_of(vented, "gauge zero", 0, highest)), 5.0, 1.25);
  EXPECT_LE(variance_of(vented, "gauge zero", 0, lowest),
            variance_of(read, "gauge zero", 0, lowest));
}

TEST(Labels, OfAGaugeWhoseNoiseNobodyKnowsStillHaveItsZero) {
  TestExperiment test;
  forget_label_uncertainties(test);
  test.replace("[instrument]\n", "[instrument]\npressure_zero_uncertainty = \"5 Pa\"\n");
  const Measurement m = test.measure();
  const Index middle = m.x.size() / 2;
  for (const Index r : {0, 1}) {
    EXPECT_NEAR(std::sqrt(variance_of(m, "gauge zero", r, middle)), 5.0, 0.1);
    EXPECT_EQ(variance_of(m, "pressure labels", r, middle), 0.0);
  }
}

TEST(FluidAndPump, EnterTheUncertaintyOfQRByHand) {
  TestExperiment test;
  const Measurement exact = test.measure();
  EXPECT_EQ(exact.viscosity_uncertainty, 0.0);
  EXPECT_EQ(exact.flow_rate_uncertainty[1], 0.0);
  test.replace("[fluid]\n", "[fluid]\nviscosity_uncertainty = \"0.02 mPa s\"\n");
  test.replace("[instrument]\n", "[instrument]\nflow_rate_uncertainty = 0.015\n");
  const Measurement m = test.measure();
  EXPECT_DOUBLE_EQ(m.viscosity, 1e-3);
  EXPECT_DOUBLE_EQ(m.viscosity_uncertainty, 2e-5);
  for (const Index r : {0, 1}) {
    EXPECT_DOUBLE_EQ(m.flow_rate_uncertainty[r], 0.015 * m.flow_rate[r]);
    const double qr = exact.resistance_drop[r], maps = exact.resistance_drop_uncertainty[r];
    EXPECT_EQ(m.resistance_drop[r], qr);
    // 2 % and 1.5 % of QR are 2.5 % of it.
    EXPECT_NEAR(m.resistance_drop_uncertainty[r] / std::hypot(maps, 0.025 * qr), 1.0, 1e-9);
    EXPECT_EQ(m.extracted_drop_uncertainty[r], exact.extracted_drop_uncertainty[r]);
    // What u(QR)^2 gains the difference gains, for the reading knows neither of the two.
    const double difference = std::abs(m.extracted_drop[r] - qr);
    const double before = difference / (2.0 * exact.en_number[r]);
    EXPECT_NEAR(m.en_number[r] / (difference / (2.0 * std::hypot(before, 0.025 * qr))), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace manoscope::pipeline
