// manoscope inspect FILE...: what map files hold.
#include <fmt/format.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/map_picture.hpp"
#include "manoscope/io/map_summary.hpp"
#include "manoscope/io/summary_json.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;

std::string length_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g} mm", *value * 1e3) : std::string("unknown");
}

std::string pitch_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g} um", *value * 1e6) : std::string("unknown");
}

std::string to_text(const io::MapSummary& summary, bool shortest) {
  std::string text = fmt::format("{}  ({})\n", summary.file.string(), summary.format);
  if (!shortest) text += fmt::format("  {}\n", summary.orientation);
  for (const io::ChannelSummary& channel : summary.channels) {
    const bool is_length = channel.unit == "m";
    const double scale = is_length ? 1e6 : 1.0;
    const std::string unit = is_length ? "um" : channel.unit;
    const auto value = [&](const std::optional<double>& v) {
      return v ? fmt::format("{:.6g} {}", *v * scale, unit) : std::string("none");
    };
    text += fmt::format(
        "  {}{}: {} x {} pixels, {} x {} ({} missing)\n"
        "    min {}, max {}, mean {}, rms {}\n",
        summary.channels.size() > 1 ? fmt::format("#{} ", channel.page) : std::string(),
        channel.name.empty() ? "map" : channel.name, channel.nx, channel.ny,
        length_text(channel.size_x_m), length_text(channel.size_y_m), channel.missing,
        value(channel.min), value(channel.max), value(channel.mean), value(channel.rms));
    for (const std::string& warning : channel.warnings) {
      text += fmt::format("    note: {}\n", warning);
    }
    if (shortest) continue;
    text += fmt::format("    pixel {} x {}, unit in the file: {}\n", pitch_text(channel.pitch_x_m),
                        pitch_text(channel.pitch_y_m),
                        channel.file_unit.empty() ? "none" : channel.file_unit);
    if (channel.offset_x != 0 || channel.offset_y != 0) {
      text += fmt::format("    first pixel at column {}, row {} of the camera\n", channel.offset_x,
                          channel.offset_y);
    }
    for (const auto& [name, setting] : channel.settings) {
      text += fmt::format("    {}: {}\n", name, setting);
    }
  }
  return text;
}

}  // namespace

void add_inspect(Program& program) {
  struct Args {
    std::vector<std::filesystem::path> files;
    std::filesystem::path preview;
    io::ReadOptions reading;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command("inspect", "Tell what map files hold");
  command.positional("files", args->files, "map files");
  command.option("--preview", args->preview,
                 "draw the map as PNG: viridis, missing pixels grey (one map file)", false);
  command.options(args->reading, "Reading");
  command.action([args](const Context& context) {
    constexpr int kLongestSide = 512, kTerminalColumns = 48;
    if (!args->preview.empty() && args->files.size() != 1) {
      throw InputError("--preview", fmt::format("is given with {} map files", args->files.size()),
                       "Draw one map at a time");
    }
    const bool on_terminal = isatty(STDOUT_FILENO) == 1 && !context.quiet && !context.json;
    json list = json::array();
    std::string text;
    for (const auto& file : args->files) {
      const io::MapInspection map = io::inspect_map(file, args->reading);
      if (context.json) {
        list.push_back(io::summary_json(map.summary));
      } else {
        text += to_text(map.summary, context.quiet);
      }
      if (on_terminal)
        text += io::terminal_text(io::picture_of(map.grid, map.shown, kTerminalColumns));
      if (!args->preview.empty()) {
        io::write_png(args->preview, io::picture_of(map.grid, map.shown, kLongestSide));
      }
    }
    print(context.json ? list.dump(2) + "\n" : text);
  });
}

}  // namespace manoscope::cli
