// Cost of allocating 60 dots in 4 cameras, a third of them hidden and a fifth as many false ones,
// beside the yardstick: one OpenCV Gaussian blur of the four pictures. Compare ratios, not
// milliseconds.
//
//   build/release/benchmarks/allocation_benchmark
#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "softforce/allocation/allocate_jointly.h"

namespace softforce {
namespace {

constexpr int kCameras = 4, kColumns = 10, kRows = 6, kShared = 12;

struct Problem {
  std::vector<allocation::JointPrediction> predictions;
  allocation::Belief prior{Eigen::VectorXd::Zero(kShared),
                           Eigen::MatrixXd::Identity(kShared, kShared)};
  std::vector<std::vector<allocation::DetectedPixel>> detections;
};

// A patch of dots 30 px apart that bends smoothly in 12 ways. `motion`: px, of the dot that moves
// most (standard deviation of what may happen, and one draw of it).
Problem MakeProblem(double motion) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Problem problem;
  const Eigen::VectorXd delta =
      Eigen::VectorXd::NullaryExpr(kShared, [&] { return 0.5 * normal(random); });
  problem.detections.resize(kCameras);
  for (int c = 0; c < kCameras; ++c) {
    for (int m = 0; m < kColumns * kRows; ++m) {
      const double x = m % kColumns / (kColumns - 1.0), y = m / kColumns / (kRows - 1.0);
      allocation::JointPrediction p;
      p.camera = c;
      p.pixel = {400 + 30.0 * (m % kColumns), 300 + 30.0 * (m / kColumns)};
      p.covariance = Eigen::Matrix2d::Identity();
      p.H.resize(2, kShared);
      for (int k = 0; k < kShared; ++k) {
        const double amplitude = motion / std::sqrt(kShared) * std::pow(x, 1 + k % 3);
        const double turn = c + 0.7 * k + 0.5 * y * (k % 4);
        p.H.col(k) = amplitude * Eigen::Vector2d(std::cos(turn), std::sin(turn));
      }
      problem.predictions.push_back(p);
      if (uniform(random) < 1.0 / 3) continue;
      problem.detections[c].push_back(
          {p.pixel + p.H * delta + 0.3 * Eigen::Vector2d(normal(random), normal(random)),
           0.0025 * Eigen::Matrix2d::Identity()});
    }
    for (int i = 0; i < 8; ++i) {
      problem.detections[c].push_back({{380 + 320 * uniform(random), 280 + 200 * uniform(random)},
                                       0.0025 * Eigen::Matrix2d::Identity()});
    }
  }
  return problem;
}

void YardstickBlurOfFour(benchmark::State& state) {
  cv::Mat picture(1024, 1280, CV_8U), blurred;
  cv::randu(picture, 0, 255);
  for (auto _ : state) {
    for (int c = 0; c < kCameras; ++c) cv::GaussianBlur(picture, blurred, {7, 7}, 1.5);
  }
}

void Allocate(benchmark::State& state) {
  const Problem problem = MakeProblem(static_cast<double>(state.range(0)));
  int seen = 0;
  for (auto _ : state) {
    const auto found =
        allocation::AllocateJointly(problem.predictions, problem.prior, problem.detections);
    seen = 0;
    for (const auto& pixel : found.pixels) seen += pixel.detection >= 0 ? 1 : 0;
  }
  state.counters["seen"] = seen;
}

BENCHMARK(YardstickBlurOfFour)->Unit(benchmark::kMillisecond);
BENCHMARK(Allocate)->ArgName("motion_px")->Arg(5)->Arg(15)->Arg(45)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace softforce

BENCHMARK_MAIN();
