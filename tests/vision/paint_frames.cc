// paint_frames WIDTH HEIGHT RATE_HZ [JITTER_MS [DROP_SHARE]]
//
// A camera for tests: raw grey pictures on standard output, in real time. Picture n is taken at
// n / RATE on the computer's clock, whoever paints it, as by cameras with a common trigger, and
// carries the number n. It is sent up to JITTER late; a share of them is left out, as is what
// nobody took in time.
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <random>
#include <thread>

#include "support/bar_code.h"

namespace {

using Clock = std::chrono::system_clock;

cv::Mat Ground(cv::Size size) {
  cv::Mat picture(size, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      picture.at<uchar>(y, x) = static_cast<uchar>(128 + 60 * std::sin(0.021 * x + 0.013 * y) +
                                                   30 * std::sin(0.17 * x - 0.11 * y));
    }
  }
  return picture;
}

bool Write(const cv::Mat& picture) {
  const uchar* at = picture.data;
  size_t left = picture.total();
  while (left > 0) {
    const ssize_t count = write(STDOUT_FILENO, at, left);
    if (count <= 0) return false;
    at += count;
    left -= static_cast<size_t>(count);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const cv::Size size(std::atoi(argv[1]), std::atoi(argv[2]));
  const double rate = std::atof(argv[3]);
  const double jitter_ms = argc > 4 ? std::atof(argv[4]) : 0;
  const double drop_share = argc > 5 ? std::atof(argv[5]) : 0;
  std::mt19937 random(static_cast<unsigned>(getpid()));
  std::uniform_real_distribution<double> uniform(0, 1);
  cv::Mat picture = Ground(size);
  const auto now_s = [] {
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  };
  int64_t n = 0;
  while (true) {
    n = std::max(n + 1, static_cast<int64_t>(std::floor(now_s() * rate)) + 1);
    std::this_thread::sleep_for(
        std::chrono::duration<double>(static_cast<double>(n) / rate - now_s()));
    if (uniform(random) < drop_share) continue;
    softforce::testing::PaintNumber(static_cast<uint32_t>(n & 0xFFFFFF), &picture);
    std::this_thread::sleep_for(std::chrono::duration<double>(1e-3 * jitter_ms * uniform(random)));
    if (!Write(picture)) return 0;
  }
}
