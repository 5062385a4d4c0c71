#include "manoscope/experiment/draft.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/draft_text.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/experiment/test_folder.hpp"

namespace manoscope::experiment {
namespace {

namespace fs = std::filesystem;

/// A Gwyddion Simple Field of 4 x 2 pixels, 2.0 mm x 0.8 mm: header, NUL padding, 32-bit floats.
std::string tiny_gsf() {
  std::string text =
      "Gwyddion Simple Field 1.0\nXRes = 4\nYRes = 2\nXReal = 0.002\nYReal = 0.0008\n"
      "XYUnits = m\nZUnits = m\n";
  text.append(4 - text.size() % 4, '\0');
  for (int i = 0; i < 8; ++i) {
    const float height = 1e-6f * static_cast<float>(i);
    char bytes[sizeof height];
    std::memcpy(bytes, &height, sizeof height);
    text.append(bytes, sizeof height);
  }
  return text;
}

std::string text_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string without_comments(const std::string& text) {
  std::string kept;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
    if (text[at] != '#') kept += text.substr(at, end - at);
    at = end;
  }
  return kept;
}

void write_maps(const TestFolder& folder, std::initializer_list<const char*> names) {
  for (const char* name : names) folder.write(name, tiny_gsf());
}

TEST(Draft, SortsMapsIntoListsByTheirNames) {
  const TestFolder folder;
  write_maps(folder, {"S1_2.3kPa.gsf", "S1_0Pa.gsf", "S1_0.5mbar_02.gsf", "Q70mlmin_02.gsf",
                      "Q70mlmin_01.gsf", "Q5mlmin_01.gsf", "map.gsf", "1kPa_2kPa.gsf"});
  folder.write("notes.pdf", "%PDF-1.4 nothing to see");
  const Draft draft = draft_experiment(folder.path());
  EXPECT_EQ(draft.written.size(), 3u);
  EXPECT_EQ(without_comments(text_of(folder.path() / "hydrostatic.csv")),
            "map,pressure [Pa],pressure_uncertainty [Pa]\n"
            "S1_0Pa.gsf,0,\nS1_0.5mbar_02.gsf,50,\nS1_2.3kPa.gsf,2300,\n");
  EXPECT_EQ(without_comments(text_of(folder.path() / "flow.csv")),
            "map,flow_rate [mL/min],run\nQ5mlmin_01.gsf,5,Q5\nQ70mlmin_01.gsf,70,Q70\n"
            "Q70mlmin_02.gsf,70,Q70\n");
  EXPECT_EQ(draft.unassigned, (std::vector<std::string>{"1kPa_2kPa.gsf", "map.gsf"}));
  EXPECT_EQ(draft.no_maps, (std::vector<std::string>{"notes.pdf"}));
}

TEST(Draft, MarksEveryGuessForTheUser) {
  const TestFolder folder;
  write_maps(folder, {"a_0Pa.gsf", "a_1kPa.gsf", "Q5mlmin.gsf"});
  draft_experiment(folder.path());
  const std::string rest = text_of(folder.path() / "hydrostatic.csv");
  EXPECT_NE(rest.find("# CONFIRM 1000 Pa, from \"1kPa\" in a_1kPa.gsf\n"), std::string::npos)
      << rest;
  const std::string flow = text_of(folder.path() / "flow.csv");
  EXPECT_NE(flow.find("# CONFIRM 5 mL/min, from \"5mlmin\" in Q5mlmin.gsf\n"), std::string::npos)
      << flow;
  const std::string toml = text_of(folder.path() / "experiment.toml");
  EXPECT_NE(toml.find("# The maps are 2 mm along columns by 0.8 mm along rows, 4 x 2 pixels"),
            std::string::npos)
      << toml;
  EXPECT_NE(toml.find("# CONFIRM: water"), std::string::npos);
}

TEST(Draft, LeavesToTheUserWhatCheckThenAsksFor) {
  const TestFolder folder;
  write_maps(folder, {"h00.gsf", "x_1kPa.gsf", "x_2kPa.gsf", "x_3kPa.gsf", "f00.gsf"});
  draft_experiment(folder.path());
  try {
    read_experiment(folder.path());
    FAIL();
  } catch (const InputErrors& errors) {
    std::string keys;
    for (const InputError& fault : errors.faults()) {
      keys += fault.where().substr(fault.where().rfind(' ') + 1) + ' ';
      EXPECT_NE(fault.found().find("placeholder"), std::string::npos) << fault.what();
    }
    EXPECT_EQ(keys,
              "channel.length channel.width channel.height instrument.pressure_noise pressure "
              "flow_rate ");
  }
}

TEST(Draft, AsksForEachValueWithAnExampleThatFitsTheField) {
  const TestFolder folder;
  write_maps(folder, {"x_1kPa.gsf", "x_2kPa.gsf", "x_3kPa.gsf"});
  draft_experiment(folder.path());
  try {
    read_experiment(folder.path());
    FAIL();
  } catch (const InputErrors& errors) {
    ASSERT_EQ(errors.faults().size(), 4u);
    const char* const kExamples[] = {"like \"15.5 mm\"", "like \"1.7 mm\"", "like \"175 um\"",
                                     "like \"10 Pa\": the standard deviation of one reading"};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NE(errors.faults()[i].mend().find(kExamples[i]), std::string::npos)
          << errors.faults()[i].mend();
    }
    EXPECT_NE(errors.faults()[3].mend().find("\"0 Pa\" claims an exact gauge"), std::string::npos);
  }
}

TEST(Draft, IsAnExperimentOnceItsGapsAreFilled) {
  const TestFolder folder;
  write_maps(folder, {"S1, \"old\" 0Pa.gsf", "#1kPa.gsf", "µ_2kPa.gsf", "Q5mlmin.gsf"});
  draft_experiment(folder.path());
  std::string toml = text_of(folder.path() / "experiment.toml");
  toml = replaced(replaced(toml, "? mm", "15 mm"), "? mm", "1.7 mm");
  toml = replaced(toml, "? Pa", "8 Pa");
  folder.write("experiment.toml", replaced(toml, "? um", "175 um"));
  const Experiment experiment = read_experiment(folder.path());
  ASSERT_EQ(experiment.hydrostatic.size(), 3u);
  EXPECT_EQ(experiment.hydrostatic[0].name, "S1, \"old\" 0Pa.gsf");
  EXPECT_EQ(experiment.hydrostatic[1].name, "#1kPa.gsf");
  EXPECT_EQ(experiment.hydrostatic[2].pressure.si(), 2000.0);
  EXPECT_EQ(experiment.hydrostatic[0].pressure_uncertainty, 8.0 * Pa);
  EXPECT_FALSE(experiment.hydrostatic[0].vented);  // only the user can know
  EXPECT_EQ(experiment.name, folder.path().filename());
}

/// The draft with every optional key taken up: "# key = ..." and "# [section]" without the "# ".
std::string with_optional_keys(const std::string& toml) {
  std::string text;
  for (std::size_t at = 0; at < toml.size();) {
    const std::size_t end = std::min(toml.find('\n', at), toml.size() - 1) + 1;
    const std::string line = toml.substr(at, end - at);
    const std::size_t word = line.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", 2);
    const bool optional = line.starts_with("# [") ||
                          (line.starts_with("# ") && word > 2 && line.compare(word, 3, " = ") == 0);
    text += optional ? line.substr(2) : line;
    at = end;
  }
  return text;
}

TEST(Draft, OffersOptionalKeysAsTheyAreWritten) {
  const TestFolder folder;
  write_maps(folder, {"0Pa.gsf", "1kPa.gsf", "2kPa.gsf", "Q5mlmin.gsf"});
  draft_experiment(folder.path());
  folder.write("flat.gsf", tiny_gsf());
  std::string toml = with_optional_keys(text_of(folder.path() / "experiment.toml"));
  for (const auto& [gap, value] :
       {std::pair{"? mm", "2 mm"}, std::pair{"? um", "175 um"}, std::pair{"? Pa", "8 Pa"}}) {
    while (toml.find(gap) != std::string::npos) toml = replaced(toml, gap, value);
  }
  folder.write("experiment.toml", toml);
  const Experiment experiment = read_experiment(folder.path());
  EXPECT_EQ(experiment.inlet.spread, 0.3);
  EXPECT_EQ(experiment.instrument.pressure_drop_uncertainty, 5.0 * Pa);
  ASSERT_TRUE(experiment.rigid.inlet && experiment.rigid.outlet);
  EXPECT_TRUE(experiment.rigid.inlet->fittings.from_reservoir);
  EXPECT_TRUE(experiment.wall && experiment.channel.origin && experiment.instrument.reference);
}

TEST(Draft, DoesWithoutFlow) {
  const TestFolder folder;
  write_maps(folder, {"0Pa.gsf", "1kPa.gsf", "2kPa.gsf"});
  const Draft draft = draft_experiment(folder.path());
  EXPECT_EQ(draft.written.size(), 2u);
  EXPECT_FALSE(fs::exists(folder.path() / "flow.csv"));
  EXPECT_EQ(text_of(folder.path() / "experiment.toml").find("\n[flow]"), std::string::npos);
}

TEST(Draft, OverwritesNothing) {
  for (const char* name : {"experiment.toml", "hydrostatic.csv", "flow.csv"}) {
    const TestFolder folder;
    write_maps(folder, {"0Pa.gsf"});
    folder.write(name, "mine");
    EXPECT_THROW(draft_experiment(folder.path()), InputError);
    EXPECT_EQ(text_of(folder.path() / name), "mine");
    // The map and the user's own file, nothing else.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
  }
}

TEST(Draft, RefusesAFolderWithoutMaps) {
  const TestFolder folder;
  EXPECT_THROW(draft_experiment(folder.path()), InputError);
  EXPECT_THROW(draft_experiment(folder.path() / "none"), InputError);
  folder.write("0Pa.pdf", "%PDF-1.4");
  EXPECT_THROW(draft_experiment(folder.path()), InputError);
  EXPECT_FALSE(fs::exists(folder.path() / "experiment.toml"));
}

TEST(Draft, DropsNamesThatNoListCanHold) {
  EXPECT_TRUE(can_be_listed("a,b;\"c\" #1.gsf"));
  EXPECT_FALSE(can_be_listed("a\xFF.gsf"));
  EXPECT_FALSE(can_be_listed("two\nlines.gsf"));
  EXPECT_FALSE(can_be_listed(" led by a blank.gsf"));
  EXPECT_TRUE(can_be_a_name("S1 \"new\" \\ µ"));
  EXPECT_FALSE(can_be_a_name("a\xFF"));
}

}  // namespace
}  // namespace manoscope::experiment
