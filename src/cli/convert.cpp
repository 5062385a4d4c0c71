// manoscope convert IN OUT: a map in another format, by OUT's name.
#include <fmt/format.h>

#include "commands.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::cli {

void add_convert(Program& program) {
  struct Args {
    std::filesystem::path in, out;
    io::ReadOptions reading;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command("convert", "Write a map in another format, by OUT's name");
  command.positional("in", args->in, "map file");
  command.positional("out", args->out, "file to write: .gsf, .nc, .csv or .txt");
  command.options(args->reading, "Reading");
  command.action([args](const Context& context) {
    const HeightMap map = io::read_height_map(args->in, args->reading);
    io::write_map(args->out, map, args->in.filename().string());
    remark(context, fmt::format("wrote {}", args->out.string()));
  });
}

}  // namespace manoscope::cli
