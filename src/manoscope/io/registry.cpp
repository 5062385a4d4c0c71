#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/suggest.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"

namespace manoscope::io {
namespace {

constexpr std::size_t kHeadBytes = 4096;

std::string read_head(const std::filesystem::path& path, std::uintmax_t& size) {
  std::error_code failure;
  const bool regular = std::filesystem::is_regular_file(path, failure);
  size = regular ? std::filesystem::file_size(path, failure) : 0;
  std::ifstream stream;
  if (regular && !failure) stream.open(path, std::ios::binary);
  if (!stream.is_open()) {
    static_cast<void>(read_file(path));  // says why it cannot be read
    throw InputError(path.string(), "cannot be read", "Check the permissions of the file");
  }
  if (size == 0) throw InputError(path.string(), "is empty", "Copy or export it again");
  std::string head(std::min<std::uintmax_t>(size, kHeadBytes), '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head;
}

std::string known_formats() {
  std::vector<std::string> formats;
  for (const Reader* reader : readers()) {
    formats.push_back(
        fmt::format("{} ({})", reader->description(), fmt::join(reader->extensions(), " ")));
  }
  return fmt::format("{}", fmt::join(formats, ", "));
}

std::string channel_list(const std::vector<Channel>& channels) {
  std::vector<std::string> names;
  for (const Channel& channel : channels) {
    const std::string unit = channel.unit.empty() ? std::string("?") : excerpt(channel.unit);
    names.push_back(fmt::format("\"{}\" [{}]", excerpt(channel.name), unit));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Where the user's scale joins the file's; a contradiction between the two is nobody's to settle
/// in silence.
void supply_pitch(Length& pitch, const std::optional<Length>& given, std::string_view axis,
                  const std::string& where) {
  if (!given) return;
  const double asked = checked_pitch(given->si(), fmt::format("--pitch-{}", axis), where);
  if (pitch > Length{} && std::abs(pitch.si() / asked - 1.0) > 1e-6) {
    throw InputError(where,
                     fmt::format("says itself that its pitch in {} is {:.7g} um, not {:.7g} um",
                                 axis, pitch.in(um), given->in(um)),
                     fmt::format("Leave out --pitch-{}, or correct the file", axis));
  }
  if (pitch == Length{}) pitch = *given;
}

void supply_height_unit(Channel& channel, const ReadOptions& options, const std::string& where) {
  if (options.height_unit.empty()) return;
  const auto scale = length_scale(options.height_unit);
  if (!scale) {
    throw InputError("--height-unit",
                     fmt::format("\"{}\" is not a unit of length", options.height_unit),
                     "Write a unit such as nm, um or m");
  }
  if (channel.unit.empty()) {
    scale_values(channel.values, *scale, where);
    channel.unit = std::string("m");
  }
}

/// As for the pitch: the user's unit may repeat the file's, not contradict it.
void refuse_second_unit(const Channel& channel, const ReadOptions& options,
                        const std::string& where) {
  if (options.height_unit.empty() || channel.file_unit.empty()) return;
  const auto asked = length_scale(options.height_unit), stated = length_scale(channel.file_unit);
  if (asked && stated && std::abs(asked->factor / stated->factor - 1.0) > 1e-9) {
    throw InputError(where,
                     fmt::format("says itself that its heights are in {}, not in {}",
                                 excerpt(channel.file_unit), options.height_unit),
                     "Leave out --height-unit, or correct the file");
  }
}

const Channel& height_channel(const std::vector<Channel>& channels, const ReadOptions& options,
                              const std::string& where) {
  std::vector<const Channel*> found;
  for (const Channel& channel : channels) {
    if (options.channel.empty() ? channel.unit == "m" : channel.name == options.channel) {
      found.push_back(&channel);
    }
  }
  if (found.size() > 1) {
    throw InputError(
        where,
        fmt::format("has more than one channel that may be meant: {}", channel_list(channels)),
        "Name the one to read with --channel");
  }
  if (found.size() == 1 && found.front()->unit == "m") return *found.front();
  if (found.empty() && !options.channel.empty()) {
    std::vector<std::string> names;
    for (const Channel& channel : channels) names.push_back(channel.name);
    throw InputError(where,
                     fmt::format("has no channel \"{}\"{}; it has {}", options.channel,
                                 did_you_mean(options.channel, names), channel_list(channels)),
                     "Name one of its channels with --channel");
  }
  bool unit_missing = false;
  for (const Channel& channel : channels) {
    const bool meant = found.empty() || &channel == found.front();
    unit_missing = unit_missing || (meant && channel.unit.empty());
  }
  if (unit_missing) {
    throw InputError(
        where, "does not say in which unit its heights are",
        "Add it, e.g. --height-unit nm, or instrument.height_unit = \"nm\" in the experiment "
        "file");
  }
  throw InputError(where,
                   fmt::format("has no heights: its channels are {}", channel_list(channels)),
                   "Export the height (topography) channel");
}

}  // namespace

const std::vector<const Reader*>& readers() {
  static const std::vector<const Reader*> table{&gsf_reader(), &netcdf_reader(), &text_reader()};
  return table;
}

const Reader& find_reader(const std::filesystem::path& path) {
  Probe probe;
  probe.path = path;
  const std::string head = read_head(path, probe.size);
  probe.head = head;
  const Reader* best = nullptr;
  int best_score = 0;
  for (const Reader* reader : readers()) {
    const int score = reader->score(probe);
    if (score > best_score) {
      best = reader;
      best_score = score;
    }
  }
  if (best == nullptr) {
    throw InputError(path.string(), "is of no known format",
                     fmt::format("Known formats: {}", known_formats()));
  }
  return *best;
}

std::vector<Channel> read_channels(const std::filesystem::path& path, const ReadOptions& options) {
  std::vector<Channel> channels = find_reader(path).read(path, options);
  MANO_ASSERT(!channels.empty());
  for (Channel& channel : channels) {
    MANO_ASSERT(channel.values.rows() == channel.grid.ny &&
                channel.values.cols() == channel.grid.nx);
    supply_pitch(channel.grid.pitch_x, options.pitch_x, "x", path.string());
    supply_pitch(channel.grid.pitch_y, options.pitch_y, "y", path.string());
    supply_height_unit(channel, options, path.string());
  }
  return channels;
}

HeightMap read_height_map(const std::filesystem::path& path, const ReadOptions& options) {
  std::vector<Channel> channels = read_channels(path, options);
  const std::string where = path.string();
  const Channel& channel = height_channel(channels, options, where);
  refuse_second_unit(channel, options, where);
  const CameraGrid& grid = channel.grid;
  if (grid.nx < 2 || grid.ny < 2) {
    throw InputError(where,
                     fmt::format("has {} x {} pixels: a profile, not a map", grid.nx, grid.ny),
                     "Give a map of at least 2 x 2 pixels");
  }
  if (grid.pitch_x <= Length{} || grid.pitch_y <= Length{}) {
    const bool both = grid.pitch_x <= Length{} && grid.pitch_y <= Length{};
    throw InputError(where, "has no lateral scale",
                     fmt::format("Add the size of a pixel: {}, or instrument.pixel_pitch = "
                                 "[\"1.5 um\", \"1.5 um\"] in the experiment file",
                                 both                       ? "--pitch-x 1.5um --pitch-y 1.5um"
                                 : grid.pitch_x <= Length{} ? "--pitch-x 1.5um"
                                                            : "--pitch-y 1.5um"));
  }
  bool any = false;
  for (Index i = 0; i < channel.values.size() && !any; ++i) {
    any = std::isfinite(channel.values.data()[i]);
  }
  if (!any) {
    throw InputError(where,
                     fmt::format("none of its {} pixels holds a height", channel.values.size()),
                     "Measure or export the map again");
  }
  const auto chosen = static_cast<std::size_t>(&channel - channels.data());
  return HeightMap(grid, std::move(channels[chosen].values));
}

}  // namespace manoscope::io
