#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/io/reader.hpp"

namespace manoscope::io {

/// What one channel holds, in SI. Statistics are over the good pixels; without any they are absent.
struct ChannelSummary {
  std::string name;
  int page = 0;  ///< by which number `FILE#n` names it
  Index nx = 0, ny = 0;
  std::optional<double> pitch_x_m, pitch_y_m;  ///< absent where the file gives no lateral scale
  std::optional<double> size_x_m, size_y_m;    ///< n times pitch
  std::string unit;                            ///< of the values, SI; "" if the file names none
  std::string file_unit;                       ///< of the values, as the file writes it
  Index missing = 0;                           ///< pixels without a value
  std::optional<double> min, max, mean;
  std::optional<double> rms;         ///< about the mean: sqrt(sum (v - mean)^2 / n)
  Index offset_x = 0, offset_y = 0;  ///< first pixel's position in the camera frame
  std::vector<std::pair<std::string, std::string>> settings;  ///< of the instrument, as written
  std::vector<std::string> warnings;                          ///< what is doubtful in the file
};

/// What a map file holds.
struct MapSummary {
  std::filesystem::path file;
  std::string format;       ///< name of its reader
  std::string orientation;  ///< which way round the maps come out
  std::vector<ChannelSummary> channels;
};

ChannelSummary summarise(const Channel& channel);

/// What a file holds, with the channel that a picture would show.
struct MapInspection {
  MapSummary summary;
  CameraGrid grid;  ///< of `shown`
  Array2 shown;  ///< the channel that the options name, else the first of heights, else the first
  std::string unit;  ///< of `shown`
};

/// As summarise_map(), with the values of one channel.
/// @throws InputError as read_channels() does, and if options.channel names none of the channels.
MapInspection inspect_map(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads a file and tells what is in it. A channel without lateral scale or unit is told, not
/// refused.
/// @throws InputError as read_channels() does.
MapSummary summarise_map(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace manoscope::io
