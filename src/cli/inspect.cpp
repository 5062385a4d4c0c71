// manoscope inspect FILE...: what map files hold.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "manoscope/io/map_summary.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;

json number(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

json to_json(const io::MapSummary& summary) {
  json channels = json::array();
  for (const io::ChannelSummary& channel : summary.channels) {
    channels.push_back({{"name", channel.name},
                        {"nx", channel.nx},
                        {"ny", channel.ny},
                        {"pitch_x_m", number(channel.pitch_x_m)},
                        {"pitch_y_m", number(channel.pitch_y_m)},
                        {"size_x_m", number(channel.size_x_m)},
                        {"size_y_m", number(channel.size_y_m)},
                        {"unit", channel.unit},
                        {"missing", channel.missing},
                        {"min", number(channel.min)},
                        {"max", number(channel.max)},
                        {"mean", number(channel.mean)},
                        {"rms", number(channel.rms)}});
  }
  return {{"file", summary.file.string()}, {"format", summary.format}, {"channels", channels}};
}

std::string length_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g} mm", *value * 1e3) : std::string("unknown");
}

std::string to_text(const io::MapSummary& summary) {
  std::string text = fmt::format("{}  ({})\n", summary.file.string(), summary.format);
  for (const io::ChannelSummary& channel : summary.channels) {
    const bool is_length = channel.unit == "m";
    const double scale = is_length ? 1e6 : 1.0;
    const std::string unit = is_length ? "um" : channel.unit;
    const auto value = [&](const std::optional<double>& v) {
      return v ? fmt::format("{:.6g} {}", *v * scale, unit) : std::string("none");
    };
    text += fmt::format(
        "  {}: {} x {} pixels, {} x {} ({} missing)\n"
        "    min {}, max {}, mean {}, rms {}\n",
        channel.name.empty() ? "map" : channel.name, channel.nx, channel.ny,
        length_text(channel.size_x_m), length_text(channel.size_y_m), channel.missing,
        value(channel.min), value(channel.max), value(channel.mean), value(channel.rms));
  }
  return text;
}

}  // namespace

void add_inspect(Program& program) {
  struct Args {
    std::vector<std::filesystem::path> files;
    io::ReadOptions reading;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command("inspect", "Tell what map files hold");
  command.positional("files", args->files, "map files");
  command.options(args->reading, "Reading");
  command.action([args](const Context& context) {
    json list = json::array();
    std::string text;
    for (const auto& file : args->files) {
      const io::MapSummary summary = io::summarise_map(file, args->reading);
      if (context.json) {
        list.push_back(to_json(summary));
      } else {
        text += to_text(summary);
      }
    }
    print(context.json ? list.dump(2) + "\n" : text);
  });
}

}  // namespace manoscope::cli
