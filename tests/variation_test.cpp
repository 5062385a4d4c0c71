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

/// The form of the frame, the same in every map: 0.3 um along, 0.1 um across.
void curve(Picture& picture) {
  const auto place = [](Index i, Index n) {
    return 2.0 * static_cast<double>(i) / static_cast<double>(n - 1) - 1.0;
  };
  for (Index iy = 0; iy < picture.grid.ny; ++iy) {
    for (Index ix = 0; ix < picture.grid.nx; ++ix) {
      const double u = place(ix, picture.grid.nx), v = place(iy, picture.grid.ny);
      picture.height(iy, ix) += 300e-9 * u * u - 100e-9 * v * v;
    }
  }
}

/// What happens to one map of the experiment.
using Change = std::function<Picture(Picture, RandomStream&)>;

struct Variation {
  const char* name;
  Change change;
};

constexpr double kAngle = 0.3 * std::numbers::pi / 180.0;

const std::vector<Variation>& variations() {
  static const std::vector<Variation> list{
      {"EachMapShiftedByUpToThreePixels",
       [](Picture p, RandomStream& r) {
         return moved(p, r.uniform(-3.0, 3.0), r.uniform(-3.0, 3.0), 0.0);
       }},
      {"AllTurnedAndEachByAnAngleOfItsOwn",
       [](Picture p, RandomStream& r) {
         return moved(p, 0.0, 0.0, kAngle + r.uniform(-0.3, 0.3) * kAngle);
       }},
      {"MirroredTransposedCroppedAndUpsideDown",
       [](Picture p, RandomStream&) {
         p.height = -p.height.rowwise().reverse().eval();
         return transposed(cropped(p, 4));
       }},
      {"WithDropoutsSpikesAndFringePatches",
       [](Picture p, RandomStream& r) {
         miscount_fringe(p, r);
         damage(p, r);
         return p;
       }},
      {"OnACurvedFrame",
       [](Picture p, RandomStream&) {
         curve(p);
         return p;
       }},
      {"AllAtOnce",
       [](Picture p, RandomStream& r) {
         curve(p);
         p = moved(p, r.uniform(-3.0, 3.0), r.uniform(-3.0, 3.0), kAngle);
         miscount_fringe(p, r);
         damage(p, r);
         p.height = -p.height.rowwise().reverse().eval();
         return transposed(cropped(p, 4));
       }},
  };
  return list;
}

class VariedPractice : public ::testing::TestWithParam<std::size_t> {};

/// The experiment with its maps changed, and nothing said of where the channel lies.
void write_varied(const fs::path& from, const fs::path& to, const Change& change) {
  std::string toml = read_file(from / "experiment.toml");
  for (const char* key : {"origin", "flow =", "outward"}) {
    const auto at = toml.find(std::string("\n") + key);
    ASSERT_NE(at, std::string::npos);
    toml.erase(at, toml.find('\n', at + 1) - at);
  }
  std::ofstream(to / "experiment.toml") << toml;
  for (const char* list : {"hydrostatic.csv", "flow.csv"}) fs::copy_file(from / list, to / list);
  std::uint64_t index = 0;
  std::vector<fs::path> maps;
  for (const auto& entry : fs::directory_iterator(from)) {
    if (entry.path().extension() == ".gsf") maps.push_back(entry.path());
  }
  std::sort(maps.begin(), maps.end());
  for (const fs::path& path : maps) {
    RandomStream random(43, "variation", index++);
    const Picture varied = change(picture_of(io::read_height_map(path)), random);
    io::write_gsf(to / path.filename(), HeightMap(varied.grid, varied.height), "varied");
  }
}

TEST_P(VariedPractice, ReadsTheSamePressureWithinItsErrorBars) {
  const fs::path folder = fs::path(test_paths::shared) / "data" / "practice" / "S1";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not on this machine";
  static const results::Measurement plain =
      pipeline::measure(experiment::read_experiment(folder), {}, 2);
  const test_support::TemporaryFolder varied_folder;
  write_varied(folder, varied_folder.path(), variations()[GetParam()].change);
  const auto varied = pipeline::measure(experiment::read_experiment(varied_folder.path()), {}, 2);

  const auto judgements = pipeline::judge(varied, twin::read_truth(folder), 1.6 * mm, 13.0 * mm);
  for (const auto& run : judgements) {
    // As for the plain experiment: what 10 Pa of noise on each pressure label leaves.
    EXPECT_LE(run.reading.rms, std::max(20.0, 0.01 * run.true_drop)) << run.run;
  }
  for (Index r = 0; r < plain.flow_rate.size(); ++r) {
    Index within = 0, n = 0;
    for (Index ix = 0; ix < varied.x.size(); ++ix) {
      const double x = varied.x[ix];
      if (x < 1.6e-3 || x > 13.0e-3) continue;
      // The nearest station of the plain reading and the gradient there.
      Index k = 1;
      while (k + 2 < plain.x.size() && plain.x[k] < x) ++k;
      const double share = (x - plain.x[k - 1]) / (plain.x[k] - plain.x[k - 1]);
      const double expected =
          (1.0 - share) * plain.pressure(r, k - 1) + share * plain.pressure(r, k);
      if (std::isnan(expected) || std::isnan(varied.pressure(r, ix))) continue;
      ++n;
      // Both were placed and leveled with errors of their own.
      const double allowed = std::hypot(varied.pressure_upper(r, ix) - varied.pressure(r, ix),
                                        plain.pressure_upper(r, k) - plain.pressure(r, k));
      within += std::abs(varied.pressure(r, ix) - expected) <= allowed;
    }
    ASSERT_GT(n, 100);
    // Of two intervals of 95 %.
    EXPECT_GE(static_cast<double>(within) / static_cast<double>(n), 0.95)
        << variations()[GetParam()].name << ' ' << plain.run[static_cast<std::size_t>(r)];
  }
}

INSTANTIATE_TEST_SUITE_P(Mounts, VariedPractice, ::testing::Range<std::size_t>(0, 6),
                         [](const auto& test) {
                           return std::string(variations()[test.param].name);
                         });

}  // namespace
}  // namespace manoscope
