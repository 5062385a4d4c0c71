#include "manoscope/io/array_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/suggest.hpp"
#include "manoscope/io/even_axis.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"

namespace manoscope::io {
namespace {

/// More than this is read only one by one: 100 million pixels are 800 MB.
constexpr double kMostPixelsAtOnce = 1e8;
constexpr double kMostMapsAtOnce = 4096.0;

/// A map or a series of maps: the array without its dimensions of length 1.
struct Candidate {
  const NamedArray* array = nullptr;
  bool series = false;
  std::uint64_t n_frames = 1, nx = 0, ny = 0;
  int number = 0;  ///< among the maps of the file, from 1

  double n_pixels() const {
    return static_cast<double>(n_frames) * static_cast<double>(nx) * static_cast<double>(ny);
  }
};

std::optional<Candidate> candidate(const NamedArray& array) {
  std::vector<std::uint64_t> shape;
  for (const std::uint64_t length : array.shape) {
    if (length != 1) shape.push_back(length);
  }
  if (shape.size() != 2 && shape.size() != 3) return std::nullopt;
  Candidate found;
  found.array = &array;
  found.series = shape.size() == 3;
  // A series is read frame by frame, which asks for its first dimension in the first place.
  if (found.series && array.shape.front() == 1) return std::nullopt;
  if (found.series) found.n_frames = shape[0];
  const std::uint64_t slow = shape[shape.size() - 2], fast = shape.back();
  found.nx = array.by_columns ? slow : fast;
  found.ny = array.by_columns ? fast : slow;
  if (found.nx < 2 || found.ny < 2 || found.n_frames < 1) return std::nullopt;
  return found;
}

std::string last_part(const std::string& name) { return name.substr(name.rfind('/') + 1); }
std::string first_part(const std::string& name) {
  const auto slash = name.rfind('/');
  return slash == std::string::npos ? std::string() : name.substr(0, slash + 1);
}

template <class List, class Text>
std::string told(const List& list, const Text& text) {
  constexpr std::size_t kMost = 20;
  std::vector<std::string> words;
  for (const auto& item : list) {
    if (words.size() == kMost) {
      words.push_back(fmt::format("and {} more", list.size() - kMost));
      break;
    }
    words.push_back(text(item));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string array_text(const NamedArray& array) {
  return fmt::format("\"{}\" {}", excerpt(array.name), array.size_text());
}

/// Length of a vector, 0 if the array is none.
std::uint64_t vector_length(const NamedArray& array) {
  std::uint64_t length = 1;
  for (const std::uint64_t n : array.shape) {
    if (n != 1 && length != 1) return 0;
    length = std::max(length, n);
  }
  return length;
}

/// Scale of an axis from a vector of positions beside the map, 0 where there is none.
Length pitch(const std::vector<NamedArray>& arrays, const Candidate& map, const char* axis,
             std::uint64_t n, const ReadOptions& options, const std::string& where) {
  const std::string group = first_part(map.array->name);
  for (const NamedArray& array : arrays) {
    if (first_part(array.name) != group || lower_case(last_part(array.name)) != axis) continue;
    if (vector_length(array) != n) continue;
    const auto scale = length_scale(array.unit.empty() ? options.lateral_unit : array.unit);
    if (!scale) continue;
    std::vector<double> positions(n);
    array.read(std::nullopt, positions.data());
    const std::string place = fmt::format("{}: \"{}\"", where, excerpt(array.name));
    const double step = even_step(positions, place);
    if (!(scale->factor > 0.0 && scale->factor < 1e30 && step < 1e30)) {
      throw InputError(place, fmt::format("has an absurd spacing of {:.3g}", step),
                       "Check the lateral scale");
    }
    return Length::from_si(checked_pitch(scale->factor * step, "its spacing", place));
  }
  return {};
}

Channel channel(const std::vector<NamedArray>& arrays, const Candidate& map, std::uint64_t frame,
                const ReadOptions& options, const std::string& where) {
  const NamedArray& array = *map.array;
  const std::string place = fmt::format("{}: \"{}\"", where, excerpt(array.name));
  check_pixel_counts(static_cast<double>(map.nx), static_cast<double>(map.ny), place);
  Channel channel;
  channel.name = array.name;
  channel.settings = array.settings;
  channel.file_unit = array.unit;
  channel.grid.nx = static_cast<Index>(map.nx);
  channel.grid.ny = static_cast<Index>(map.ny);
  channel.grid.pitch_x = pitch(arrays, map, "x", map.nx, options, where);
  channel.grid.pitch_y = pitch(arrays, map, "y", map.ny, options, where);
  const SiUnit unit = si_unit(array.unit, place);
  channel.unit = unit.name;
  if (array.by_columns) {
    channel.values.resize(channel.grid.nx, channel.grid.ny);
  } else {
    channel.values.resize(channel.grid.ny, channel.grid.nx);
  }
  array.read(map.series ? std::optional(frame) : std::nullopt, channel.values.data());
  if (array.fill) {
    for (Index i = 0; i < channel.values.size(); ++i) {
      double& value = channel.values.data()[i];
      if (value == value && value == *array.fill) {
        value = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }
  scale_values(channel.values, unit.scale, place);
  if (array.by_columns) channel.values.transposeInPlace();
  return channel;
}

/// Those that the options name, or all.
std::vector<Candidate> chosen(const std::vector<Candidate>& maps, const ReadOptions& options,
                              const std::string& where) {
  if (options.channel.empty()) return maps;
  std::vector<Candidate> exact, by_last_part;
  std::vector<std::string> names;
  for (const Candidate& map : maps) {
    const std::string& name = map.array->name;
    names.push_back(name);
    if (name == options.channel || "/" + name == options.channel) exact.push_back(map);
    if (last_part(name) == options.channel) by_last_part.push_back(map);
  }
  if (!exact.empty()) return exact;
  if (by_last_part.size() == 1) return by_last_part;
  const auto text = [](const Candidate& map) { return array_text(*map.array); };
  throw InputError(
      where,
      by_last_part.empty()
          ? fmt::format("has no channel \"{}\"{}; it has {}", options.channel,
                        did_you_mean(options.channel, names), told(maps, text))
          : fmt::format("has more than one \"{}\": {}", options.channel, told(by_last_part, text)),
      "Name one of its channels with --channel");
}

}  // namespace

std::string NamedArray::size_text() const {
  if (const auto map = candidate(*this)) {
    return map->series ? fmt::format("{} x {}, {} frames", map->nx, map->ny, map->n_frames)
                       : fmt::format("{} x {}", map->nx, map->ny);
  }
  return shape.empty() ? std::string("one number") : fmt::format("{}", fmt::join(shape, " x "));
}

std::vector<Channel> array_channels(const std::vector<NamedArray>& arrays,
                                    const ReadOptions& options, const std::string& where) {
  std::vector<Candidate> all;
  for (const NamedArray& array : arrays) {
    const auto map = candidate(array);
    if (!map) continue;
    all.push_back(*map);
    all.back().number = static_cast<int>(all.size());
  }
  if (all.empty()) {
    throw InputError(where,
                     arrays.empty() ? std::string("holds no array of numbers")
                                    : fmt::format("holds no map; its arrays of numbers are {}",
                                                  told(arrays, array_text)),
                     "Store the heights as a matrix of numbers");
  }
  const std::vector<Candidate> maps = chosen(all, options, where);
  const bool any_series =
      std::any_of(all.begin(), all.end(), [](const Candidate& map) { return map.series; });
  struct Wanted {
    const Candidate* map;
    std::uint64_t frame;
    int page;
  };
  const auto text = [](const Candidate& map) { return array_text(*map.array); };
  double n_pixels = 0.0, n_maps = 0.0;
  for (const Candidate& map : maps) {
    n_pixels += map.n_pixels();
    n_maps += static_cast<double>(map.n_frames);
  }
  if (options.page == 0 && n_maps > 1.0 &&
      (n_pixels > kMostPixelsAtOnce || n_maps > kMostMapsAtOnce)) {
    throw InputError(
        where, fmt::format("holds more than is read at once: {}", told(maps, text)),
        "Name one with --channel, or instrument.channel in the experiment file; of a series, one "
        "frame as FILE#2 or with --page");
  }
  std::vector<Wanted> wanted;
  for (const Candidate& map : maps) {
    for (std::uint64_t frame = 0; frame < map.n_frames; ++frame) {
      if (options.page != 0 && any_series) frame = static_cast<std::uint64_t>(options.page) - 1;
      if (frame >= map.n_frames) break;
      const int page = any_series ? static_cast<int>(frame) + 1 : map.number;
      if (options.page == 0 || options.page == page) wanted.push_back({&map, frame, page});
      if (options.page != 0) break;
    }
  }
  if (wanted.empty()) {
    throw InputError(where,
                     fmt::format("has no page {}; it has {}", options.page, told(maps, text)),
                     "Name a page that is there");
  }
  std::vector<Channel> channels;
  for (const Wanted& one : wanted) {
    channels.push_back(channel(arrays, *one.map, one.frame, options, where));
    channels.back().page = one.page;
    // Under the name by which it was asked for.
    if (!options.channel.empty()) channels.back().name = options.channel;
  }
  return channels;
}

}  // namespace manoscope::io
