// Cost of the overlay over one picture of 1280×1024 and of a finished run's whole overlay video,
// beside the yardstick: one OpenCV Gaussian blur of the same picture. Compare ratios, and where the
// machine is busy the processor's time (cpu_ms), which counts all threads of the program.
//
//   build/release/benchmarks/render_benchmark
//
// The robot is measured if the recordings lie in ../shared beside the project.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <map>
#include <opencv2/imgproc.hpp>

#include "pipeline/frame_file.h"
#include "pipeline/open_recording.h"
#include "pipeline/overlay_video.h"
#include "softforce/pipeline/render.h"
#include "softforce/pipeline/run.h"
#include "softforce/scene/rig_file.h"
#include "softforce/scene/scene.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;

const Folder kSource = SOFTFORCE_SOURCE_DIR;
const Folder kSheet = kSource / "datasets/sheet_two_weights/scene.yaml";
const Folder kRobot = kSource / "../shared/recordings/robot_tip_weight/scene.yaml";
constexpr int kFullWidth = 2560;  // px: both pictures in the size of the cameras

// A run on a recording, its files in a folder that goes with it.
class Result {
 public:
  explicit Result(const Folder& scene)
      : folder_(std::filesystem::temp_directory_path() /
                fmt::format("softforce_render_benchmark_{}_{}", getpid(),
                            scene.parent_path().filename().string())) {
    pipeline::RunOptions options;
    options.out = folder_;
    options.overlay = options.report = options.show_progress = false;
    pipeline::Run(scene, options);
  }
  ~Result() { std::filesystem::remove_all(folder_); }
  Result(const Result&) = delete;
  Result& operator=(const Result&) = delete;

  const Folder& folder() const { return folder_; }

 private:
  Folder folder_;
};

const Result& ResultOf(const Folder& scene) {
  static std::map<Folder, Result> results;
  return results.try_emplace(scene, scene).first->second;
}

// The last frame of a result, with the pictures, and what draws it.
struct Drawable {
  scene::Scene scene;
  camera::Rig rig;
  pipeline::World world;
  pipeline::FrameInWork frame;

  explicit Drawable(const Folder& scene_file)
      : scene(scene::LoadScene(scene_file)),
        rig(scene::LoadRig(scene.cameras.rig)),
        world(pipeline::BuildWorld(scene)) {
    pipeline::FrameFileReader frames(ResultOf(scene_file).folder() / pipeline::kFrameFile,
                                     world.mesh().num_nodes());
    vision::Recording recording =
        pipeline::OpenRecording(scene, rig, pipeline::SourcesOf(scene, {}), 0, scene_file.string());
    while (auto next = frames.Next()) {
      frame = std::move(*next);
      frame.set = *recording.Next();
    }
  }
};

// Of all threads.
double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

bool IsThere(benchmark::State* state, const Folder& scene) {
  const bool there = std::filesystem::exists(scene);
  if (!there) state->SkipWithError("the recording is not there");
  return there;
}

void YardstickBlur(benchmark::State& state) {
  const Drawable sheet(kSheet);
  cv::setNumThreads(1);
  cv::Mat blurred;
  for (auto _ : state) {
    cv::GaussianBlur(sheet.frame.set.pictures[0], blurred, {7, 7}, 1.5);
  }
}

// The pictures of both cameras, `state.range(0)` px wide together; times are of one picture.
void OverlayOf(benchmark::State& state, const Folder& scene, const std::string& layers) {
  if (!IsThere(&state, scene)) return;
  const Drawable drawable(scene);
  pipeline::OverlayVideo overlay({}, drawable.scene, drawable.world, drawable.rig,
                                 static_cast<int>(state.range(0)),
                                 pipeline::ParseOverlayLayers(layers, "layers"));
  cv::setNumThreads(1);
  const double start_s = CpuSeconds();
  for (auto _ : state) benchmark::DoNotOptimize(overlay.Draw(drawable.frame).data);
  const auto pictures = static_cast<double>(drawable.rig.cameras.size() * state.iterations());
  state.counters["cpu_ms"] = 1e3 * (CpuSeconds() - start_s) / pictures;
  state.counters["pictures_per_s"] = benchmark::Counter(pictures, benchmark::Counter::kIsRate);
}

// `softforce render` of the whole run, times of its frames without what comes before the first.
void Render(benchmark::State& state, const Folder& scene) {
  if (!IsThere(&state, scene)) return;
  const Result& result = ResultOf(scene);
  pipeline::RenderOptions options;
  options.overlay_width = static_cast<int>(state.range(0));
  options.show_progress = false;
  double frames = 0, seconds = 0, cpu_s = 0;
  for (auto _ : state) {
    const pipeline::RenderReport report = pipeline::Render(result.folder(), options);
    frames += report.frames;
    seconds += report.seconds;
    cpu_s += report.cpu_seconds;
  }
  state.counters["cpu_ms_per_frame"] = 1e3 * cpu_s / frames;
  state.counters["frames_per_s"] = frames / seconds;
}

BENCHMARK(YardstickBlur)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(OverlayOf, sheet, kSheet, "all")
    ->Arg(kFullWidth)
    ->Arg(1920)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(OverlayOf, robot, kRobot, "all")
    ->Arg(kFullWidth)
    ->Arg(1920)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(OverlayOf, sheet_of_nothing, kSheet, "none")
    ->Arg(kFullWidth)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Render, sheet, kSheet)->Arg(kFullWidth)->Arg(1920)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Render, robot, kRobot)->Arg(kFullWidth)->Arg(1920)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace softforce

BENCHMARK_MAIN();
