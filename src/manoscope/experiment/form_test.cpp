#include "manoscope/experiment/form.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/experiment/test_folder.hpp"

namespace manoscope::experiment {
namespace {

ExperimentTexts full_texts() {
  return {kFullToml, {{"hydrostatic.csv", kFullHydrostatic}, {"flow.csv", kFullFlow}}};
}

TEST(Form, ShowsEveryKeyOfTheFullExample) {
  const Form form = read_form(full_texts());
  EXPECT_EQ(form.values.at("channel.length"), std::vector<std::string>{"15.5 mm"});
  EXPECT_EQ(form.values.at("channel.origin"), (std::vector<std::string>{"0.4 mm", "0.4 mm"}));
  EXPECT_EQ(form.values.at("instrument.flow_rate_uncertainty"), std::vector<std::string>{"0.01"});
  EXPECT_EQ(form.values.at("name"), std::vector<std::string>{"S1"});
  ASSERT_TRUE(form.hydrostatic && form.flow);
  EXPECT_EQ(form.hydrostatic->rows.size(), 4u);
  EXPECT_EQ(form.flow->columns[1], "flow_rate [mL/min]");
  // Of the keys that a form shows the example leaves out these alone.
  for (const FormKey& key : form_keys()) {
    const bool left_out =
        key.name() == "instrument.wavelength" || key.name() == "instrument.pixel_pitch" ||
        key.name() == "instrument.height_unit" || key.name() == "instrument.channel";
    EXPECT_EQ(form.values.count(key.name()), left_out ? 0u : 1u) << key.name();
  }
}

TEST(Form, LeavesTheTextsAsTheyAreWhereNothingDiffers) {
  const ExperimentTexts texts = full_texts();
  EXPECT_EQ(apply_form(texts, read_form(texts)), texts);
}

TEST(Form, WritesWhatDiffersInItsPlace) {
  Form form = read_form(full_texts());
  form.values["channel.length"] = {"16 mm"};
  form.values["inlet.spread"] = {"0.5"};
  form.values["channel.origin"] = {"1 mm", "2 mm"};
  form.values.erase("wall.material");
  form.values["instrument.wavelength"] = {"550 nm"};
  form.hydrostatic->rows[3][1] = "200";
  const ExperimentTexts changed = apply_form(full_texts(), form);
  std::string wanted = replaced(kFullToml, "\"15.5 mm\"", "\"16 mm\"");
  wanted = replaced(wanted, "spread = 0.3", "spread = 0.5");
  wanted = replaced(wanted, "[\"0.4 mm\", \"0.4 mm\"]", "[\"1 mm\", \"2 mm\"]");
  wanted = replaced(wanted, "material = \"SiN\"\n", "");
  wanted = replaced(wanted, "reference = \"flat.gsf\"\n",
                    "reference = \"flat.gsf\"\nwavelength = \"550 nm\"\n");
  EXPECT_EQ(changed.toml, wanted);
  EXPECT_EQ(changed.lists.at("hydrostatic.csv"),
            replaced(kFullHydrostatic, "h03.gsf,100", "h03.gsf,200"));
  EXPECT_EQ(changed.lists.at("flow.csv"), kFullFlow);
}

TEST(Form, WritesNumbersBareAndWhatIsNoneAsAText) {
  Form form = read_form(full_texts());
  form.values["inlet.spread"] = {"a third"};
  form.values["wall.poisson_ratio"] = {"0.3\n[evil]"};
  const ExperimentTexts changed = apply_form(full_texts(), form);
  EXPECT_NE(changed.toml.find("spread = \"a third\""), std::string::npos);
  EXPECT_NE(changed.toml.find("poisson_ratio = \"0.3\\u000A[evil]\""), std::string::npos);
}

TEST(Form, MakesSectionsAndListsThatWereNotThere) {
  Form form;
  form.values["channel.length"] = {"1 mm"};
  form.flow = FormList{"flow.csv", {"map", "flow_rate [mL/min]"}, {{"f.gsf", "5"}}, {}, ""};
  const ExperimentTexts made = apply_form({"manoscope = 1\n", {}}, form);
  EXPECT_EQ(made.toml,
            "manoscope = 1\n\n[channel]\nlength = \"1 mm\"\n\n[flow]\nlist = \"flow.csv\"\n");
  EXPECT_EQ(made.lists.at("flow.csv"), "map,flow_rate [mL/min]\nf.gsf,5\n");
  form.flow.reset();
  EXPECT_EQ(apply_form(made, form).toml, "manoscope = 1\n\n[channel]\nlength = \"1 mm\"\n\n");
}

TEST(Form, EditsInlineLists) {
  const ExperimentTexts texts{
      "[hydrostatic]\nmaps = [{map = \"a\", pressure = \"0 Pa\"}, {map = \"b\", sequence = 2}]\n",
      {}};
  Form form = read_form(texts);
  ASSERT_TRUE(form.hydrostatic);
  EXPECT_EQ(form.hydrostatic->columns, (std::vector<std::string>{"map", "pressure", "sequence"}));
  EXPECT_EQ(form.hydrostatic->rows[1], (std::vector<std::string>{"b", "", "2"}));
  form.hydrostatic->rows[1][1] = "5 Pa";
  EXPECT_EQ(apply_form(texts, form).toml,
            "[hydrostatic]\nmaps = [\n  {map = \"a\", pressure = \"0 Pa\"},\n"
            "  {map = \"b\", pressure = \"5 Pa\", sequence = 2},\n]\n");
}

TEST(Form, DoesNotTouchAValueOfAnotherShape) {
  const ExperimentTexts texts{"[channel]\norigin = \"here\"\nlength = [1]\n", {}};
  const Form form = read_form(texts);
  EXPECT_TRUE(form.values.empty());
  EXPECT_EQ(apply_form(texts, form), texts);
}

TEST(AttemptExperiment, ReadsADraftThatIsNotWritten) {
  const TestFolder folder;
  write_full_example(folder);
  const auto file = folder.path() / "experiment.toml";
  FileTexts draft{{file, replaced(kFullToml, "height = \"175 um\"", "height = \"? um\"")},
                  {folder.path() / "hydrostatic.csv",
                   replaced(kFullHydrostatic, "h02.gsf,2500", "h02.gsf,2600")}};
  const ExperimentAttempt attempt = attempt_experiment(file, draft);
  ASSERT_EQ(attempt.faults.size(), 1u);
  EXPECT_NE(attempt.faults[0].where().find("experiment.toml:7: channel.height"), std::string::npos)
      << attempt.faults[0].where();
  EXPECT_DOUBLE_EQ(attempt.experiment.channel.length.si(), 15.5e-3);
  ASSERT_EQ(attempt.experiment.hydrostatic.size(), 4u);
  EXPECT_DOUBLE_EQ(attempt.experiment.hydrostatic[2].pressure.si(), 2600.0);
}

TEST(AttemptExperiment, ReadsAListThatIsOnNoDiskYet) {
  const TestFolder folder;
  write_full_example(folder);
  std::filesystem::remove(folder.path() / "flow.csv");
  const auto file = folder.path() / "experiment.toml";
  EXPECT_EQ(attempt_experiment(file).faults.size(), 1u);
  const ExperimentAttempt attempt =
      attempt_experiment(file, {{folder.path() / "flow.csv", kFullFlow}});
  EXPECT_TRUE(attempt.faults.empty());
  EXPECT_EQ(attempt.experiment.flow.size(), 3u);
}

}  // namespace
}  // namespace manoscope::experiment
