#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/suggest.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/gwyddion_fallback.hpp"
#include "manoscope/io/map_address.hpp"

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
  constexpr std::size_t kMost = 20;
  std::vector<std::string> names;
  for (const Channel& channel : channels) {
    if (names.size() == kMost) {
      names.push_back(fmt::format("and {} more", channels.size() - kMost));
      break;
    }
    const std::string unit = channel.unit.empty() ? std::string("?") : excerpt(channel.unit);
    names.push_back(fmt::format("#{} \"{}\" {} x {} [{}]", channel.page, excerpt(channel.name),
                                channel.grid.nx, channel.grid.ny, unit));
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

/// Said before any file is opened, as readers take it for granted.
void check_lateral_unit(const ReadOptions& options) {
  if (!options.lateral_unit.empty() && !length_scale(options.lateral_unit)) {
    throw InputError("--lateral-unit",
                     fmt::format("\"{}\" is not a unit of length", options.lateral_unit),
                     "Write a unit such as um, mm or m");
  }
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
        "Name the one to read with --channel (instrument.channel in the experiment file), or by "
        "its "
        "number: FILE#2, or --page 2");
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

/// A channel of heights as a map, once nothing of it is missing.
LoadedMap height_map(Channel& channel, const ReadOptions& options, const std::string& where) {
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
                                 "[\"1.5 um\", \"1.5 um\"] in the experiment file; where the file "
                                 "has positions without a unit, --lateral-unit um",
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
  return {HeightMap(grid, std::move(channel.values)), std::move(channel.warnings), channel.offset_x,
          channel.offset_y};
}

/// The reader with the highest score, nullptr if none knows the file.
const Reader* best_reader(const std::filesystem::path& path) {
  Probe probe;
  probe.path = map_address(path).file;
  const std::string head = read_head(probe.path, probe.size);
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
  return best;
}

}  // namespace

const std::vector<const Reader*>& readers() {
  static const std::vector<const Reader*> table{
      &alicona_al3d_reader(),    //
      &bruker_opdx_reader(),     //
      &digital_surf_reader(),    //
      &frt_microprof_reader(),   //
      &gsf_reader(),             //
      &gwy_reader(),             //
      &hdf5_reader(),            //
      &keyence_vk_reader(),      //
      &matlab_reader(),          //
      &nanofocus_nms_reader(),   //
      &netcdf_reader(),          //
      &plux_reader(),            //
      &sdf_reader(),             //
      &sensofar_plu_reader(),    //
      &stylus_profile_reader(),  //
      &text_reader(),            //
      &tiff_reader(),            //
      &truemap_tmd_reader(),     //
      &wyko_ascii_reader(),      //
      &wyko_opd_reader(),        //
      &x3p_reader(),             //
      &zygo_dat_reader(),        //
      &zygo_datx_reader(),       //
      &zygo_xyz_reader(),        //
  };
  return table;
}

const Reader& find_reader(const std::filesystem::path& path) {
  if (const Reader* reader = best_reader(path)) return *reader;
  throw InputError(path.string(), "is of no known format",
                   fmt::format("Known formats: {}", known_formats()));
}

const Reader& find_any_reader(const std::filesystem::path& path, const ReadOptions& options) {
  if (const Reader* reader = best_reader(path)) return *reader;
  if (options.gwyddion && find_gwyddion()) return gwyddion_fallback();
  throw InputError(
      path.string(), "is of no known format",
      fmt::format("{}. Known formats: {}", gwyddion_absence(options), known_formats()));
}

std::vector<Channel> read_channels(const std::filesystem::path& path, const ReadOptions& given) {
  check_lateral_unit(given);
  const MapAddress address = map_address(path);
  ReadOptions options = given;
  if (options.page < 0) {
    throw InputError("--page", fmt::format("{} is no number of a page", options.page),
                     "Pages count from 1; 0 means all");
  }
  if (address.page != 0 && options.page != 0 && options.page != address.page) {
    throw InputError(path.string(),
                     fmt::format("names page {}, --page names {}", address.page, options.page),
                     "Name the page once");
  }
  if (address.page != 0) options.page = address.page;
  std::vector<Channel> channels =
      find_any_reader(address.file, options).read(address.file, options);
  MANO_ASSERT(!channels.empty());
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].page == 0) channels[i].page = static_cast<int>(i) + 1;
  }
  if (options.page != 0) {
    const auto is_other = [&](const Channel& channel) { return channel.page != options.page; };
    if (std::all_of(channels.begin(), channels.end(), is_other)) {
      throw InputError(
          path.string(),
          fmt::format("has no page {}; it has {}", options.page, channel_list(channels)),
          "Name a page that is there");
    }
    std::erase_if(channels, is_other);
  }
  for (Channel& channel : channels) {
    MANO_ASSERT(channel.values.rows() == channel.grid.ny &&
                channel.values.cols() == channel.grid.nx);
    supply_pitch(channel.grid.pitch_x, options.pitch_x, "x", path.string());
    supply_pitch(channel.grid.pitch_y, options.pitch_y, "y", path.string());
    supply_height_unit(channel, options, path.string());
  }
  return channels;
}

LoadedMap load_height_map(const std::filesystem::path& path, const ReadOptions& options) {
  ReadOptions lean = options;
  // Pages count pictures, too.
  lean.heights_only = options.channel.empty() && options.page == 0 && map_address(path).page == 0;
  std::vector<Channel> channels = read_channels(path, lean);
  const std::string where = path.string();
  const Channel& channel = height_channel(channels, options, where);
  return height_map(channels[static_cast<std::size_t>(&channel - channels.data())], options, where);
}

HeightMap read_height_map(const std::filesystem::path& path, const ReadOptions& options) {
  return load_height_map(path, options).map;
}

std::vector<std::pair<int, LoadedMap>> load_height_maps(const std::filesystem::path& path,
                                                        const ReadOptions& options) {
  std::vector<Channel> channels = read_channels(path, options);
  std::vector<std::pair<int, LoadedMap>> maps;
  for (Channel& channel : channels) {
    if (channel.unit != "m") continue;
    if (!options.channel.empty() && channel.name != options.channel) continue;
    const std::string where = fmt::format("{}#{}", map_address(path).file.string(), channel.page);
    const int page = channel.page;
    maps.emplace_back(page, height_map(channel, options, where));
  }
  // Says why there is none.
  if (maps.empty()) static_cast<void>(height_channel(channels, options, path.string()));
  return maps;
}

}  // namespace manoscope::io
