#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/grid.hpp"
#include "manoscope/core/height_map.hpp"

namespace manoscope::io {

/// What a reader may look at before it says whether a file is its own.
struct Probe {
  std::filesystem::path path;
  std::string_view head;  ///< the first bytes of the file, at most 4096
  std::uintmax_t size = 0;
};

/// One image of a file, as stored: values in SI where the unit is known.
struct Channel {
  std::string name;
  CameraGrid grid;        ///< pitch 0 where the file gives no lateral scale
  std::string unit;       ///< SI unit of `values` ("m", "V", "1"), "" if the file names none
  Array2 values;          ///< (ny, nx), NaN where missing
  std::string file_unit;  ///< unit of the values as the file writes it, "" if it names none
};

/// What the user adds to a file that does not say it all.
struct ReadOptions {
  std::optional<Length> pitch_x, pitch_y;  ///< lateral scale, where the file has none
  std::string height_unit;                 ///< e.g. "nm", where the file has none
  std::string channel;                     ///< name of the channel to read; "" = the height channel

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("pitch-x", pitch_x, "distance of neighbouring columns, where the file has none");
    visit("pitch-y", pitch_y, "distance of neighbouring rows, where the file has none");
    visit("height-unit", height_unit, "unit of the heights, where the file has none, e.g. nm");
    visit("channel", channel, "name of the channel to read; empty = the height channel");
  }
};

/// One foreign format. The only place where virtual functions are used: formats come and go.
class Reader {
 public:
  virtual ~Reader() = default;
  virtual std::string_view name() const = 0;                ///< short and unique: "gsf"
  virtual std::string_view description() const = 0;         ///< "Gwyddion Simple Field"
  virtual std::vector<std::string> extensions() const = 0;  ///< lower case, with the dot
  /// How surely the file is of this format: 0 = not at all, 100 = its signature is there.
  virtual int score(const Probe& probe) const = 0;
  /// Every channel of the file.
  /// @throws InputError naming the file, what was found and what to do.
  virtual std::vector<Channel> read(const std::filesystem::path& path,
                                    const ReadOptions& options) const = 0;
};

/// The one table of readers, in the order of `manoscope formats`.
const std::vector<const Reader*>& readers();

/// The reader with the highest score.
/// @throws InputError if no reader knows the file (naming the formats that exist).
const Reader& find_reader(const std::filesystem::path& path);

/// Every channel of a file, by the reader that fits it best.
std::vector<Channel> read_channels(const std::filesystem::path& path,
                                   const ReadOptions& options = {});

/// The height channel of a file.
///
/// @throws InputError if the file has no channel of a length unit, more than one and none named in
///         the options, no lateral scale (saying which option supplies it), or no good pixel at
///         all.
HeightMap read_height_map(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace manoscope::io
