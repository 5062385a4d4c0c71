#include "manoscope/experiment/experiment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/test_folder.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::experiment {
namespace {

namespace fs = std::filesystem;

/// Round-off of one unit conversion.
void expect_si(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-14 * std::abs(expected));
}

TEST(ReadExperiment, UnderstandsEveryKeyOfTheManual) {
  const TestFolder folder;
  write_full_example(folder);
  const Experiment e = read_experiment(folder.path());
  EXPECT_EQ(e.file, folder.path() / "experiment.toml");
  EXPECT_EQ(e.text, kFullToml);
  EXPECT_EQ(e.name, "S1");
  expect_si(e.channel.length.si(), 15.5e-3);
  expect_si(e.channel.width.si(), 1.7e-3);
  expect_si(e.channel.height.si(), 175e-6);
  expect_si(e.channel.height_uncertainty->si(), 0.5e-6);
  expect_si((*e.channel.origin)[1].si(), 0.4e-3);
  EXPECT_EQ(e.channel.flow, FlowDirection::plus_columns);
  expect_si(e.channel.rotation->si(), std::numbers::pi / 360);
  EXPECT_EQ(e.channel.outward, Outward::minus_height);
  ASSERT_TRUE(e.wall);
  EXPECT_EQ(e.wall->material, "SiN");
  expect_si(e.wall->thickness->si(), 0.2e-6);
  expect_si(e.wall->youngs_modulus->si(), 250e9);
  EXPECT_EQ(e.wall->poisson_ratio, 0.23);
  expect_si(e.wall->prestress->si(), 100e6);
  EXPECT_EQ(e.fluid.name, "water");
  expect_si(e.fluid.viscosity.si(), 1e-3);
  expect_si(e.fluid.viscosity_uncertainty->si(), 5e-6);
  expect_si(e.fluid.density.si(), 998.0);
  EXPECT_EQ(e.instrument.flow_rate_uncertainty, 0.01);
  expect_si(e.instrument.height_noise->si(), 20e-9);
  expect_si(e.instrument.pressure_noise->si(), 10.0);
  EXPECT_EQ(e.instrument.pressure_gain_uncertainty, 0.002);
  expect_si(e.instrument.pressure_zero_uncertainty->si(), 5.0);
  EXPECT_EQ(e.instrument.reference, folder.path() / "flat.gsf");
  expect_si(e.instrument.pressure_drop_uncertainty->si(), 4.0);
  EXPECT_EQ(e.inlet.profile, flow::InletProfile::uniform);
  EXPECT_EQ(e.inlet.spread, 0.3);
  expect_si(e.inlet.developing_length.si(), 2e-3);
  expect_si(e.rigid.inlet->length.si(), 5e-3);
  expect_si(e.rigid.outlet->length.si(), 6e-3);
  EXPECT_EQ(e.rigid.inlet->height_uncertainty, std::nullopt);
  expect_si(e.rigid.outlet->height_uncertainty->si(), 0.6e-6);
  const flow::PassageFittings& in = e.rigid.inlet->fittings;
  EXPECT_EQ(in.from, std::nullopt);
  EXPECT_TRUE(in.from_reservoir);
  expect_si(in.into->si(), 0.3e-6);
  EXPECT_FALSE(in.into_reservoir);
  EXPECT_EQ(in.round_bends, 2);
  EXPECT_EQ(in.mitre_bends, 0);
  const flow::PassageFittings& out = e.rigid.outlet->fittings;
  expect_si(out.from->si(), 1e-6);
  EXPECT_FALSE(out.from_reservoir);
  EXPECT_EQ(out.into, std::nullopt);
  EXPECT_TRUE(out.into_reservoir);
  EXPECT_EQ(out.round_bends, 0);
  EXPECT_EQ(out.mitre_bends, 1);
  ASSERT_EQ(e.rigid.simulated.size(), 2u);
  expect_si(e.rigid.simulated[0].flow_rate.si(), 20e-6 / 60);
  expect_si(e.rigid.simulated[0].drop.si(), 310.0);
  expect_si(e.rigid.simulated[0].uncertainty.si(), 10.0);
  expect_si(e.rigid.simulated[1].drop.si(), 1400.0);
  EXPECT_EQ(e.rigid.simulated[1].uncertainty, Pressure{});
}

TEST(ReadExperiment, UnderstandsEveryColumnOfTheManual) {
  const TestFolder folder;
  write_full_example(folder);
  const Experiment e = read_experiment(folder.path() / "experiment.toml");
  ASSERT_EQ(e.hydrostatic.size(), 4u);
  const HydrostaticMap& first = e.hydrostatic[0];
  EXPECT_EQ(first.map, folder.path() / "h00.gsf");
  EXPECT_EQ(first.name, "h00.gsf");
  EXPECT_EQ(first.pressure_uncertainty, Pressure{});
  EXPECT_TRUE(first.vented);
  EXPECT_EQ(first.sequence, 0);
  EXPECT_EQ(first.direction, SweepDirection::up);
  EXPECT_EQ(first.line, 2);
  expect_si(e.hydrostatic[1].pressure_uncertainty->si(), 10.0);  // instrument.pressure_noise
  EXPECT_FALSE(e.hydrostatic[1].vented);
  EXPECT_EQ(e.hydrostatic[2].direction, SweepDirection::unknown);
  EXPECT_EQ(e.hydrostatic[3].direction, SweepDirection::down);
  ASSERT_EQ(e.flow.size(), 3u);
  expect_si(e.flow[1].flow_rate.si(), 5e-6 / 60);
  expect_si(e.flow[1].pressure_drop->si(), 1424.0);
  expect_si(e.flow[0].pressure_drop_uncertainty->si(), 3.0);
  expect_si(e.flow[1].pressure_drop_uncertainty->si(), 4.0);  // of the instrument
  expect_si(e.flow[1].outlet_pressure->si(), 30.0);
  expect_si(e.flow[1].time->si(), 1.5);
  EXPECT_EQ(e.flow[1].run, "Q5");
  EXPECT_EQ(e.flow[2].run, "f02");
  EXPECT_EQ(e.flow[2].pressure_drop, std::nullopt);
  EXPECT_EQ(e.flow[2].outlet_pressure, std::nullopt);
  EXPECT_EQ(e.flow[2].line, 4);
}

TEST(ReadExperiment, NeedsOnlyWhatTheMeasurementNeeds) {
  const TestFolder folder;
  write_full_example(folder);
  folder.write("experiment.toml",
               "manoscope = 1\n[channel]\nlength = \"15.5 mm\"\nwidth = \"1.7mm\"\n"
               "height = \"175 µm\"\n[fluid]\nviscosity = \"1 cP\"\ndensity = \"0.998 g/cm3\"\n"
               "[hydrostatic]\nlist = \"hydrostatic.csv\"\n");
  folder.write("hydrostatic.csv", "pressure [mbar],map\n0,h00.gsf\n1,h01.gsf\n25,h02.gsf\n");
  const Experiment e = read_experiment(folder.path());
  EXPECT_EQ(e.name, folder.path().filename());
  expect_si(e.channel.height.si(), 175e-6);
  expect_si(e.fluid.density.si(), 998.0);
  expect_si(e.hydrostatic[2].pressure.si(), 2500.0);
  // No uncertainty of the row, none of the instrument: unknown, which is not the same as 0.
  EXPECT_EQ(e.hydrostatic[0].pressure_uncertainty, std::nullopt);
  EXPECT_EQ(e.hydrostatic[2].pressure_uncertainty, std::nullopt);
  EXPECT_FALSE(e.hydrostatic[0].vented);
  EXPECT_EQ(e.fluid.viscosity_uncertainty, std::nullopt);
  EXPECT_EQ(e.instrument.flow_rate_uncertainty, std::nullopt);
  EXPECT_EQ(e.channel.origin, std::nullopt);
  EXPECT_FALSE(e.wall);
  EXPECT_TRUE(e.flow.empty());
  EXPECT_EQ(e.inlet.profile, flow::InletProfile::developed);
  EXPECT_EQ(e.inlet.spread, std::nullopt);  // not known, which is not the same as 0
  EXPECT_EQ(e.inlet.developing_length, Length{});
  EXPECT_FALSE(e.rigid.inlet);
  EXPECT_TRUE(e.rigid.simulated.empty());
  EXPECT_EQ(e.instrument.pressure_drop_uncertainty, std::nullopt);
}

TEST(ReadExperiment, TakesAMapForVentedOnlyWhereTheListSaysZeroTwice) {
  const TestFolder folder;
  write_full_example(folder);
  struct Given {
    const char *row, *noise;
    std::optional<double> uncertainty;  // Pa
    bool vented;
  };
  for (const Given& given :
       {Given{"0,0", "pressure_noise = \"10 Pa\"", 0.0, true}, Given{"0,0", "", 0.0, true},
        Given{"0,", "pressure_noise = \"10 Pa\"", 10.0, false},
        Given{"0,", "pressure_noise = \"0 Pa\"", 0.0, false}, Given{"0,", "", std::nullopt, false},
        Given{"0,3", "pressure_noise = \"10 Pa\"", 3.0, false},
        Given{"50,0", "pressure_noise = \"10 Pa\"", 0.0, false}}) {
    folder.write("experiment.toml", replaced(kFullToml, "pressure_noise = \"10 Pa\"", given.noise));
    folder.write("hydrostatic.csv", std::string("map,pressure [Pa],pressure_uncertainty [Pa]\n") +
                                        "h00.gsf," + given.row +
                                        "\nh01.gsf,100,10\nh02.gsf,2500,10\n");
    const HydrostaticMap map = read_experiment(folder.path()).hydrostatic[0];
    EXPECT_EQ(map.vented, given.vented) << given.row << " with " << given.noise;
    ASSERT_EQ(map.pressure_uncertainty.has_value(), given.uncertainty.has_value()) << given.row;
    if (given.uncertainty) expect_si(map.pressure_uncertainty->si(), *given.uncertainty);
  }
}

TEST(ReadExperiment, TakesListsInlineAsWell) {
  const TestFolder folder;
  write_full_example(folder);
  std::string toml = replaced(kFullToml, "list = \"hydrostatic.csv\"",
                              "maps = [\n"
                              "  {map = \"h00.gsf\", pressure = \"0 Pa\", pressure_uncertainty = "
                              "\"0 Pa\", sequence = 0, direction = \"up\"},\n"
                              "  {map = \"h01.gsf\", pressure = \"1 mbar\"},\n"
                              "  {map = \"h02.gsf\", pressure = \"2.5 kPa\"}]");
  toml = replaced(toml, "list = \"flow.csv\"",
                  "maps = [{map = \"f00.gsf\", flow_rate = \"5 mL/min\", run = \"Q5\", "
                  "pressure_drop = \"1.42 kPa\", time = \"2 min\", "
                  "pressure_drop_uncertainty = \"0.2 mbar\"}]");
  folder.write("experiment.toml", toml);
  const Experiment e = read_experiment(folder.path());
  ASSERT_EQ(e.hydrostatic.size(), 3u);
  EXPECT_EQ(e.hydrostatic[0].pressure_uncertainty, Pressure{});
  EXPECT_TRUE(e.hydrostatic[0].vented);
  expect_si(e.hydrostatic[1].pressure.si(), 100.0);
  expect_si(e.hydrostatic[1].pressure_uncertainty->si(), 10.0);
  EXPECT_EQ(e.hydrostatic[2].line, 40);
  ASSERT_EQ(e.flow.size(), 1u);
  expect_si(e.flow[0].pressure_drop->si(), 1420.0);
  expect_si(e.flow[0].pressure_drop_uncertainty->si(), 20.0);
  expect_si(e.flow[0].time->si(), 120.0);
}

TEST(ReadExperiment, KnowsNoUncertaintyOfADropThatNeitherListNorInstrumentGives) {
  const TestFolder folder;
  write_full_example(folder);
  folder.write("experiment.toml",
               replaced(kFullToml, "pressure_drop_uncertainty = \"4 Pa\"\n", ""));
  const Experiment e = read_experiment(folder.path());
  expect_si(e.flow[0].pressure_drop_uncertainty->si(), 3.0);
  EXPECT_EQ(e.flow[1].pressure_drop_uncertainty, std::nullopt);
}

TEST(ReadExperiment, TakesASpreadOfNothingAndOfTheWholeWay) {
  const TestFolder folder;
  write_full_example(folder);
  for (const auto& [text, spread] : {std::pair{"spread = 0", 0.0}, std::pair{"spread = 1", 1.0}}) {
    folder.write("experiment.toml", replaced(kFullToml, "spread = 0.3", text));
    EXPECT_EQ(read_experiment(folder.path()).inlet.spread, spread);
  }
}

TEST(ReadExperiment, TakesTheTablesThatSpreadsheetsWrite) {
  const TestFolder folder;
  write_full_example(folder);
  folder.write("hydrostatic.csv",
               "\xEF\xBB\xBFmap;pressure [kPa];repeat;\r\nh00.gsf;0;1;\r\nh01.gsf;0,1;1;\r\n"
               "h03.gsf;0,1;2;\r\nh02.gsf;2,5;1;\r\n;;;\r\n");
  const Experiment e = read_experiment(folder.path());
  ASSERT_EQ(e.hydrostatic.size(), 4u);
  expect_si(e.hydrostatic[1].pressure.si(), 100.0);
  expect_si(e.hydrostatic[3].pressure.si(), 2500.0);
}

TEST(ReadExperiment, TakesWindowsTextsToo) {
  const TestFolder folder;
  write_full_example(folder);
  std::string toml = "\xEF\xBB\xBF";
  for (const char* at = kFullToml; *at != '\0'; ++at)
    toml += *at == '\n' ? "\r\n" : std::string(1, *at);
  folder.write("experiment.toml", toml);
  EXPECT_EQ(read_experiment(folder.path()).channel.outward, Outward::minus_height);
}

TEST(ReadExperiment, PathsAreRelativeToTheExperimentElseToTheList) {
  const TestFolder folder;
  write_full_example(folder);
  folder.write("experiment.toml", replaced(kFullToml, "hydrostatic.csv", "rest/list.csv"));
  folder.write("rest/list.csv", "map,pressure [Pa]\nh00.gsf,0\nrest/h01.gsf,100\nh09.gsf,300\n");
  folder.write("rest/h00.gsf", "another map");
  folder.write("rest/h01.gsf", "a map");
  folder.write("rest/h09.gsf", "a map");
  const Experiment e = read_experiment(folder.path());
  EXPECT_EQ(e.hydrostatic[0].map, folder.path() / "h00.gsf");
  EXPECT_EQ(e.hydrostatic[1].map, folder.path() / "rest/h01.gsf");
  EXPECT_EQ(e.hydrostatic[2].map, folder.path() / "rest/h09.gsf");
}

TEST(ReadExperiment, ReadsThePracticeExperiments) {
  for (const auto& [name, first_flow_rate] : {std::pair{"S1", 5.0}, std::pair{"S4", 12.0}}) {
    const fs::path folder = fs::path(test_paths::shared) / "data/practice" / name;
    if (!fs::exists(folder)) GTEST_SKIP() << "no practice experiments at " << folder;
    const Experiment e = read_experiment(folder);
    EXPECT_EQ(e.name, name);
    EXPECT_EQ(e.hydrostatic.size(), 25u);
    EXPECT_EQ(e.flow.size(), 8u);
    EXPECT_TRUE(e.hydrostatic[0].vented);
    expect_si(e.hydrostatic[24].pressure_uncertainty->si(), 10.0);
    expect_si(e.flow[0].flow_rate.si(), first_flow_rate * 1e-6 / 60);
    EXPECT_GT(e.flow[7].pressure_drop->si(), e.flow[0].pressure_drop->si());
  }
}

}  // namespace
}  // namespace manoscope::experiment
