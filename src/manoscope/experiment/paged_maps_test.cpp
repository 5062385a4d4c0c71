// Maps that are pages of one file: FILE#n in the lists of an experiment.
#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/experiment/test_folder.hpp"

namespace manoscope::experiment {
namespace {

TEST(PagedMaps, AreFoundByTheirFileAndKeepTheirNumber) {
  const TestFolder folder;
  write_full_example(folder);
  folder.write("flow.csv", "map,flow_rate [mL/min]\nf00.gsf#1,5\nf00.gsf#2,10\nf01.gsf,20\n");
  const Experiment experiment = read_experiment(folder.path());
  ASSERT_EQ(experiment.flow.size(), 3U);
  EXPECT_EQ(experiment.flow[1].map, folder.path() / "f00.gsf#2");
  EXPECT_EQ(experiment.flow[1].name, "f00.gsf#2");
  // Without a column `run` each page is a run of its own, as each file is.
  EXPECT_EQ(experiment.flow[0].run, "f00#1");
  EXPECT_EQ(experiment.flow[1].run, "f00#2");
  EXPECT_EQ(experiment.flow[2].run, "f01");
}

TEST(PagedMaps, OfAFileThatIsNotThereAreAFaultOfTheList) {
  const TestFolder folder;
  write_full_example(folder);
  folder.write("flow.csv", "map,flow_rate [mL/min]\nabsent.tif#3,5\n");
  try {
    read_experiment(folder.path());
    ADD_FAILURE() << "no fault was found";
  } catch (const InputErrors& errors) {
    ASSERT_EQ(errors.faults().size(), 1U);
    EXPECT_NE(errors.faults()[0].found().find("\"absent.tif#3\": there is no such file"),
              std::string::npos);
  }
}

TEST(PagedMaps, NamedTwiceAtOnePressureAreAFaultAndTwoPagesAreNot) {
  const TestFolder folder;
  write_full_example(folder);
  const auto list = [&](const char* second) {
    folder.write("hydrostatic.csv", std::string("map,pressure [Pa]\nh00.gsf#1,0\n") + second +
                                        ",100\nh02.gsf,200\nh03.gsf,300\n");
  };
  list("h00.gsf#2");
  EXPECT_NO_THROW(read_experiment(folder.path()));
  list("h00.gsf#1");
  EXPECT_THROW(read_experiment(folder.path()), InputErrors);
}

}  // namespace
}  // namespace manoscope::experiment
