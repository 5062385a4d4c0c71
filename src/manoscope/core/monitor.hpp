#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace manoscope {

/// How long work speaks to whoever started it. Both members may be empty.
///
/// The library itself never prints: the command line shows progress on a terminal, a server sends
/// it on. Both functions may be called from several threads, one at a time is not promised.
struct Monitor {
  /// Stage name and the done fraction in [0, 1].
  std::function<void(std::string_view stage, double fraction)> progress;
  /// True once the user asked to stop.
  std::function<bool()> stop_requested;

  void report(std::string_view stage, double fraction) const {
    if (progress) progress(stage, fraction);
  }
  /// @throws Interrupted if the user asked to stop.
  void checkpoint() const;
};

}  // namespace manoscope
