// manoscope serve [FOLDER]: the local app.
#include "manoscope/serve/server.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/serve/browser.hpp"

namespace manoscope::cli {
namespace {

int port_from(const std::string& text) {
  constexpr double kLargest = 65535.0;
  const auto number = parse_number(text);
  if (number && *number >= 0.0 && *number <= kLargest && *number == static_cast<int>(*number)) {
    return static_cast<int>(*number);
  }
  throw InputError("--port", fmt::format("\"{}\" is no port", text),
                   "Give a whole number up to 65535; 0 = any that is free");
}

}  // namespace

void add_serve(Program& program) {
  struct Args {
    std::string folder = ".", port;
    bool no_browser = false;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command("serve", "The app: edit, measure, compare in a browser");
  command.optional_positional("folder", args->folder, "folder of experiments; the present one");
  command.option(
      "--port", args->port,
      "port of this machine to listen at; 0 = any that is free; without, the folder's own", false);
  command.flag("--no-browser", args->no_browser, "open no browser");
  command.action([args](const Context& context) {
    serve::ServerOptions options;
    options.folder = args->folder;
    if (!args->port.empty()) options.port = port_from(args->port);
    options.program = std::filesystem::read_symlink("/proc/self/exe").string();
    serve::Server server(options);
    const std::string url = server.url();
    print(context.json ? nlohmann::json{{"url", url}, {"port", server.port()}}.dump() + "\n"
                       : url + "\n");
    remark(context, "This address works once, in one browser, on this machine. Ctrl-C ends.");
    if (!args->no_browser && !context.json && isatty(STDOUT_FILENO) == 1) serve::open_browser(url);
    server.run(context.monitor);
  });
}

}  // namespace manoscope::cli
