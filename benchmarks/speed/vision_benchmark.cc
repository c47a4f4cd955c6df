// Cost of detection on a picture of the shipped recording (1280×1024, 14 dots, 4 tags), beside the
// yardstick: one OpenCV Gaussian blur of the same picture. Compare ratios, not milliseconds.
//
//   build/release/benchmarks/vision_benchmark
#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "softforce/vision/dots.h"
#include "softforce/vision/tags.h"

namespace softforce {
namespace {

cv::Mat Picture() {
  cv::VideoCapture video(std::string(SOFTFORCE_SOURCE_DIR) + "/datasets/sheet_two_weights/left.mp4",
                         cv::CAP_FFMPEG);
  cv::Mat picture, grey;
  video.read(picture);
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

void YardstickBlur(benchmark::State& state) {
  const cv::Mat picture = Picture();
  cv::Mat blurred;
  for (auto _ : state) cv::GaussianBlur(picture, blurred, {7, 7}, 1.5);
}

void Dots(benchmark::State& state) {
  const cv::Mat picture = Picture();
  for (auto _ : state) benchmark::DoNotOptimize(vision::DetectDots(picture).size());
}

void Tags(benchmark::State& state) {
  const cv::Mat picture = Picture();
  const vision::TagDetector detector("tag36h11");
  for (auto _ : state) benchmark::DoNotOptimize(detector.Detect(picture).size());
}

BENCHMARK(YardstickBlur)->Unit(benchmark::kMillisecond);
BENCHMARK(Dots)->Unit(benchmark::kMillisecond);
BENCHMARK(Tags)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace softforce

BENCHMARK_MAIN();
