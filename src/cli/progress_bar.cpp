#include "progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>

#include "screen.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

constexpr char kWipe[] = "\r\033[K";

/// What a signal handler may read: whether the line is there.
volatile std::sig_atomic_t line_stands = 0;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// "12 s left", "3 min left".
std::string left_text(double seconds_left) {
  constexpr double kMinute = 60.0, kHour = 3600.0;
  if (seconds_left < 1.5 * kMinute) return fmt::format("{:.0f} s left", std::ceil(seconds_left));
  if (seconds_left < 1.5 * kHour) {
    return fmt::format("{:.0f} min left", std::ceil(seconds_left / kMinute));
  }
  return fmt::format("{:.0f} h left", std::ceil(seconds_left / kHour));
}

/// The first characters of a text, whole ones.
std::string first_of(const std::string& text, std::size_t width) {
  std::size_t end = text.size();
  while (shown_width(text.substr(0, end)) > width) --end;
  return text.substr(0, end);
}

}  // namespace

const Progress& ProgressTrack::report(std::string_view stage, double share, double now) {
  const double told = std::clamp(share, 0.0, 1.0);
  if (progress_.stage != stage) {
    progress_ = {std::string(stage), told, {}};
    first_share_ = told;
    first_time_ = now;
    return progress_;
  }
  progress_.share = std::max(progress_.share, told);
  constexpr double kSoonest = 1.0;
  const double gained = progress_.share - first_share_, spent = now - first_time_;
  if (gained > 0.0 && spent >= kSoonest) {
    progress_.seconds_left = spent * (1.0 - progress_.share) / gained;
  }
  return progress_;
}

std::string progress_text(const Progress& progress, int columns) {
  constexpr std::size_t kStage = 24, kBar = 30, kLeastBar = 5, kPercent = 7, kTime = 13;
  constexpr double kRounding = 1e-9;  // 29 of 100 are 29 %
  // The last column stays free: some terminals break the line as soon as it is full.
  const std::size_t width = columns > 1 ? static_cast<std::size_t>(columns - 1) : 0;
  if (!(progress.share > 0.0)) return first_of(progress.stage + " ...", width);
  std::string text = progress.stage;
  const std::size_t named = std::max(kStage, shown_width(text));
  const bool timed = width >= named + kPercent + kTime;
  const std::size_t taken = named + kPercent + (timed ? kTime : 0) + 3;  // a blank, two brackets
  if (width >= taken + kLeastBar) {
    const std::size_t bar = std::min(kBar, width - taken);
    const auto filled =
        static_cast<std::size_t>(progress.share * static_cast<double>(bar) + kRounding);
    text += std::string(named - shown_width(text) + 1, ' ') + '[' + std::string(filled, '#') +
            std::string(bar - filled, '.') + ']';
  }
  const std::string percent =
      fmt::format("  {:3.0f} %", std::floor(100.0 * progress.share + kRounding));
  text = first_of(text, width - std::min(width, kPercent)) + percent;
  if (timed && progress.seconds_left && progress.share < 1.0) {
    text += "  " + left_text(*progress.seconds_left);
  }
  return first_of(text, width);
}

void ProgressBar::show(std::string_view stage, double share) {
  const std::scoped_lock guard(mutex_);
  const Progress& progress = track_.report(stage, share, seconds());
  const std::string text = progress_text(progress, screen_of(STDERR_FILENO).columns);
  if (text == shown_) return;
  line_stands = 1;
  fmt::print(stderr, "\r{}\033[K", text);
  std::fflush(stderr);
  shown_ = text;
}

void ProgressBar::clear() {
  const std::scoped_lock guard(mutex_);
  if (shown_.empty()) return;
  std::fputs(kWipe, stderr);
  std::fflush(stderr);
  shown_.clear();
  line_stands = 0;
}

void ProgressBar::clear_at_signal() noexcept {
  if (line_stands == 0) return;
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kWipe, sizeof kWipe - 1);
}

}  // namespace manoscope::cli
