// The same experiment as other mounts, cameras and instruments would have seen it: the pressure
// that is read must not depend on any of it by more than the error bars say.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>

#include "manoscope/core/provenance.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/writer.hpp"
#include "manoscope/pipeline/judge.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope {
namespace {

namespace fs = std::filesystem;

/// Pa. As for the unchanged experiments: what labels of 10 Pa and maps leave.
constexpr double kMostRms = 10.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Heights of a map, NaN where bad.
struct Picture {
  CameraGrid grid;
  Array2 height;
};

Picture picture_of(const HeightMap& map) {
  Picture picture{map.grid(), map.height()};
  for (Index i = 0; i < picture.height.size(); ++i) {
    if (map.flags().data()[i] != 0) picture.height.data()[i] = kNan;
  }
  return picture;
}

/// Catmull-Rom weights of four samples about a place t in [0, 1] between the middle two.
std::array<double, 4> cubic(double t) {
  return {((2.0 - t) * t - 1.0) * t / 2.0, ((3.0 * t - 5.0) * t * t + 2.0) / 2.0,
          ((4.0 - 3.0 * t) * t + 1.0) * t / 2.0, (t - 1.0) * t * t / 2.0};
}

/// Bad pixels filled with the mean of the good ones around, so that a few of them do not take
/// sixteen times as many with them when the picture is resampled.
Array2 filled(const Array2& height) {
  Array2 result = height;
  for (Index iy = 0; iy < height.rows(); ++iy) {
    for (Index ix = 0; ix < height.cols(); ++ix) {
      if (!std::isnan(height(iy, ix))) continue;
      double sum = 0.0, n = 0.0;
      for (Index jy = std::max<Index>(0, iy - 2); jy < std::min(height.rows(), iy + 3); ++jy) {
        for (Index jx = std::max<Index>(0, ix - 2); jx < std::min(height.cols(), ix + 3); ++jx) {
          if (std::isnan(height(jy, jx))) continue;
          sum += height(jy, jx);
          n += 1.0;
        }
      }
      if (n > 0.0) result(iy, ix) = sum / n;
    }
  }
  return result;
}

/// The picture moved by (columns, rows) pixels and turned about its middle; NaN beyond its edge.
Picture moved(const Picture& from, double columns, double rows, double angle) {
  Picture to = from;
  const Array2 whole = filled(from.height);
  const double ratio = from.grid.pitch_y / from.grid.pitch_x;
  const double mid_x = 0.5 * static_cast<double>(from.grid.nx - 1);
  const double mid_y = 0.5 * static_cast<double>(from.grid.ny - 1);
  const double c = std::cos(angle), s = std::sin(angle);
  for (Index iy = 0; iy < from.grid.ny; ++iy) {
    for (Index ix = 0; ix < from.grid.nx; ++ix) {
      const double u = static_cast<double>(ix) - mid_x - columns;
      const double v = (static_cast<double>(iy) - mid_y - rows) * ratio;
      const double x = mid_x + c * u + s * v, y = mid_y + (-s * u + c * v) / ratio;
      const auto jx = static_cast<Index>(std::floor(x)), jy = static_cast<Index>(std::floor(y));
      double& height = to.height(iy, ix);
      height = kNan;
      if (jx < 1 || jy < 1 || jx + 2 >= from.grid.nx || jy + 2 >= from.grid.ny) continue;
      const auto wx = cubic(x - static_cast<double>(jx)), wy = cubic(y - static_cast<double>(jy));
      if (std::isnan(
              from.height(static_cast<Index>(std::round(y)), static_cast<Index>(std::round(x))))) {
        continue;
      }
      height = 0.0;
      for (Index k = 0; k < 4; ++k) {
        for (Index l = 0; l < 4; ++l) {
          height += wy[static_cast<std::size_t>(k)] * wx[static_cast<std::size_t>(l)] *
                    whole(jy - 1 + k, jx - 1 + l);
        }
      }
    }
  }
  return to;
}

Picture transposed(const Picture& from) {
  return {{from.grid.ny, from.grid.nx, from.grid.pitch_y, from.grid.pitch_x},
          from.height.transpose()};
}

Picture cropped(const Picture& from, Index border) {
  const Index nx = from.grid.nx - 2 * border, ny = from.grid.ny - 2 * border;
  return {{nx, ny, from.grid.pitch_x, from.grid.pitch_y},
          from.height.block(border, border, ny, nx)};
}

void damage(Picture& picture, RandomStream& random) {
  for (Index i = 0; i < picture.height.size(); ++i) {
    const double chance = random.uniform();
    if (chance < 0.05) picture.height.data()[i] = kNan;
    if (chance > 0.995) picture.height.data()[i] += (random.uniform() < 0.5 ? -1.0 : 1.0) * 1e-6;
  }
}

/// A disc of 6 pixels off by half of 600 nm, on the wall.
void miscount_fringe(Picture& picture, RandomStream& random) {
  const double cx = random.uniform(0.15, 0.85) * static_cast<double>(picture.grid.nx);
  const double cy = random.uniform(0.3, 0.7) * static_cast<double>(picture.grid.ny);
  for (Index iy = 0; iy < picture.grid.ny; ++iy) {
    for (Index ix = 0; ix < picture.grid.nx; ++ix) {
      const double dx = static_cast<double>(ix) - cx, dy = static_cast<double>(iy) - cy;
      if (dx * dx + dy * dy < 36.0) picture.height(iy, ix) += 300e-9;
    }
  }
}

/// A form of the frame: by default 0.3 um along, 0.1 um across.
void curve(Picture& picture, double along = 300e-9, double across = -100e-9) {
  const auto place = [](Index i, Index n) {
    return 2.0 * static_cast<double>(i) / static_cast<double>(n - 1) - 1.0;
  };
  for (Index iy = 0; iy < picture.grid.ny; ++iy) {
    for (Index ix = 0; ix < picture.grid.nx; ++ix) {
      const double u = place(ix, picture.grid.nx), v = place(iy, picture.grid.ny);
      picture.height(iy, ix) += along * u * u + across * v * v;
    }
  }
}

/// What happens to one map of the experiment.
using Change = std::function<Picture(Picture, RandomStream&)>;

/// How much of an experiment is measured.
enum class Extent {
  whole,  ///< all levels and runs
  few     ///< every second level and two runs: for changes that move pixels and alter no height
};

struct Variation {
  const char* name;
  const char* wall;
  Change change;
  Extent extent = Extent::whole;
  int level_order = 1;
  double most_silent = 0.0;    ///< share of the stations
  double most_rms = kMostRms;  ///< Pa
};

/// The maps have gaps of their own, 7 pixels and more across. Where a picture is turned they take
/// another shape, and some then exceed the widest gap across the channel that a station may have.
constexpr double kSilentWhereTurned = 0.02;
/// Pa. Shifts and turns, a curved frame and damage leave 8, 7 and 6 Pa at most one by one;
/// together, and where damaged pixels are resampled, twice the root of their squares. The error
/// bars say 60.
constexpr double kMostRmsOfAll = 25.0;

constexpr double kAngle = 0.3 * std::numbers::pi / 180.0;

Picture all_at_once(Picture p, RandomStream& r) {
  curve(p);
  p = moved(p, r.uniform(-3.0, 3.0), r.uniform(-3.0, 3.0), kAngle);
  miscount_fringe(p, r);
  damage(p, r);
  p.height = -p.height.rowwise().reverse().eval();
  return transposed(cropped(p, 4));
}

const std::vector<Variation>& variations() {
  static const std::vector<Variation> list{
      {"EachMapShiftedByUpToThreePixels", "S1",
       [](Picture p, RandomStream& r) {
         return moved(p, r.uniform(-3.0, 3.0), r.uniform(-3.0, 3.0), 0.0);
       }},
      {"AllTurnedAndEachByAnAngleOfItsOwn", "S1",
       [](Picture p, RandomStream& r) {
         return moved(p, 0.0, 0.0, kAngle + r.uniform(-0.3, 0.3) * kAngle);
       },
       Extent::whole, 1, kSilentWhereTurned},
      {"Mirrored", "S1",
       [](Picture p, RandomStream&) {
         p.height = p.height.rowwise().reverse().eval();
         return p;
       },
       Extent::few},
      {"UpsideDown", "S1",
       [](Picture p, RandomStream&) {
         p.height = -p.height;
         return p;
       },
       Extent::few},
      {"Transposed", "S1", [](Picture p, RandomStream&) { return transposed(p); }, Extent::few},
      {"Cropped", "S1", [](Picture p, RandomStream&) { return cropped(p, 4); }, Extent::few},
      {"WithDropoutsSpikesAndFringePatches", "S1",
       [](Picture p, RandomStream& r) {
         miscount_fringe(p, r);
         damage(p, r);
         return p;
       }},
      {"OnACurvedFrame", "S1",
       [](Picture p, RandomStream&) {
         curve(p);
         return p;
       }},
      {"OnAFrameThatCurvesFromMapToMap", "S1",
       [](Picture p, RandomStream& r) {
         curve(p, r.uniform(-300e-9, 300e-9), r.uniform(-100e-9, 100e-9));
         return p;
       },
       Extent::whole, 2},
      {"AllAtOnce", "S1", all_at_once, Extent::whole, 1, kSilentWhereTurned, kMostRmsOfAll},
      {"AllAtOnce", "S4", all_at_once, Extent::whole, 1, kSilentWhereTurned},
  };
  return list;
}

class VariedPractice : public ::testing::TestWithParam<std::size_t> {};

/// The lines of a list that stay: its head, and every `step`-th of the others from `first` on.
std::vector<std::string> kept_lines(const fs::path& list, std::size_t first, std::size_t step) {
  std::ifstream file(list);
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t i = 0; std::getline(file, line); ++i) {
    if (i == 0 || (i > first && (i - 1 - first) % step == 0)) lines.push_back(line);
  }
  return lines;
}

/// The experiment with its maps changed, and nothing said of where the channel lies.
void write_varied(const fs::path& from, const fs::path& to, const Variation& variation) {
  std::string toml = read_file(from / "experiment.toml");
  for (const char* key : {"origin", "flow =", "outward"}) {
    const auto at = toml.find(std::string("\n") + key);
    ASSERT_NE(at, std::string::npos);
    toml.erase(at, toml.find('\n', at + 1) - at);
  }
  std::ofstream(to / "experiment.toml") << toml;
  const bool few = variation.extent == Extent::few;
  std::vector<std::string> maps;
  for (const auto& [list, first, step] :
       {std::tuple{"hydrostatic.csv", std::size_t{0}, std::size_t{few ? 2U : 1U}},
        std::tuple{"flow.csv", std::size_t{few ? 2U : 0U}, std::size_t{few ? 4U : 1U}}}) {
    const std::vector<std::string> lines = kept_lines(from / list, first, step);
    std::ofstream out(to / list);
    for (const std::string& line : lines) {
      out << line << '\n';
      if (&line != &lines.front()) maps.push_back(line.substr(0, line.find(',')));
    }
  }
  std::sort(maps.begin(), maps.end());
  std::uint64_t index = 0;
  for (const std::string& name : maps) {
    RandomStream random(43, "variation", index++);
    const Picture varied = variation.change(picture_of(io::read_height_map(from / name)), random);
    io::write_gsf(to / name, HeightMap(varied.grid, varied.height), "varied");
  }
}

TEST_P(VariedPractice, ReadsTheTruePressureWithinItsErrorBars) {
  const Variation& variation = variations()[GetParam()];
  const fs::path folder = fs::path(test_paths::shared) / "data" / "practice" / variation.wall;
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not on this machine";
  const test_support::TemporaryFolder varied;
  write_varied(folder, varied.path(), variation);
  pipeline::MeasureOptions options;
  options.flow.flow_models = false;
  options.reduce.level_order = variation.level_order;
  const auto measurement =
      pipeline::measure(experiment::read_experiment(varied.path()), options, 2);
  const auto judgements =
      pipeline::judge(measurement, twin::read_truth(folder), 1.6 * mm, 13.0 * mm);
  ASSERT_EQ(judgements.size(), variation.extent == Extent::few ? 2U : 8U);
  std::vector<validation::Judgement> readings;
  for (const auto& run : judgements) {
    SCOPED_TRACE(run.run);
    EXPECT_LE(run.reading.rms, variation.most_rms);
    const auto n = static_cast<double>(run.reading.n_answered + run.reading.n_silent);
    EXPECT_GT(n, 600.0);
    EXPECT_LE(static_cast<double>(run.reading.n_silent), variation.most_silent * n);
    readings.push_back(run.reading);
  }
  const validation::PullSummary pulls = validation::average_pulls(readings);
  // Runs share labels and maps, so that one experiment's pulls lie together: no wider than the
  // error bars, and as many of the intervals of 95 % hold the truth.
  EXPECT_LE(pulls.pull_rms, 1.0);
  EXPECT_GE(pulls.coverage, 0.95);
}

INSTANTIATE_TEST_SUITE_P(Mounts, VariedPractice, ::testing::Range<std::size_t>(0, 11),
                         [](const auto& test) {
                           const Variation& variation = variations()[test.param];
                           return std::string(variation.name) + "Of" + variation.wall;
                         });

}  // namespace
}  // namespace manoscope
