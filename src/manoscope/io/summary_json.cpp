#include "manoscope/io/summary_json.hpp"

#include <nlohmann/json.hpp>

namespace manoscope::io {

using nlohmann::json;

namespace {

json number(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

}  // namespace

json summary_json(const MapSummary& summary) {
  json channels = json::array();
  for (const ChannelSummary& channel : summary.channels) {
    json settings = json::array();
    for (const auto& [name, value] : channel.settings) {
      settings.push_back({{"name", name}, {"value", value}});
    }
    channels.push_back({{"name", channel.name},
                        {"page", channel.page},
                        {"nx", channel.nx},
                        {"ny", channel.ny},
                        {"pitch_x_m", number(channel.pitch_x_m)},
                        {"pitch_y_m", number(channel.pitch_y_m)},
                        {"size_x_m", number(channel.size_x_m)},
                        {"size_y_m", number(channel.size_y_m)},
                        {"unit", channel.unit},
                        {"file_unit", channel.file_unit},
                        {"offset_x_pixels", channel.offset_x},
                        {"offset_y_pixels", channel.offset_y},
                        {"missing", channel.missing},
                        {"min", number(channel.min)},
                        {"max", number(channel.max)},
                        {"mean", number(channel.mean)},
                        {"rms", number(channel.rms)},
                        {"settings", settings},
                        {"warnings", channel.warnings}});
  }
  return {{"file", summary.file.string()},
          {"format", summary.format},
          {"orientation", summary.orientation},
          {"channels", channels}};
}

}  // namespace manoscope::io
