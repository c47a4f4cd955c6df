#include "softforce/base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace softforce::base {
namespace {

constexpr std::chrono::milliseconds kTerminalInterval(100);
constexpr std::chrono::seconds kLogInterval(10);  // only where no tenth can be counted
constexpr std::chrono::seconds kRateInterval(3);  // the rate shown is of the last one or two
constexpr int kBar = 24;                          // characters

double Rate(int done, std::chrono::steady_clock::duration time) {
  const double seconds = std::chrono::duration<double>(time).count();
  return seconds > 0 ? done / seconds : 0;
}

std::string TimeLeft(double seconds) {
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

std::string ProgressLine(const std::string& label, int done, int total, double per_second, int bar,
                         const std::string& note) {
  std::string line = label;
  if (total > 0 && bar > 0) {
    const auto full = static_cast<size_t>(std::clamp<long long>(1LL * bar * done / total, 0, bar));
    line += " [" + std::string(full, '=') + std::string(bar - full, ' ') + "]";
  }
  line += fmt::format(": {}", done);
  if (total > 0) line += fmt::format(" of {} ({} %)", total, 100LL * done / total);
  if (done > 0 && per_second > 0) {
    line += fmt::format(", {:.1f} per second", per_second);
    if (done < total) line += fmt::format(", {} left", TimeLeft((total - done) / per_second));
  }
  return note.empty() ? line : line + ", " + note;
}

void TellBesideProgress(const std::string& message) {
  fmt::print(stderr, "{}{}\n", isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "", message);
}

Progress::Progress(std::string label, int total)
    : label_(std::move(label)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) == 1),
      last_shown_(Clock::now()),
      start_{last_shown_, 0},
      older_(start_),
      newer_(start_) {}

bool Progress::Due(Clock::time_point now, int done) {
  if (terminal_) return now - last_shown_ >= kTerminalInterval;
  if (total_ <= 0) return now - last_shown_ >= kLogInterval;
  const int tenth = static_cast<int>(10LL * done / total_);
  return std::exchange(last_shown_tenth_, tenth) != tenth;
}

void Progress::Update(int done, const std::string& note) {
  done_ = done;
  const Clock::time_point now = Clock::now();
  if (!Due(now, done)) return;
  last_shown_ = now;
  const double rate = Rate(done - older_.done, now - older_.time);
  if (now - newer_.time > kRateInterval) older_ = std::exchange(newer_, Mark{now, done});
  const std::string line = ProgressLine(label_, done, total_, rate, terminal_ ? kBar : 0, note);
  // "\033[K" erases what a longer line left behind.
  fmt::print(stderr, terminal_ ? "\r{}\033[K" : "{}\n", line);
  std::fflush(stderr);
}

void Progress::Finish() {
  if (finished_) return;
  finished_ = true;
  const std::string line = ProgressLine(
      label_, done_, total_, Rate(done_, Clock::now() - start_.time), terminal_ ? kBar : 0);
  if (terminal_) {
    fmt::print(stderr, "\r{}\033[K\n", line);
  } else if (total_ <= 0 || done_ < total_) {  // otherwise the last tenth has told it
    fmt::print(stderr, "{}\n", line);
  }
}

}  // namespace softforce::base
