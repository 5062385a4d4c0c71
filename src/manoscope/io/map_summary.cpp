#include "manoscope/io/map_summary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"

namespace manoscope::io {

ChannelSummary summarise(const Channel& channel) {
  ChannelSummary summary;
  summary.name = channel.name;
  summary.page = channel.page;
  summary.unit = channel.unit;
  summary.file_unit = channel.file_unit;
  summary.offset_x = channel.offset_x;
  summary.offset_y = channel.offset_y;
  summary.settings = channel.settings;
  summary.warnings = channel.warnings;
  const CameraGrid& grid = channel.grid;
  summary.nx = grid.nx;
  summary.ny = grid.ny;
  if (grid.pitch_x > Length{}) {
    summary.pitch_x_m = grid.pitch_x.si();
    summary.size_x_m = grid.size_x().si();
  }
  if (grid.pitch_y > Length{}) {
    summary.pitch_y_m = grid.pitch_y.si();
    summary.size_y_m = grid.size_y().si();
  }

  // Row by row, so that the round-off of long sums stays small. Two passes: the rms of a map far
  // from zero would drown in the difference of two large sums.
  double least = 0.0, most = 0.0, sum = 0.0;
  Index n = 0;
  for (Index iy = 0; iy < channel.values.rows(); ++iy) {
    double row = 0.0;
    for (Index ix = 0; ix < channel.values.cols(); ++ix) {
      const double value = channel.values(iy, ix);
      if (!std::isfinite(value)) continue;
      least = n == 0 ? value : std::min(least, value);
      most = n == 0 ? value : std::max(most, value);
      row += value;
      ++n;
    }
    sum += row;
  }
  summary.missing = channel.values.size() - n;
  if (n == 0) return summary;
  const double mean = sum / static_cast<double>(n);
  double squares = 0.0;
  for (Index iy = 0; iy < channel.values.rows(); ++iy) {
    double row = 0.0;
    for (Index ix = 0; ix < channel.values.cols(); ++ix) {
      const double value = channel.values(iy, ix);
      if (std::isfinite(value)) row += (value - mean) * (value - mean);
    }
    squares += row;
  }
  summary.min = least;
  summary.max = most;
  summary.mean = mean;
  summary.rms = std::sqrt(squares / static_cast<double>(n));
  return summary;
}

MapInspection inspect_map(const std::filesystem::path& path, const ReadOptions& options) {
  const Reader& reader = find_any_reader(path, options);
  MapInspection inspection;
  inspection.summary.file = path;
  inspection.summary.format = std::string(reader.name());
  inspection.summary.orientation = std::string(reader.orientation());
  std::vector<Channel> channels = read_channels(path, options);
  const auto is_shown = [&](const Channel& channel) {
    return options.channel.empty() ? channel.unit == "m" : channel.name == options.channel;
  };
  auto shown = std::find_if(channels.begin(), channels.end(), is_shown);
  if (shown == channels.end() && !options.channel.empty()) {
    throw InputError(path.string(), "has no channel \"" + excerpt(options.channel) + "\"",
                     "`manoscope inspect` without --channel lists them");
  }
  if (shown == channels.end()) shown = channels.begin();
  for (const Channel& channel : channels) {
    inspection.summary.channels.push_back(summarise(channel));
  }
  inspection.grid = shown->grid;
  inspection.unit = shown->unit;
  inspection.shown = std::move(shown->values);
  return inspection;
}

MapSummary summarise_map(const std::filesystem::path& path, const ReadOptions& options) {
  return inspect_map(path, options).summary;
}

}  // namespace manoscope::io
