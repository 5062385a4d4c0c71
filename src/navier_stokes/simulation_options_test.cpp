#include "simulation_options.hpp"

#include <gtest/gtest.h>

#include "flow_mesh.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/core/options.hpp"

namespace manoscope::navier_stokes {
namespace {

std::string fault(const std::string& name, const std::string& value) {
  SimulationOptions options;
  options.height = 175.0 * um;
  options.width = 1.7 * mm;
  options.flow_rate = 5.0 * mL_per_min;
  try {
    set_option(options, name, value, "--" + name);
    options.validate();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SimulationOptions, NameWhatIsOutOfRange) {
  EXPECT_EQ(fault("dim", "3"), "");
  for (const auto& [name, value] : {std::pair{"dim", "4"},
                                    {"order", "1"},
                                    {"cells-along", "2"},
                                    {"cells-up", "-1"},
                                    {"cells-up", "2"},
                                    {"cells-across", "2"},
                                    {"height", "0um"},
                                    {"flow-rate", "-5mL/min"},
                                    {"inlet", "parabolic"},
                                    {"lead-in", "-1mm"},
                                    {"tolerance", "0"},
                                    {"stations", "1"},
                                    {"wall-shape", "round"},
                                    {"wall-shape", "1,-1,"},
                                    {"wall-shape", "1,nan"},
                                    {"wall-shape", ""},
                                    {"width", "1.7"}}) {
    EXPECT_NE(fault(name, value).find(std::string("--") + name), std::string::npos) << name;
  }
}

TEST(SimulationOptions, SaysWhatIsMissing) {
  SimulationOptions options;
  try {
    options.validate();
    FAIL() << "nothing is missing";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--height"), std::string::npos) << error.what();
  }
}

TEST(SimulationOptions, ReadBackAWallShapeToTheLastDigit) {
  SimulationOptions options;
  EXPECT_EQ(wall_shape_of(options).coefficients(), flow::WallShape::parabola().coefficients());
  EXPECT_TRUE(leaves_wall_shape(options));
  const flow::WallShape shape({1.0, -1.9, 0.7, 0.2});
  options.wall_shape = wall_shape_text(shape);
  const flow::WallShape again = wall_shape_of(options);
  for (const double s : {0.0, 0.3, 0.9}) EXPECT_NEAR(again.value(s), shape.value(s), 1e-14);
}

TEST(SimulationOptions, LeaveSizesToAnExperiment) {
  SimulationOptions options;
  options.validate_solution();
  options.inlet = "slanted";
  EXPECT_THROW(options.validate_solution(), InputError);
}

TEST(FlowMesh, EndsOfTheChannelAreEndsOfCells) {
  const std::vector<double> edges = edges_along(15.5, 1.75, 3.0, 40);
  EXPECT_DOUBLE_EQ(edges.front(), -1.75);
  EXPECT_DOUBLE_EQ(edges.back(), 18.5);
  EXPECT_EQ(std::count(edges.begin(), edges.end(), 0.0), 1);
  EXPECT_EQ(std::count(edges.begin(), edges.end(), 15.5), 1);
  for (std::size_t i = 1; i < edges.size(); ++i) EXPECT_GT(edges[i], edges[i - 1]);
  // Neighbouring cells differ by a growth of 24/40 at most in the ducts.
  EXPECT_LT((edges[1] - edges[0]) / (edges[2] - edges[1]), 1.7);
}

}  // namespace
}  // namespace manoscope::navier_stokes
