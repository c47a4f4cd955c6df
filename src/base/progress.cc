#include "softforce/base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace softforce::base {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTerminalInterval(100);
constexpr std::chrono::seconds kLogInterval(10);  // only where no tenth can be counted

double Seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

std::string Line(const std::string& label, int done, int total, double elapsed_s) {
  std::string line = fmt::format("{}: {}", label, done);
  if (total > 0) line += fmt::format(" of {} ({} %)", total, 100LL * done / total);
  if (done > 0 && elapsed_s > 0) {
    line += fmt::format(", {:.1f} per second", done / elapsed_s);
    if (done < total) line += fmt::format(", {:.0f} s left", elapsed_s * (total - done) / done);
  }
  return line;
}

}  // namespace

Progress::Progress(std::string label, int total)
    : label_(std::move(label)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      last_shown_(start_) {}

void Progress::Update(int done) {
  done_ = done;
  const Clock::time_point now = Clock::now();
  const int tenth = total_ > 0 ? static_cast<int>(10LL * done / total_) : -1;
  if (terminal_ ? now - last_shown_ < kTerminalInterval
                : (total_ > 0 ? tenth == last_shown_tenth_ : now - last_shown_ < kLogInterval)) {
    return;
  }
  last_shown_ = now;
  last_shown_tenth_ = tenth;
  const std::string line = Line(label_, done, total_, Seconds(now - start_));
  // "\033[K" erases what a longer line left behind.
  fmt::print(stderr, terminal_ ? "\r{}\033[K" : "{}\n", line);
  std::fflush(stderr);
}

void Progress::Finish() {
  if (finished_) return;
  finished_ = true;
  const std::string line = Line(label_, done_, total_, Seconds(Clock::now() - start_));
  if (terminal_) {
    fmt::print(stderr, "\r{}\033[K\n", line);
  } else if (total_ <= 0 || done_ < total_) {  // otherwise the last tenth has told it
    fmt::print(stderr, "{}\n", line);
  }
}

}  // namespace softforce::base
