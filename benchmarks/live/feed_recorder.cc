// feed_recorder FOLDER WIDTH HEIGHT RATE_HZ
//
// Hands numbered pictures of two cameras to the recorder, in real time and until it is killed, as
// `softforce record` does with those of live cameras. Picture n is taken at n / RATE on the
// computer's clock: a recording shows what the recorder, and nothing before it, loses.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "softforce/vision/recorder.h"
#include "support/bar_code.h"

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const cv::Size size(std::atoi(argv[2]), std::atoi(argv[3]));
  const double rate = std::atof(argv[4]);
  softforce::vision::Recorder recorder(argv[1], {"left", "right"});
  cv::Mat ground(size, CV_8UC1);
  cv::RNG random(1);
  random.fill(ground, cv::RNG::NORMAL, 128, 3);  // grey levels, as a sensor's noise
  const auto now_s = [] {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  int64_t n = 0, first = -1;
  for (int frame = 0;; ++frame) {
    n = std::max(n + 1, static_cast<int64_t>(std::floor(now_s() * rate)) + 1);
    if (first < 0) first = n;
    std::this_thread::sleep_for(
        std::chrono::duration<double>(static_cast<double>(n) / rate - now_s()));
    softforce::vision::FrameSet set;
    set.frame = frame;
    set.time_s = static_cast<double>(n - first) / rate;
    for (int camera = 0; camera < 2; ++camera) {
      set.pictures.push_back(ground.clone());
      softforce::testing::PaintNumber(static_cast<uint32_t>(n & 0xFFFFFF), &set.pictures.back());
    }
    recorder.Add(set);
  }
}
