// manoscope convert IN OUT: a map in another format, by OUT's name.
#include <fmt/format.h>

#include "commands.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/map_address.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::cli {

void add_convert(Program& program) {
  struct Args {
    std::filesystem::path in, out;
    bool all = false;
    io::ReadOptions reading;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command("convert", "Write a map in another format, by OUT's name");
  command.positional("in", args->in, "map file, or FILE#N for the Nth page, frame or channel");
  command.positional("out", args->out, "file to write: " + io::written_formats());
  command.flag("--all", args->all,
               "write every page, frame or height channel: OUT with its number, as map-3.gsf");
  command.options(args->reading, "Reading");
  command.action([args](const Context& context) {
    const std::string title = args->in.filename().string();
    const auto tell = [&](const std::filesystem::path& path, const io::LoadedMap& loaded) {
      for (const std::string& warning : loaded.warnings) remark(context, "note: " + warning);
      remark(context, fmt::format("wrote {}", path.string()));
    };
    std::error_code none;
    if (std::filesystem::equivalent(io::map_address(args->in).file, args->out, none)) {
      throw InputError(args->out.string(), "is the file that is read", "Choose another name");
    }
    if (!args->all) {
      const io::LoadedMap loaded = io::load_height_map(args->in, args->reading);
      io::write_map(args->out, loaded.map, title);
      tell(args->out, loaded);
      return;
    }
    const auto maps = io::load_height_maps(args->in, args->reading);
    for (const auto& [page, loaded] : maps) {
      context.monitor.checkpoint();
      const auto path = io::numbered(args->out, page, maps.back().first);
      io::write_map(path, loaded.map, fmt::format("{}#{}", title, page));
      tell(path, loaded);
    }
  });
}

}  // namespace manoscope::cli
