#include "manoscope/serve/browser.hpp"

#include <cstdlib>

#include "manoscope/core/child_process.hpp"

namespace manoscope::serve {

bool open_browser(const std::string& url) {
  const auto is_set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) return false;
  ChildProcess::Options options;
  options.wall_seconds = 10.0;
  auto opener = ChildProcess::start({"xdg-open", url}, options);
  return opener && opener->wait().succeeded();
}

}  // namespace manoscope::serve
