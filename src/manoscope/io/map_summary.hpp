#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/io/reader.hpp"

namespace manoscope::io {

/// What one channel holds, in SI. Statistics are over the good pixels; without any they are absent.
struct ChannelSummary {
  std::string name;
  Index nx = 0, ny = 0;
  std::optional<double> pitch_x_m, pitch_y_m;  ///< absent where the file gives no lateral scale
  std::optional<double> size_x_m, size_y_m;    ///< n times pitch
  std::string unit;                            ///< of the values, SI; "" if the file names none
  Index missing = 0;                           ///< pixels without a value
  std::optional<double> min, max, mean;
  std::optional<double> rms;  ///< about the mean: sqrt(sum (v - mean)^2 / n)
};

/// What a map file holds.
struct MapSummary {
  std::filesystem::path file;
  std::string format;  ///< name of its reader
  std::vector<ChannelSummary> channels;
};

ChannelSummary summarise(const Channel& channel);

/// Reads a file and tells what is in it. A channel without lateral scale or unit is told, not
/// refused.
/// @throws InputError as read_channels() does.
MapSummary summarise_map(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace manoscope::io
