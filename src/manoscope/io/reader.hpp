#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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
  std::vector<std::pair<std::string, std::string>> settings;  ///< of the instrument, as written
  Index offset_x = 0, offset_y = 0;   ///< first pixel's position in the camera frame
  std::vector<std::string> warnings;  ///< what is doubtful in the file and did not stop the reading
  /// By which number `FILE#n` names it, from 1: of a series the page or frame, else its place among
  /// the channels. A reader that leaves it 0 gets the latter.
  int page = 0;
};

/// What the user adds to a file that does not say it all.
struct ReadOptions {
  std::optional<Length> pitch_x, pitch_y;  ///< lateral scale, where the file has none
  std::string height_unit;                 ///< e.g. "nm", where the file has none
  std::string lateral_unit;                ///< e.g. "um", where the file's positions have none
  std::string channel;                     ///< name of the channel to read; "" = the height channel
  int page = 0;          ///< of the page, frame or channel to read, from 1 as in `FILE#n`; 0 = all
  bool gwyddion = true;  ///< let the program Gwyddion read what no reader here knows
  /// No option of the user: pictures beside the heights may be left out, to save their memory.
  bool heights_only = false;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("pitch-x", pitch_x, "distance of neighbouring columns, where the file has none");
    visit("pitch-y", pitch_y, "distance of neighbouring rows, where the file has none");
    visit("height-unit", height_unit, "unit of the heights, where the file has none, e.g. nm");
    visit("lateral-unit", lateral_unit, "unit of the positions, where the file has none, e.g. um");
    visit("channel", channel, "name of the channel to read; empty = the height channel");
    visit("page", page, "number of the page, frame or channel to read, as FILE#N; 0 = all");
    visit("gwyddion", gwyddion, "have the program Gwyddion read what no reader here knows");
  }
};

/// One foreign format. The only place where virtual functions are used: formats come and go.
class Reader {
 public:
  virtual ~Reader() = default;
  virtual std::string_view name() const = 0;                ///< short and unique: "gsf"
  virtual std::string_view description() const = 0;         ///< "Gwyddion Simple Field"
  virtual std::vector<std::string> extensions() const = 0;  ///< lower case, with the dot
  /// Which way round the maps come out: the top row, and what is positive.
  virtual std::string_view orientation() const {
    return "first row on top, heights positive upwards, as the file has them";
  }
  /// How surely the file is of this format: 0 = not at all, 100 = its signature is there.
  virtual int score(const Probe& probe) const = 0;
  /// Every channel of the file.
  /// @throws InputError naming the file, what was found and what to do.
  virtual std::vector<Channel> read(const std::filesystem::path& path,
                                    const ReadOptions& options) const = 0;
};

/// The one table of readers, in the order of `manoscope formats`.
const std::vector<const Reader*>& readers();

/// The reader with the highest score; of `FILE#n`, that of the file.
/// @throws InputError if no reader knows the file (naming the formats that exist).
const Reader& find_reader(const std::filesystem::path& path);

/// As find_reader(), or the program Gwyddion where none of them knows the file and it is there.
/// @throws InputError if Gwyddion is not there, either, or `options` forbid it.
const Reader& find_any_reader(const std::filesystem::path& path, const ReadOptions& options = {});

/// Every channel of a file, by the reader that fits it best; of `FILE#n`, or with `options.page`,
/// only those of that number.
/// @throws InputError as the reader does, or if there is none of that number.
std::vector<Channel> read_channels(const std::filesystem::path& path,
                                   const ReadOptions& options = {});

/// A height map, what is doubtful in its file, and where its window lies in the camera.
struct LoadedMap {
  HeightMap map;
  std::vector<std::string> warnings;
  Index offset_x = 0, offset_y = 0;  ///< first pixel's position in the camera frame
};

/// The height channel of a file; of `FILE#n`, of its n-th page, frame or channel.
///
/// @throws InputError if the file has no channel of a length unit, more than one and none named in
///         the options, no lateral scale (saying which option supplies it), or no good pixel at
///         all.
LoadedMap load_height_map(const std::filesystem::path& path, const ReadOptions& options = {});

/// As load_height_map(), for those who have no use for the warnings.
HeightMap read_height_map(const std::filesystem::path& path, const ReadOptions& options = {});

/// Every height map of a file, with its number: the pages of a stack, the frames of a series.
/// @throws InputError if there is none, or one of them is refused.
std::vector<std::pair<int, LoadedMap>> load_height_maps(const std::filesystem::path& path,
                                                        const ReadOptions& options = {});

}  // namespace manoscope::io
