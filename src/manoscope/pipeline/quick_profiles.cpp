#include "manoscope/pipeline/quick_profiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/maps/channel_map.hpp"

namespace manoscope::pipeline {
namespace {

using Path = std::filesystem::path;

/// A map turned into the channel's frame, as rows of floats.
struct TurnedMap {
  CameraGrid grid;
  std::vector<float> rows;
  ChannelFrame frame;
};

TurnedMap turned(const Path& path, const ChannelFrame& frame) {
  const maps::ChannelMap map = maps::to_channel_frame(io::read_height_map(path), frame);
  TurnedMap result;
  result.grid = {map.grid.nx, map.grid.nz, map.grid.pitch_x, map.grid.pitch_z};
  result.rows.resize(static_cast<std::size_t>(map.height.size()));
  for (Index i = 0; i < map.height.size(); ++i) {
    result.rows[static_cast<std::size_t>(i)] = map.flags.data()[i] == 0
                                                   ? static_cast<float>(map.height.data()[i])
                                                   : std::numeric_limits<float>::quiet_NaN();
  }
  result.frame.length = frame.length;
  result.frame.width = frame.width;
  result.frame.origin_x = 0.5 * map.grid.pitch_x - map.grid.x0;
  result.frame.origin_y = 0.5 * map.grid.pitch_z - 0.5 * frame.width - map.grid.z0;
  return result;
}

/// What one map at a time is reduced in.
struct WorkRoom {
  maps::LinearPass pass;
  io::PieceBuffer buffer;

  explicit WorkRoom(const maps::LinearReducer& reducer) : pass(reducer) {}
};

/// As many as there are threads at work. One that a fault has left unfinished is not given back.
class WorkRooms {
 public:
  explicit WorkRooms(const maps::LinearReducer& reducer) : reducer_(reducer) {}

  std::unique_ptr<WorkRoom> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<WorkRoom>(reducer_);
    auto room = std::move(free_.back());
    free_.pop_back();
    return room;
  }
  void give_back(std::unique_ptr<WorkRoom> room) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(room));
  }

 private:
  const maps::LinearReducer& reducer_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<WorkRoom>> free_;
};

void require_grid(const CameraGrid& first, const CameraGrid& grid, const Path& path) {
  if (grid == first) return;
  throw InputError(path.string(),
                   fmt::format("has {} x {} pixels of {:.8g} x {:.8g} um, the first map {} x {} of "
                               "{:.8g} x {:.8g} um",
                               grid.nx, grid.ny, grid.pitch_x.in(um), grid.pitch_y.in(um), first.nx,
                               first.ny, first.pitch_x.in(um), first.pitch_y.in(um)),
                   "Take all maps with the same camera settings");
}

}  // namespace

std::vector<maps::LinearReduction> quick_profiles(const std::vector<Path>& files,
                                                  const ChannelFrame& frame,
                                                  const QuickProfilesOptions& options,
                                                  int n_threads, const Monitor& monitor) {
  std::vector<maps::LinearReduction> results(files.size());
  if (files.empty()) return results;
  const auto open = [&](const Path& path, io::PieceBuffer* lent = nullptr) {
    return options.raw ? std::make_unique<io::FloatRows>(path, *options.raw, lent)
                       : std::make_unique<io::FloatRows>(path, lent);
  };
  const auto streams = [&](const Path& path) {
    return options.raw || (maps::LinearReducer::reduces(frame) && io::FloatRows::can_read(path));
  };
  std::optional<maps::LinearReducer> reducer;
  const std::string first_name = files.front().string();
  const bool all_stream = streams(files.front());
  if (all_stream) {
    reducer.emplace(open(files.front())->grid(), frame, first_name, options.reduction);
  } else {
    const TurnedMap first = turned(files.front(), frame);
    reducer.emplace(first.grid, first.frame, first_name, options.reduction);
  }
  const auto reduce = [&](maps::LinearPass& pass, io::PieceBuffer& buffer, const Path& path) {
    if (!all_stream) {
      const TurnedMap map = turned(path, frame);
      require_grid(reducer->grid(), map.grid, path);
      const std::size_t n_bytes = map.rows.size() * sizeof(float);
      pass.add_rows({reinterpret_cast<const char*>(map.rows.data()), n_bytes});
      return pass.finish(1.0, path.string());
    }
    const auto map = open(path, &buffer);
    require_grid(reducer->grid(), map->grid(), path);
    for (auto rows = map->next(); !rows.empty(); rows = map->next()) pass.add_rows(rows);
    return pass.finish(map->metres_per_unit(), path.string());
  };
  const auto n_files = static_cast<Index>(files.size());
  std::atomic<Index> done{0};
  WorkRooms rooms(*reducer);
  parallel_for(n_files, n_threads, [&](Index i) {
    monitor.checkpoint();
    const auto at = static_cast<std::size_t>(i);
    auto room = rooms.take();
    results[at] = reduce(room->pass, room->buffer, files[at]);
    rooms.give_back(std::move(room));
    monitor.report("reducing maps", static_cast<double>(++done) / static_cast<double>(n_files));
  });
  return results;
}

}  // namespace manoscope::pipeline
