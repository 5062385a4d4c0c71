// manoscope formats: the readers.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "manoscope/io/reader.hpp"

namespace manoscope::cli {

void add_formats(Program& program) {
  Command command = program.command("formats", "List the file formats that can be read");
  command.action([](const Context& context) {
    nlohmann::json list = nlohmann::json::array();
    std::string text;
    for (const io::Reader* reader : io::readers()) {
      if (context.json) {
        list.push_back({{"name", reader->name()},
                        {"description", reader->description()},
                        {"extensions", reader->extensions()},
                        {"orientation", reader->orientation()}});
      } else {
        text += fmt::format("{:<15} {:<26} {}\n", reader->name(),
                            fmt::format("{}", fmt::join(reader->extensions(), " ")),
                            reader->description());
      }
    }
    if (!context.quiet) {
      text += "\nOther formats are read through the program Gwyddion, where it is installed.\n";
    }
    print(context.json ? list.dump(2) + "\n" : text);
  });
}

}  // namespace manoscope::cli
