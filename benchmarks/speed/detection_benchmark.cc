// Pairs of pictures per second from decoded stereo pictures to detections, as a run detects: the
// cameras side by side on two threads, markers near where they should be.
// Beside them the yardstick: one OpenCV Gaussian blur of the same pictures, spread over the same
// threads. Each row gives `pairs/s` and `blurs`, how many yardsticks a pair costs. Scenes:
//   recording: the shipped recordings (1280×1024, 14 dots; 14 tags and 4 fiducials), H.264;
//   crowded:   60 dots, or 24 tags, over the noise of a textured ground;
//   one lost:  the recording's tags, of which one is painted over after the first picture.
//
//   build/release/benchmarks/detection_benchmark
#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "softforce/vision/dot_follower.h"
#include "softforce/vision/dots.h"
#include "softforce/vision/tag_cells.h"
#include "softforce/vision/tag_follower.h"

namespace softforce {
namespace {

using Pair = std::vector<cv::Mat>;
using Clock = std::chrono::steady_clock;

constexpr int kPairs = 30;

std::vector<Pair> ReadRecording(const std::string& name) {
  std::vector<Pair> pairs(kPairs, Pair(2));
  const auto folder = std::filesystem::path(SOFTFORCE_SOURCE_DIR) / "../shared/recordings" / name;
  for (int c = 0; c < 2; ++c) {
    cv::VideoCapture video((folder / (c == 0 ? "left.mp4" : "right.mp4")).string(), cv::CAP_FFMPEG);
    for (Pair& pair : pairs) {
      cv::Mat picture;
      if (!video.read(picture)) return {};
      cv::cvtColor(picture, pair[c], cv::COLOR_BGR2GRAY);
    }
  }
  return pairs;
}

// A ground of noise on all scales, on which many things look a little like a marker.
cv::Mat Ground(cv::RNG* random) {
  cv::Mat1f ground(1024, 1280, 90.0f);
  for (const int grain : {4, 16, 64}) {
    cv::Mat1f coarse(1024 / grain, 1280 / grain), fine;
    random->fill(coarse, cv::RNG::NORMAL, 0, 4);
    cv::resize(coarse, fine, ground.size(), 0, 0, cv::INTER_CUBIC);
    ground += fine;
  }
  cv::Mat grey;
  ground.convertTo(grey, CV_8U);
  return grey;
}

// Markers on a grid that moves to and fro, by 3 px from picture to picture, so that the last
// picture leads on to the first.
std::vector<Pair> PaintCrowd(bool tags) {
  cv::RNG random(5);
  const cv::Mat ground = Ground(&random);
  const int across = tags ? 6 : 10, down = tags ? 4 : 6;
  std::vector<Pair> pairs;
  for (int i = 0; i < kPairs; ++i) {
    const int step = std::min(i, kPairs - i);
    Pair pair;
    for (int c = 0; c < 2; ++c) {
      cv::Mat grey = ground.clone();
      for (int k = 0; k < across * down; ++k) {
        const cv::Point at(120 + 1000 * (k % across) / across + 3 * step + 20 * c,
                           120 + 800 * (k / across) / down);
        if (tags) {
          const vision::TagCells tag = vision::DrawTag("tag36h11", k);
          cv::Mat cells;
          cv::resize(tag.cells, cells, {60, 60}, 0, 0, cv::INTER_NEAREST);
          cells.copyTo(grey(cv::Rect(at, cells.size())));
        } else {
          cv::circle(grey, at, 10, 230, cv::FILLED, cv::LINE_AA);
        }
      }
      cv::GaussianBlur(grey, grey, {}, 0.7);
      cv::Mat1f noisy;
      grey.convertTo(noisy, CV_32F);
      cv::Mat1f noise(noisy.size());
      random.fill(noise, cv::RNG::NORMAL, 0, 2);
      noisy += noise;
      noisy.convertTo(grey, CV_8U);
      pair.push_back(grey);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

// Seconds that one yardstick takes for a pair.
template <typename Work>
double TimePair(const std::vector<Pair>& pairs, const Work& work) {
  const auto start = Clock::now();
  for (const Pair& pair : pairs) {
    tbb::parallel_for(0, 2, [&](int c) { work(c, pair[c]); });
  }
  return std::chrono::duration<double>(Clock::now() - start).count() /
         static_cast<double>(pairs.size());
}

void Report(benchmark::State* state, const std::vector<Pair>& pairs, double seconds, long found) {
  std::vector<cv::Mat> blurred(2);
  double yardstick = 0;
  constexpr int kRounds = 3;
  for (int i = 0; i < kRounds; ++i) {
    yardstick += TimePair(pairs,
                          [&](int c, const cv::Mat& grey) {
                            cv::GaussianBlur(grey, blurred[c], {7, 7}, 1.5);
                          }) /
                 kRounds;
  }
  const double all = static_cast<double>(state->iterations()) * kPairs;
  state->counters["pairs/s"] = all / seconds;
  state->counters["blurs"] = seconds / all / yardstick;
  state->counters["yardstick_ms"] = 1e3 * yardstick;
  state->counters["found"] = static_cast<double>(found) / (2 * all);  // per picture
}

void Dots(benchmark::State& state, const std::vector<Pair>& pairs) {
  if (pairs.empty()) return state.SkipWithError("the recordings are not beside the project");
  std::vector<vision::DotFollower> followers(2);
  double seconds = 0;
  long found[2] = {0, 0};
  for (auto _ : state) {
    seconds += kPairs * TimePair(pairs, [&](int c, const cv::Mat& grey) {
                 found[c] += static_cast<long>(followers[c].Detect(grey).size());
               });
  }
  Report(&state, pairs, seconds, found[0] + found[1]);
  state.counters["whole"] = static_cast<double>(followers[0].whole_searches()) /
                            (static_cast<double>(state.iterations()) * kPairs);
}

// The whole picture every time, as without prediction.
void DotsWithoutPrediction(benchmark::State& state, const std::vector<Pair>& pairs) {
  if (pairs.empty()) return state.SkipWithError("the recordings are not beside the project");
  double seconds = 0;
  long found[2] = {0, 0};
  for (auto _ : state) {
    seconds += kPairs * TimePair(pairs, [&](int c, const cv::Mat& grey) {
                 found[c] += static_cast<long>(vision::DetectDots(grey).size());
               });
  }
  Report(&state, pairs, seconds, found[0] + found[1]);
}

void Tags(benchmark::State& state, const std::vector<Pair>& pairs) {
  if (pairs.empty()) return state.SkipWithError("the recordings are not beside the project");
  std::vector<vision::TagDetector> detectors;
  for (int c = 0; c < 2; ++c) detectors.emplace_back("tag36h11");
  std::vector<vision::TagFollower> followers(2);
  for (int c = 0; c < 2; ++c) followers[c].Detect(detectors[c], pairs[0][c]);  // the start
  double seconds = 0;
  long found[2] = {0, 0};
  for (auto _ : state) {
    seconds += kPairs * TimePair(pairs, [&](int c, const cv::Mat& grey) {
                 found[c] += static_cast<long>(followers[c].Detect(detectors[c], grey).size());
               });
  }
  Report(&state, pairs, seconds, found[0] + found[1]);
  state.counters["whole"] = static_cast<double>(followers[0].whole_searches()) /
                            (static_cast<double>(state.iterations()) * kPairs);
}

// The whole picture every time, as without prediction.
void TagsWithoutPrediction(benchmark::State& state, const std::vector<Pair>& pairs) {
  if (pairs.empty()) return state.SkipWithError("the recordings are not beside the project");
  std::vector<vision::TagDetector> detectors;
  for (int c = 0; c < 2; ++c) detectors.emplace_back("tag36h11");
  double seconds = 0;
  long found[2] = {0, 0};
  for (auto _ : state) {
    seconds += kPairs * TimePair(pairs, [&](int c, const cv::Mat& grey) {
                 found[c] += static_cast<long>(detectors[c].Detect(grey).size());
               });
  }
  Report(&state, pairs, seconds, found[0] + found[1]);
}

// All but the first picture, with the first tag painted over.
std::vector<Pair> LoseOne(std::vector<Pair> pairs) {
  const vision::TagDetector detector("tag36h11");
  for (size_t i = 1; i < pairs.size(); ++i) {
    for (cv::Mat& grey : pairs[i]) {
      grey = grey.clone();
      const std::vector<vision::Tag> tags = detector.Detect(grey);
      if (tags.empty()) continue;
      const Eigen::Vector2d middle = 0.5 * (tags[0].corners[0] + tags[0].corners[2]);
      cv::circle(grey, cv::Point(static_cast<int>(middle.x()), static_cast<int>(middle.y())), 20,
                 90, cv::FILLED);
    }
  }
  return pairs;
}

}  // namespace
}  // namespace softforce

int main(int argc, char** argv) {
  using softforce::Pair;
  benchmark::Initialize(&argc, argv);
  cv::setNumThreads(1);
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
  const std::vector<Pair> dots = softforce::ReadRecording("sheet_two_weights");
  const std::vector<Pair> tags = softforce::ReadRecording("sheet_two_weights_tags");
  const std::vector<Pair> many_dots = softforce::PaintCrowd(false);
  const std::vector<Pair> many_tags = softforce::PaintCrowd(true);
  const std::vector<Pair> lost = tags.empty() ? tags : softforce::LoseOne(tags);
  const auto add = [](const char* name, auto function, const std::vector<Pair>& pairs) {
    benchmark::RegisterBenchmark(
        name, [function, &pairs](benchmark::State& state) { function(state, pairs); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  add("dots, recording", softforce::Dots, dots);
  add("dots, crowded", softforce::Dots, many_dots);
  add("tags, recording", softforce::Tags, tags);
  add("tags, crowded", softforce::Tags, many_tags);
  add("tags, one lost", softforce::Tags, lost);
  add("dots, recording, whole picture", softforce::DotsWithoutPrediction, dots);
  add("dots, crowded, whole picture", softforce::DotsWithoutPrediction, many_dots);
  add("tags, recording, whole picture", softforce::TagsWithoutPrediction, tags);
  add("tags, crowded, whole picture", softforce::TagsWithoutPrediction, many_tags);
  benchmark::RunSpecifiedBenchmarks();
}
