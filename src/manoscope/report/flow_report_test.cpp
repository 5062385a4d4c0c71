#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/report/figures.hpp"
#include "manoscope/report/gnuplot.hpp"
#include "manoscope/report/html_flow.hpp"
#include "manoscope/report/html_flow_drops.hpp"
#include "tests/support/example_measurement.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;
using test_support::example_measurement;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Measurement example(Index n_runs = 3) {
  return example_measurement({.n_x = 40, .n_levels = 5, .n_runs = n_runs});
}

/// As a result without flow models has it: no name, tables without rows.
Measurement without_models(Index n_runs = 3) {
  Measurement m = example(n_runs);
  m.flow_model.clear();
  m.correction.clear();
  m.passage_term.clear();
  m.model_pressure.clear();
  m.verdict_model.clear();
  m.flow_setup.clear();
  m.verdict.assign(m.run.size(), "");
  for (Array2* table : {&m.model_drop, &m.model_drop_uncertainty, &m.model_difference_uncertainty,
                        &m.model_en_number, &m.model_chi_square, &m.model_dof, &m.model_p_value,
                        &m.model_stated_error, &m.correction_drop, &m.correction_channel_drop,
                        &m.correction_uncertainty, &m.passage_drop, &m.passage_drop_uncertainty}) {
    *table = Array2(0, n_runs);
  }
  for (Array2* field : {&m.local_reynolds, &m.wall_shear_roof, &m.wall_shear_floor,
                        &m.predicted_pressure, &m.predicted_pressure_uncertainty}) {
    field->setConstant(kNan);
  }
  for (Array1* scalar :
       {&m.inferred_flow_rate, &m.inferred_flow_rate_uncertainty, &m.inferred_viscosity,
        &m.inferred_viscosity_uncertainty, &m.reduced_reynolds, &m.friction_drag,
        &m.relative_friction_drag, &m.compliant_drop, &m.compliant_drop_uncertainty,
        &m.predicted_drop, &m.predicted_drop_uncertainty, &m.predicted_en_number}) {
    scalar->setConstant(kNan);
  }
  for (double* fit :
       {&m.drop_fit_linear, &m.drop_fit_quadratic, &m.drop_fit_exponent, &m.drop_fit_power}) {
    *fit = kNan;
  }
  return m;
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

void expect_drawn(const std::optional<Figure>& figure) {
  ASSERT_TRUE(figure);
  EXPECT_NO_THROW(draw(*figure, false)) << figure->name;
}

TEST(FlowFigures, AreDrawnOfOneRunAndOfMany) {
  for (const Index n_runs : {1, 2, 8}) {
    const Measurement m = example(n_runs);
    for (const auto& figure : {flow_corrections(m), wall_shear(m), pressure_at_highest_flow(m),
                               drop_agreement(m), pressure_drop(m)}) {
      expect_drawn(figure);
    }
  }
}

TEST(FlowFigures, AreNotThereWithoutModels) {
  const Measurement m = without_models();
  EXPECT_FALSE(flow_corrections(m));
  EXPECT_FALSE(wall_shear(m));
  EXPECT_FALSE(flow_corrections(Measurement{}));
  EXPECT_FALSE(wall_shear(Measurement{}));
  EXPECT_FALSE(flow_corrections(example(0)));
  EXPECT_FALSE(wall_shear(example(0)));
}

TEST(FlowFigures, WithoutModelsShowWhatThePaperShows) {
  const Measurement m = without_models();
  for (const auto& figure : {pressure_at_highest_flow(m), drop_agreement(m), pressure_drop(m)}) {
    expect_drawn(figure);
    EXPECT_FALSE(holds(figure->script + figure->caption, "march")) << figure->name;
    EXPECT_FALSE(holds(figure->script + figure->caption, "nan")) << figure->name;
  }
  EXPECT_FALSE(holds(pressure_at_highest_flow(m)->script, "multiplot"));
  EXPECT_FALSE(holds(pressure_drop(m)->script, "fit {"));
  EXPECT_FALSE(holds(pressure_drop(m)->script, "predicted"));
}

TEST(FlowFigures, ManageWithoutTransducer) {
  Measurement m = example();
  for (Array1* drop : {&m.transducer_drop, &m.transducer_drop_uncertainty, &m.parasitic_drop,
                       &m.parasitic_drop_uncertainty, &m.compliant_drop,
                       &m.compliant_drop_uncertainty, &m.predicted_en_number}) {
    drop->setConstant(kNan);
  }
  const auto figure = pressure_drop(m);
  expect_drawn(figure);
  EXPECT_FALSE(holds(figure->script, "transducer"));
  EXPECT_TRUE(holds(figure->script, "predicted"));
}

TEST(FlowFigures, LeaveOutOfTheCorrectionsARunWithoutADrop) {
  Measurement m = example();
  m.extracted_drop(0) = 20.0;  // its bar is 30
  m.flow_rate(1) = 0.0;
  const std::string script = flow_corrections(m)->script;
  EXPECT_TRUE(holds(script, "set xtics ('20' 1)")) << script;
  m.extracted_drop.setConstant(kNan);
  EXPECT_FALSE(flow_corrections(m));
}

TEST(FlowFigures, StackWhatAddsAboveWhatTakesBelowZero) {
  Measurement m = example(1);
  m.extracted_drop(0) = 1000.0;
  m.correction_drop.col(0) = Array1{{1010.0, -30.0, 50.0, 0.0, -28.0}};
  const std::string script = flow_corrections(m)->script;
  EXPECT_TRUE(holds(script, "1 0 0.68 1.08 0 -3\n")) << script;      // true section
  EXPECT_TRUE(holds(script, "1 0 0.68 1.08 0 5\n")) << script;       // inertia
  EXPECT_TRUE(holds(script, "1 -3 0.68 1.08 -3 -5.8\n")) << script;  // section march
  EXPECT_FALSE(holds(script, "title 'entry'"));                      // nothing to see
  EXPECT_TRUE(holds(script, "0.88 -0.8\n")) << script;               // all effects together
  // dp_e is 1 % below eq. (4); the bar is that of the difference from the section march.
  const double bar = 0.2 * m.model_difference_uncertainty(3, 0);
  EXPECT_TRUE(holds(script, fmt::format("1.24 -1 {:.6g}\n", bar))) << script;
}

TEST(FlowFigures, DrawNoTotalWhereTheMarchBrokeDown) {
  Measurement m = example(2);
  m.run = {"Q44", "Q50"};
  m.model_drop(3, 1) = m.correction_drop(4, 1) = kNan;
  const auto figure = flow_corrections(m);
  EXPECT_TRUE(holds(figure->script, "\n0.88 ")) << figure->script;  // the diamonds
  EXPECT_FALSE(holds(figure->script, "\n1.88 "));
  const std::string words = "The section march broke down in Q50: no total of all effects there.";
  EXPECT_TRUE(holds(figure->caption, words)) << figure->caption;
  EXPECT_FALSE(holds(flow_corrections(example(2))->caption, "broke down"));
  const std::string part = flow_part(m);
  EXPECT_TRUE(holds(part, words));
  EXPECT_TRUE(holds(part, "<td>–</td><td>–</td>")) << part;  // neither march nor total
}

TEST(FlowFigures, KeepTheTotalOfAFlowThatRunsBackwards) {
  Measurement m = example(2);  // its models do not march, and nothing broke down
  m.flow_rate(1) *= -1.0;
  m.model_drop(3, 1) = m.correction_drop(4, 1) = kNan;
  EXPECT_FALSE(holds(flow_corrections(m)->caption, "broke down"));
}

TEST(FlowFigures, SayThatAPredictionMayKnowTheMapByItsOutlet) {
  const Measurement m = example();
  const std::string words = "is taken from the reading of that very map";
  EXPECT_TRUE(holds(pressure_drop(m)->caption, words));
  EXPECT_TRUE(holds(channel_drops_table(m), words));
}

TEST(FlowFigures, SayHowTheFitWeightsTheDrops) {
  Measurement m = example();
  const std::string words = "Every drop counts by its own size";
  EXPECT_FALSE(holds(pressure_drop(m)->caption, words));
  m.transducer_drop_uncertainty(0) = 0.0;
  EXPECT_TRUE(holds(pressure_drop(m)->caption, words));
}

TEST(FlowFigures, DrawTheOtherModelsAgainstTheOneOfTheVerdict) {
  Measurement m = example(1);
  const std::string script = pressure_at_highest_flow(m)->script;
  for (const char* part : {"title 'section march'", "title 'momentum'", "title 'creeping flow'",
                           "title 'eq. (4)'", "p} − section march"}) {
    EXPECT_TRUE(holds(script, part)) << part;
  }
  m.model_pressure[3].setConstant(kNan);  // the march broke down
  EXPECT_TRUE(holds(pressure_at_highest_flow(m)->script, "p} − momentum"));
  for (Array2& pressure : m.model_pressure) pressure.setConstant(kNan);
  EXPECT_FALSE(holds(pressure_at_highest_flow(m)->script, "multiplot"));
}

TEST(FlowFigures, SayWhereTheFlowIsNotLaminar) {
  Measurement m = example(1);
  EXPECT_TRUE(holds(wall_shear(m)->caption, ": laminar"));
  m.local_reynolds.setConstant(2500.0);
  EXPECT_TRUE(holds(wall_shear(m)->caption, "reaches 2500"));
  m.local_reynolds.setZero();  // no flow
  EXPECT_FALSE(wall_shear(m));
}

TEST(FlowFigures, HoldNoTextOfTheFile) {
  Measurement m = example();
  m.flow_model[0] = m.correction[1] = m.passage_term[0] = m.verdict[0] = m.flow_setup = "`evil`";
  m.flow_model[3] = m.verdict_model = "`evil`";
  for (const Figure& figure : figures(m)) {
    EXPECT_FALSE(holds(figure.script + figure.caption, "evil")) << figure.name;
  }
}

TEST(FlowPart, TellsWhichModelAgrees) {
  const Measurement m = example();
  const std::string part = flow_part(m);
  EXPECT_TRUE(holds(part, m.flow_setup));
  EXPECT_TRUE(holds(part, "<span class=\"good\">● agrees</span><br>+0.2 %"));
  EXPECT_TRUE(holds(part, "<span class=\"half\">● only the drop</span><br>+1.0 %"));
  EXPECT_TRUE(holds(part, "<span class=\"bad\">○ differs</span><br>+3.0 %"));  // may be 3 % off
  EXPECT_TRUE(holds(part, "agree within 2 %: the model gives"));
  EXPECT_EQ(verdict_sentence(m),
            "<p>In 3 of 3 runs the flow model section-march agrees with the reading in the "
            "drop and along <i>x</i>.</p>\n");
}

TEST(FlowPart, ShowsCorrectionsInPascalAndPercent) {
  Measurement m = example(1);
  m.extracted_drop(0) = 13172.0;
  m.extracted_drop_uncertainty(0) = 60.0;
  m.correction_drop.col(0) = Array1{{13254.0, -418.0, 851.0, 0.0, -520.0}};
  m.correction_uncertainty.col(0) = Array1{{0.0, 0.0, 0.0, 130.0, 0.0}};
  const std::string part = flow_part(m);
  EXPECT_TRUE(holds(part,
                    "<td>13254<br>+100.6 %</td><td>−418<br>−3.2 %</td><td>851<br>+6.5 %</td>"
                    "<td>0 ± 260<br>0 %</td><td>−520<br>−3.9 %</td><td>13167</td>"
                    "<td>13170 ± 120</td>"))
      << part;
}

TEST(FlowPart, ShowsTheFlowRateFromTheDeflection) {
  Measurement m = example(1);
  m.flow_rate(0) = 70e-6 / 60.0;
  m.flow_rate_uncertainty(0) = 0.0;
  m.inferred_flow_rate(0) = 70.7e-6 / 60.0;
  m.inferred_flow_rate_uncertainty(0) = 0.35e-6 / 60.0;
  m.inferred_viscosity(0) = 0.99e-3;
  m.inferred_viscosity_uncertainty(0) = 0.008e-3;
  const std::string table = inferred_table(m);
  EXPECT_TRUE(holds(table,
                    "<td>70.00</td><td>70.70 ± 0.70</td><td>+1.0 %</td>"
                    "<td><span class=\"good\">1.00</span></td><td>0.40</td>"
                    "<td>0.990 ± 0.016</td>"))
      << table;
}

TEST(FlowPart, ShowsTheDropOfTheChannelByPart) {
  Measurement m = example();
  const std::string table = channel_drops_table(m);
  for (const char* text : {"inlet, duct (kPa)", "inlet, contraction (kPa)", "Predicted (kPa)",
                           "<span class=\"good\">0.60</span>"}) {
    EXPECT_TRUE(holds(table, text)) << text;
  }
  m.predicted_en_number.setConstant(1.4);
  EXPECT_TRUE(holds(channel_drops_table(m), "<span class=\"bad\">1.40</span>"));
  m.passage_term.clear();
  m.passage_drop = m.passage_drop_uncertainty = Array2(0, 3);
  m.parasitic_drop.setConstant(kNan);
  m.compliant_drop.setConstant(kNan);
  EXPECT_FALSE(holds(channel_drops_table(m), "Parasitic"));
  EXPECT_TRUE(holds(channel_drops_table(m), "tells of no rigid passages"));
  EXPECT_TRUE(holds(pressure_drop(m)->caption, "passages included"));
}

TEST(FlowPart, IsEmptyWhereThereIsNothing) {
  EXPECT_EQ(flow_part(Measurement{}), "");
  EXPECT_EQ(flow_part(without_models()), "");
  EXPECT_EQ(flow_part(example(0)), "");
  EXPECT_EQ(verdict_sentence(without_models()), "");
  Measurement m = example();
  m.model_drop.setConstant(kNan);
  m.model_en_number.setConstant(kNan);
  m.correction_drop.setConstant(kNan);
  m.inferred_flow_rate.setConstant(kNan);
  m.inferred_viscosity.setConstant(kNan);
  m.compliant_drop.setConstant(kNan);
  m.predicted_drop.setConstant(kNan);
  m.passage_drop.setConstant(kNan);
  m.verdict.assign(m.run.size(), "");
  EXPECT_EQ(flow_part(m), "");
  EXPECT_EQ(verdict_sentence(m), "");
  m.verdict[0] = "no verdict: there is no test section";
  EXPECT_TRUE(holds(flow_part(m), "no verdict: there is no test section"));
}

TEST(FlowPart, ShowsEveryTextOfTheFileAsText) {
  Measurement m = example();
  m.flow_setup = m.verdict_model = m.flow_model[3] = m.correction[0] = m.passage_term[0] =
      m.verdict[0] = m.run[0] = "<script>";
  EXPECT_FALSE(holds(flow_part(m) + verdict_sentence(m), "<script>"));
}

}  // namespace
}  // namespace manoscope::report
