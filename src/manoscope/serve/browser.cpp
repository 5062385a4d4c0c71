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
  if (!find_program("xdg-open")) return false;
  // The shell ends at once and leaves the opener behind, which may be the browser itself.
  auto shell = ChildProcess::start(
      {"/bin/sh", "-c", "setsid xdg-open \"$1\" </dev/null >/dev/null 2>&1 &", "sh", url}, {});
  return shell && shell->wait().succeeded();
}

}  // namespace manoscope::serve
