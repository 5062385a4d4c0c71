#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace manoscope::cli {

/// Where the work stands.
struct Progress {
  std::string stage;
  double share = 0.0;                  ///< of the stage, in [0, 1]; 0: it does not tell
  std::optional<double> seconds_left;  ///< of the stage, once that can be told
};

/// Follows the stages by what they report, in whatever order their threads do: within a stage the
/// share never falls.
class ProgressTrack {
 public:
  /// @param now  s, on a clock that does not run back.
  ///
  /// The time left is that of the shares so far:
  ///
  ///   left = (now - first) (1 - share) / (share - share at first)
  ///
  /// from the first report of the stage on, told from its second second.
  const Progress& report(std::string_view stage, double share, double now);

 private:
  Progress progress_;
  double first_share_ = 0.0, first_time_ = 0.0;
};

/// "reducing maps             [#########.....................]  30 %  12 s left": stage, bar, share
/// and time left in fewer than `columns` characters. A narrow screen loses the time, then the bar,
/// then the end of the stage's name. A stage that does not tell its share has neither bar nor
/// share.
std::string progress_text(const Progress& progress, int columns);

/// The progress of the work on the last line of standard error, a terminal that knows codes.
class ProgressBar {
 public:
  /// From any thread.
  void show(std::string_view stage, double share);
  /// Takes the line away.
  void clear();
  /// The same from within a signal handler, for a program that ends there.
  static void clear_at_signal() noexcept;

 private:
  std::mutex mutex_;
  ProgressTrack track_;
  std::string shown_;  ///< "": nothing
};

}  // namespace manoscope::cli
