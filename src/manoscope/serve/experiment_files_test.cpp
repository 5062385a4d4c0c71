#include "manoscope/serve/experiment_files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/test_experiment.hpp"

namespace manoscope::serve {
namespace {

namespace fs = std::filesystem;

class ExperimentFilesTest : public testing::Test {
 protected:
  ExperimentFilesTest() : folder(made()) {}

  fs::path made() {
    write_experiment_folder(outer / "served");
    return outer / "served";
  }
  fs::path top() const { return outer / "served"; }
  ExperimentDraft loaded() const { return *load_experiment(folder, "s1/experiment.toml"); }
  /// The status that writing ends with, 200 if it succeeds.
  unsigned write(const std::optional<ExperimentDraft>& old, const ExperimentDraft& draft) {
    try {
      write_experiment(folder, old, draft, own);
    } catch (const ApiError& error) {
      return error.status();
    }
    return 200;
  }
  std::size_t n_files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(top() / "s1"), fs::directory_iterator()));
  }

  test_support::TemporaryFolder outer;
  Folder folder;
  OwnLists own;
};

TEST_F(ExperimentFilesTest, AnEditorThatSavesWhileWeThinkIsNotWrittenOver) {
  // What was read is what the request was held against; since then an editor has saved.
  const ExperimentDraft old = loaded();
  ExperimentDraft draft = old;
  draft.texts.toml += "# ours\n";
  draft.texts.lists["flow.csv"] += "# ours\n";
  const std::size_t n = n_files();
  for (const char* file : {"s1/experiment.toml", "s1/flow.csv"}) {
    const std::string before = read_text(top() / file);
    write_text(top() / file, before + "# an editor's\n");
    EXPECT_EQ(write(old, draft), 412u) << file;
    EXPECT_EQ(read_text(top() / file), before + "# an editor's\n");
    write_text(top() / file, before);
  }
  EXPECT_EQ(n_files(), n) << "nothing is left of what was not written";
  EXPECT_EQ(write(old, draft), 200u);
  EXPECT_EQ(read_text(top() / "s1/experiment.toml"), draft.texts.toml);
  EXPECT_EQ(read_text(top() / "s1/flow.csv"), draft.texts.lists["flow.csv"]);
}

TEST_F(ExperimentFilesTest, ANewExperimentReplacesNoneThatCameMeanwhile) {
  const ExperimentDraft draft{"s1/experiment.toml", {"manoscope = 1\n", {}}};
  EXPECT_EQ(write(std::nullopt, draft), 412u);
  EXPECT_EQ(read_text(top() / "s1/experiment.toml"), kToml);
  // What is there and no file to be read, is there all the same.
  fs::create_directories(top() / "s2/experiment.toml/x");
  EXPECT_EQ(write(std::nullopt, {"s2/experiment.toml", {"manoscope = 1\n", {}}}), 412u);
}

TEST_F(ExperimentFilesTest, FilesKeepTheirPermissionsAndLinksStayLinks) {
  fs::permissions(top() / "s1/experiment.toml", fs::perms::owner_read | fs::perms::owner_write);
  fs::rename(top() / "s1/flow.csv", top() / "shared.csv");
  fs::create_symlink("../shared.csv", top() / "s1/flow.csv");
  const ExperimentDraft old = loaded();
  ExperimentDraft draft = old;
  draft.texts.toml += "# more\n";
  draft.texts.lists["flow.csv"] += "# more\n";
  EXPECT_EQ(write(old, draft), 200u);
  EXPECT_EQ(fs::status(top() / "s1/experiment.toml").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_TRUE(fs::is_symlink(top() / "s1/flow.csv"));
  EXPECT_EQ(read_text(top() / "shared.csv"), std::string(kFlow) + "# more\n");
}

TEST_F(ExperimentFilesTest, ParentsBehindALinkAreWhatTheKernelTakesThemFor) {
  // out/.. is /other, not the folder that `out` lies in: by its letters it looks harmless.
  fs::create_directories(outer / "other/deep");
  write_text(outer / "other/x.csv", "map,flow_rate [mL/min]\nsecret,1\n");
  fs::create_directory_symlink(outer / "other/deep", top() / "s1/out");
  std::string toml = kToml;
  toml.replace(toml.find("flow.csv"), 8, "out/../x.csv");
  EXPECT_EQ(read_lists(folder, "s1/experiment.toml", toml).count("out/../x.csv"), 0u);
  const experiment::Form form =
      experiment::read_form({toml, {{"hydrostatic.csv", "map,pressure [Pa]\nout/../x.csv,0\n"}}});
  const auto faults = names_that_lead_out(folder, {"s1/experiment.toml", {toml, {}}}, form);
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_NE(faults[0].found().find("lies outside"), std::string::npos);
  EXPECT_NE(faults[1].found().find("lies outside"), std::string::npos);
}

TEST_F(ExperimentFilesTest, AListBehindAnInnerLinkIsReadWhereItIsButNotWritten) {
  fs::create_directories(top() / "a/deep");
  write_text(top() / "a/x.csv", kFlow);
  fs::create_directory_symlink("../a/deep", top() / "s1/in");
  std::string toml = kToml;
  toml.replace(toml.find("flow.csv"), 8, "in/../x.csv");
  write_text(top() / "s1/experiment.toml", toml);
  const ExperimentDraft old = loaded();
  EXPECT_EQ(old.texts.lists.at("in/../x.csv"), kFlow);
  ExperimentDraft draft = old;
  draft.texts.lists["in/../x.csv"] += "# more\n";
  EXPECT_THROW(write_experiment(folder, old, draft, own), InputError);
  EXPECT_FALSE(fs::exists(top() / "s1/x.csv"));
}

TEST_F(ExperimentFilesTest, ListsThatAreNotServedAreNotRead) {
  write_text(top() / ".ssh/id_rsa", "secret");
  write_text(top() / ".hidden/list.csv", "secret");
  write_text(top() / ".list.csv", "secret");
  write_text(top() / "key.pem", "secret");
  for (const char* name : {"../.ssh/id_rsa", "../.hidden/list.csv", "../.list.csv", "../key.pem"}) {
    const std::string toml = "manoscope = 1\n[flow]\nlist = \"" + std::string(name) + "\"\n";
    EXPECT_TRUE(read_lists(folder, "s1/experiment.toml", toml).empty()) << name;
    const ExperimentDraft draft{"s1/experiment.toml", {toml, {}}};
    const auto faults = names_that_lead_out(folder, draft, experiment::read_form(draft.texts));
    EXPECT_EQ(faults.size(), 1u) << name;
  }
}

TEST_F(ExperimentFilesTest, AListMadeHereMayBeMadeAgain) {
  // Added, taken out, added again: nobody else has touched the file in between.
  ExperimentDraft old = loaded();
  ExperimentDraft draft = old;
  draft.texts.toml.replace(draft.texts.toml.find("flow.csv"), 8, "new.csv");
  draft.texts.lists["new.csv"] = "map,flow_rate [mL/min]\nf0.gsf,5\n";
  EXPECT_EQ(write(old, draft), 200u);
  const ExperimentDraft with = loaded();
  EXPECT_EQ(write(with, old), 200u);
  draft.texts.lists["new.csv"] = "map,flow_rate [mL/min]\nf0.gsf,6\n";
  EXPECT_EQ(write(loaded(), draft), 200u);
  EXPECT_EQ(write(loaded(), old), 200u);
  write_text(top() / "s1/new.csv", "map,flow_rate [mL/min]\nf0.gsf,7\n");
  EXPECT_EQ(write(loaded(), draft), 409u) << "now it is somebody's";
}

}  // namespace
}  // namespace manoscope::serve
