// What read_experiment says about whole files: many faults at once, files that are not there, and
// files of random damage.
#include <gtest/gtest.h>

#include <cfenv>
#include <random>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/experiment/test_folder.hpp"

namespace manoscope::experiment {
namespace {

namespace fs = std::filesystem;

std::vector<InputError> faults_of(const fs::path& folder_or_file) {
  try {
    read_experiment(folder_or_file);
  } catch (const InputErrors& errors) {
    return errors.faults();
  }
  return {};
}

TEST(ReadExperiment, TellsEveryFaultOfAllFilesTogether) {
  const TestFolder folder;
  write_full_example(folder);
  folder.write("experiment.toml",
               "manoscope = 1\n[channel]\nlength = 15.5\nwidth = \"1.7 kPa\"\nheigth = \"1 um\"\n"
               "flow = \"left\"\n[wall]\npoisson_ratio = 0.7\n[fluid]\ndensity = \"998 kg\"\n"
               "[hydrostatic]\nlist = \"hydrostatic.csv\"\n[flow]\nlist = \"flow.csv\"\n"
               "[inlet]\nprofile = \"turbulent\"\nspread = 2\ndeveloping_length = 2\n"
               "[instrument]\npressure_drop_uncertainty = \"5 um\"\n[rigid]\n"
               "inlet = {length = \"5 mm\", width = \"1.7 mm\", round_bends = -1, "
               "from = \"4 mm\"}\n"
               "simulated = [{flow_rate = 5}, {drop = \"1 Pa\", flow_rate = \"0 mL/min\"}]\n");
  folder.write("hydrostatic.csv",
               "map,pressure [Pa],drift\nh00.gsf,zero,\nh01.gsf\nh77.gsf,100,\nh01.gsf,5,\n");
  folder.write("flow.csv", "map,flow_rate\nf00.gsf,5\nf00.gsf,6\n");
  std::string places;
  for (const InputError& fault : faults_of(folder.path())) {
    places += fs::path(fault.where()).filename().string() + '\n';
  }
  EXPECT_EQ(places,
            "experiment.toml:3: channel.length\n"
            "experiment.toml:4: channel.width\n"
            "experiment.toml:5: channel.heigth\n"
            "experiment.toml:6: channel.flow\n"
            "experiment.toml:8: wall.poisson_ratio\n"
            "experiment.toml:9: fluid.viscosity\n"
            "experiment.toml:10: fluid.density\n"
            "experiment.toml:16: inlet.profile\n"
            "experiment.toml:17: inlet.spread\n"
            "experiment.toml:18: inlet.developing_length\n"
            "experiment.toml:20: instrument.pressure_drop_uncertainty\n"
            "experiment.toml:22: rigid.inlet.from\n"
            "experiment.toml:22: rigid.inlet.round_bends\n"
            "experiment.toml:22: rigid.inlet.height\n"
            "experiment.toml:23: rigid.simulated entry 1: flow_rate\n"
            "experiment.toml:23: rigid.simulated entry 1: drop\n"
            "experiment.toml:23: rigid.simulated entry 2: flow_rate\n"
            "hydrostatic.csv:1: drift\n"
            "hydrostatic.csv:2: pressure\n"
            "hydrostatic.csv:3\n"
            "hydrostatic.csv:4: map\n"
            "flow.csv:1: flow_rate\n"
            "flow.csv:3: map\n");
}

TEST(ReadExperiment, SendsAFolderWithoutExperimentToInit) {
  const TestFolder folder;
  const auto faults = faults_of(folder.path());
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].where(), folder.path().string());
  EXPECT_NE(faults[0].found().find("no experiment.toml"), std::string::npos);
  EXPECT_NE(faults[0].mend().find("manoscope init " + folder.path().string()), std::string::npos);
}

TEST(ReadExperiment, RefusesFilesThatAreNotThereOrEmpty) {
  const TestFolder folder;
  const auto absent = faults_of(folder.path() / "other");
  ASSERT_EQ(absent.size(), 1u);
  EXPECT_NE(absent[0].found().find("no such file"), std::string::npos) << absent[0].what();
  EXPECT_EQ(faults_of("").size(), 1u);
  folder.write("experiment.toml", "");
  const auto empty = faults_of(folder.path());
  ASSERT_EQ(empty.size(), 1u);
  EXPECT_NE(empty[0].found().find("empty"), std::string::npos) << empty[0].what();
  EXPECT_EQ(faults_of("/dev/null").size(), 1u);
}

TEST(ReadExperiment, RefusesMapsThatAreFoldersEmptyOrNotThere) {
  const TestFolder folder;
  write_full_example(folder);
  folder.write("h01.gsf", "");
  fs::remove(folder.path() / "h02.gsf");
  fs::create_directory(folder.path() / "h02.gsf");
  fs::remove(folder.path() / "f00.gsf");
  const auto faults = faults_of(folder.path());
  ASSERT_EQ(faults.size(), 3u);
  EXPECT_NE(faults[0].found().find("the file is empty"), std::string::npos) << faults[0].what();
  EXPECT_NE(faults[1].found().find("it is a folder"), std::string::npos) << faults[1].what();
  EXPECT_NE(faults[2].found().find("no such file"), std::string::npos) << faults[2].what();
}

/// One to four damages: a byte changed, a piece dropped, doubled, or moved elsewhere.
std::string damaged(std::string text, std::mt19937& random) {
  static const std::string kBytes = "0123456789.,;-+eE[]{}=\"'#\n\t ?\\/%napm\xC2\xB5\x00";
  const auto below = [&](std::size_t n) { return random() % (n == 0 ? 1 : n); };
  for (std::size_t n = 1 + below(4); n > 0; --n) {
    const std::size_t at = below(text.size()), length = 1 + below(12);
    const std::string piece = text.substr(at, length);
    switch (below(5)) {
      case 0:
        text.replace(at, 1, 1, kBytes[below(kBytes.size())]);
        break;
      case 1:
        text.replace(at, 1, 1, static_cast<char>(below(256)));
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, piece);
        break;
      default:
        text.insert(below(text.size()), piece);
        break;
    }
  }
  return text;
}

TEST(ReadExperiment, AnswersRandomDamageWithFaultsAndNothingElse) {
  // Damaged units reach arithmetic inside the unit library, which may overflow to infinity there
  // before it is refused: as in the program itself, that does not trap here.
  std::fenv_t environment;
  ASSERT_EQ(feholdexcept(&environment), 0);
  const TestFolder folder;
  write_full_example(folder);
  const std::string names[] = {"experiment.toml", "hydrostatic.csv", "flow.csv"};
  const std::string texts[] = {kFullToml, kFullHydrostatic, kFullFlow};
  std::mt19937 random(1);  // seeded: the same damage on every machine
  int n_refused = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::size_t which = random() % 3;
    const std::string text = damaged(texts[which], random);
    folder.write(names[which], text);
    try {
      read_experiment(folder.path());
    } catch (const InputErrors& errors) {
      ++n_refused;
      EXPECT_FALSE(errors.faults().empty());
      for (const InputError& fault : errors.faults()) {
        EXPECT_FALSE(fault.where().empty() || fault.found().empty() || fault.mend().empty());
      }
    } catch (const std::exception& other) {
      ADD_FAILURE() << "trial " << trial << ": " << other.what() << "\n" << text;
    }
    folder.write(names[which], texts[which]);
  }
  // Some damage falls into comments and free texts; most does not.
  EXPECT_GT(n_refused, 1000);
  EXPECT_LT(n_refused, 2000);
  fesetenv(&environment);
}

}  // namespace
}  // namespace manoscope::experiment
