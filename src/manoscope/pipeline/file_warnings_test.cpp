#include "manoscope/pipeline/file_warnings.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "manoscope/io/writer.hpp"
#include "manoscope/pipeline/test_experiment.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::pipeline {
namespace {

/// Makes the file a .x3p (under the name it has: the bytes tell the format) whose checksum is of
/// other bytes, which the standard has no reader refuse.
void spoil_checksum(const std::filesystem::path& path) {
  std::filesystem::path x3p = path;
  x3p += ".x3p";
  io::write_x3p(x3p, io::read_height_map(path));
  std::filesystem::path script = path;
  script += ".py";
  std::ofstream(script) << "import sys, zipfile\n"
                           "with zipfile.ZipFile(sys.argv[1]) as old, "
                           "zipfile.ZipFile(sys.argv[2], 'w') as new:\n"
                           "    for name in old.namelist():\n"
                           "        data = old.read(name)\n"
                           "        if name == 'md5checksum.hex':\n"
                           "            data = b'0' * 32 + data[32:]\n"
                           "        new.writestr(name, data)\n";
  const std::string command = std::string(test_paths::python) + " " + script.string() + " " +
                              x3p.string() + " " + path.string();
  ASSERT_EQ(std::system(command.c_str()), 0);
}

TEST(FileWarnings, AreToldOnceWithTheNumberOfMapsTheyHoldFor) {
  experiment::Experiment experiment;
  experiment.hydrostatic.resize(2);
  experiment.hydrostatic[0].name = "h0.gsf";
  experiment.hydrostatic[1].name = "h1.gsf";
  experiment.flow.resize(1);
  experiment.flow[0].name = "f0.gsf";
  EXPECT_TRUE(file_warnings(experiment, {{}, {}, {}}).empty());
  EXPECT_EQ(file_warnings(experiment, {{"a"}, {"a", "b"}, {"a"}}),
            (std::vector<std::string>{"h0.gsf and 2 other maps: a", "h1.gsf: b"}));
  EXPECT_EQ(file_warnings(experiment, {{}, {"a"}, {"a"}}),
            (std::vector<std::string>{"h1.gsf and 1 other map: a"}));
}

TEST(FileWarnings, ReachTheResultAndTheCheck) {
  TestExperiment test;
  const experiment::Experiment experiment = test.read();
  EXPECT_TRUE(check_maps(experiment).warnings.empty());
  const std::string name = experiment.hydrostatic[2].name;
  spoil_checksum(experiment.hydrostatic[2].map);
  const MapCheck check = check_maps(experiment, 2);
  EXPECT_TRUE(check.faults.empty());
  ASSERT_EQ(check.warnings.size(), 1U);
  EXPECT_TRUE(check.warnings[0].starts_with(name + ": the MD5 checksum of main.xml is "));
  const auto measured = measure(experiment, {}, 2);
  EXPECT_TRUE(warns_of(measured, check.warnings[0])) << all_warnings(measured);
}

TEST(CheckMaps, TellsEveryMapThatCannotBeRead) {
  TestExperiment test;
  const experiment::Experiment experiment = test.read();
  EXPECT_TRUE(check_maps(experiment).faults.empty());
  const auto& first = experiment.hydrostatic[1].map;
  const auto& second = experiment.flow[0].map;
  for (const auto& path : {first, second}) std::filesystem::resize_file(path, 100);
  const MapCheck check = check_maps(experiment, 2);
  ASSERT_EQ(check.faults.size(), 2U);
  EXPECT_EQ(check.faults[0].where(), first.string());
  EXPECT_EQ(check.faults[1].where(), second.string());
}

}  // namespace
}  // namespace manoscope::pipeline
