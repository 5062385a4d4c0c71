#include "manoscope/serve/map_api.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "manoscope/core/options.hpp"
#include "manoscope/io/map_address.hpp"
#include "manoscope/io/map_picture.hpp"
#include "manoscope/io/map_summary.hpp"
#include "manoscope/io/summary_json.hpp"
#include "manoscope/report/packed.hpp"
#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/json.hpp"

namespace manoscope::serve {
namespace {

using nlohmann::json;

/// The path of a map beneath the folder, `FILE#n` too.
std::filesystem::path map_path(const Folder& folder, const std::string& name) {
  const std::string file =
      relative_parts(name)
          ? io::map_address(folder.absolute(name)).file.lexically_relative(folder.path()).string()
          : "";
  if (file.empty() || !folder.has(file, Folder::Kind::file)) {
    throw ApiError(404, name, "there is no such file", "Name a map in the folder that is served");
  }
  return folder.absolute(name);
}

io::ReadOptions options_from(const Address& address) {
  io::ReadOptions options;
  for (const auto& [name, key] :
       {std::pair("pitch_x", "pitch-x"), std::pair("pitch_y", "pitch-y"),
        std::pair("height_unit", "height-unit"), std::pair("lateral_unit", "lateral-unit"),
        std::pair("channel", "channel"), std::pair("page", "page")}) {
    const auto value = address.value(name);
    if (value && !value->empty()) set_option(options, key, *value, name);
  }
  return options;
}

int longest_side(const Address& address) {
  constexpr double kShortest = 16.0, kLongest = 4096.0, kUsual = 512.0;
  const auto text = address.value("longest");
  const double side = text ? parse_number(*text).value_or(kUsual) : kUsual;
  return static_cast<int>(std::clamp(std::isfinite(side) ? side : kUsual, kShortest, kLongest));
}

/// Counts of a step so fine that a thousand of them are the colours.
json picture_json(const CameraGrid& grid, const Array2& means, const std::string& unit) {
  constexpr double kSteps = 1000.0;
  const auto [low, high] = io::colour_ends(means);
  double least = std::numeric_limits<double>::quiet_NaN(), most = least, largest = 0.0;
  for (const double mean : means.reshaped()) {
    if (!std::isfinite(mean)) continue;
    least = std::fmin(least, mean);
    most = std::fmax(most, mean);
    largest = std::max(largest, std::abs(mean));
  }
  const double step = std::max((high - low) / kSteps, largest / MapPicture::kLargest);
  Counts2 counts(means.rows(), means.cols());
  for (Index i = 0; i < means.size(); ++i) {
    const double mean = means.data()[i];
    counts.data()[i] = !std::isfinite(mean) ? MapPicture::kMissing
                       : step > 0.0         ? static_cast<std::int16_t>(std::lround(mean / step))
                                            : std::int16_t{0};
  }
  const auto size = [](Length length) {
    return length > Length{} ? json(length.si()) : json(nullptr);
  };
  return {{"nx", means.cols()},
          {"ny", means.rows()},
          {"size_x_m", size(grid.size_x())},
          {"size_y_m", size(grid.size_y())},
          {"unit", unit},
          {"step", step},
          {"counts", report::pack_counts(counts)},
          {"min", number(least)},
          {"max", number(most)},
          {"low", low},
          {"high", high}};
}

}  // namespace

Reply map_reply(const Folder& folder, const Address& address) {
  const std::string name = address.value("file").value_or("");
  const io::ReadOptions options = options_from(address);
  io::MapInspection map = io::inspect_map(map_path(folder, name), options);
  map.summary.file = name;
  if (const auto other = address.value("minus")) {
    const io::MapInspection minus = io::inspect_map(map_path(folder, *other), options);
    if (minus.shown.rows() != map.shown.rows() || minus.shown.cols() != map.shown.cols()) {
      throw InputError(*other, "has other pixels than " + name,
                       "Take maps of one camera and one window");
    }
    map.shown -= minus.shown;
  }
  const Array2 means = io::picture_means(map.grid, map.shown, longest_side(address));
  return json_reply({{"summary", io::summary_json(map.summary)},
                     {"picture", picture_json(map.grid, means, map.unit)}});
}

}  // namespace manoscope::serve
