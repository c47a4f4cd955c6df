#include "softforce/pipeline/render.h"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "pipeline/frame_file.h"
#include "pipeline/input_files.h"
#include "pipeline/input_paths.h"
#include "pipeline/mesh_correction.h"
#include "pipeline/open_recording.h"
#include "pipeline/overlay_video.h"
#include "pipeline/refusals.h"
#include "softforce/base/input_error.h"
#include "softforce/base/progress.h"
#include "softforce/pipeline/run.h"
#include "softforce/scene/rig_file.h"
#include "softforce/scene/scene.h"

namespace softforce::pipeline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kFramesPerThread = 4;

Json ReadSummary(const fs::path& results) {
  const fs::path file = results / "summary.json";
  std::ifstream stream(file);
  if (!stream) {
    throw base::InputError(file.string(), "is not there or cannot be read",
                           "Give the folder that 'softforce run' wrote its results to (--out).");
  }
  Json summary = Json::parse(stream, nullptr, false);
  if (!summary.is_object() || !summary.contains("files") || !summary["files"].is_object() ||
      !summary["files"].contains("scene")) {
    throw base::InputError(file.string(), "does not say what the run was made from (\"files\")",
                           "It is of another program or an older version: run again.");
  }
  return summary;
}

// What was given on the command line goes first.
std::map<std::string, std::string> FindVideos(const Json& summary, const fs::path& results,
                                              const std::map<std::string, std::string>& given) {
  const Json& files = summary["files"];
  if (!files.contains("cameras")) {
    throw base::InputError(results.string(),
                           "is of a run from motion capture: there are no pictures to draw over",
                           "Look at it in ParaView: softforce run --vtu");
  }
  std::map<std::string, std::string> videos = given;
  for (const auto& [camera, kept] : files["cameras"].items()) {
    if (given.count(camera) > 0) continue;
    const std::string option = fmt::format("--camera {}=FILE", camera);
    if (kept.contains("live")) {
      throw base::InputError(
          results.string(),
          fmt::format("camera \"{}\" was live ({}), and its pictures were not recorded", camera,
                      kept.value("live", "")),
          "Run live with --record, or say where the pictures are: " + option);
    }
    videos[camera] =
        FindKeptPath(kept, results, fmt::format("video of camera \"{}\"", camera), option).string();
  }
  return videos;
}

MeshAim AimOf(const Json& summary) {
  const std::string name = summary.value("/options/mesh_aim"_json_pointer, std::string("none"));
  for (const MeshAim aim : {MeshAim::kRefined, MeshAim::kConverged}) {
    if (name == Name(aim)) return aim;
  }
  return MeshAim::kGiven;
}

// Which inputs have other bytes than in the run; a file that has another name now is another file.
std::vector<std::string> Changes(const Json& summary, const std::vector<fs::path>& inputs) {
  std::map<std::string, std::string> before;
  for (const Json& input : summary.value("inputs", Json::array())) {
    before[input.value("file", "")] = input.value("sha256", "");
  }
  std::vector<std::string> changes;
  for (const InputFile& input : DescribeInputs(inputs)) {
    const auto was = before.find(input.name);
    if (was != before.end() && was->second == input.sha256) continue;
    changes.push_back(fmt::format("{} is not what the run read", input.name));
  }
  return changes;
}

// Of all threads of the program, so far.
double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

fs::path OutFor(const fs::path& results, const RenderOptions& options) {
  fs::path out = options.out.empty() ? results / "overlay.mp4" : options.out;
  if (out.extension() == ".mp4") return out;
  throw base::InputError("-o " + out.string(), "is no .mp4 file",
                         "The overlay is a video: choose a name that ends in .mp4.");
}

// The frames that the run processed, with their pictures.
class FramesWithPictures {
 public:
  FramesWithPictures(FrameFileReader* frames, vision::Recording* recording,
                     const std::atomic<bool>* stop)
      : frames_(frames), recording_(recording), stop_(stop) {}

  bool Next(FrameInWork* frame) {
    if (stop_ != nullptr && *stop_) return false;
    std::optional<FrameInWork> next = frames_->Next();
    if (!next) return false;
    *frame = std::move(*next);
    std::optional<vision::FrameSet> set;
    do {
      set = recording_->Next();
    } while (set && set->frame < frame->result.frame);
    if (!set || set->frame != frame->result.frame) {
      throw base::InputError(
          "the videos", fmt::format("have no frame {}, which the run had", frame->result.frame),
          "Give those that the run was made from, with --camera NAME=FILE.");
    }
    frame->set = std::move(*set);
    return true;
  }

 private:
  FrameFileReader* frames_;
  vision::Recording* recording_;
  const std::atomic<bool>* stop_;
};

}  // namespace

void RenderOptions::Check() const {
  if (overlay_width < 64) throw base::InputError("--overlay-width", "must be 64 px or more");
  if (threads < 0 || threads > kMaxThreads) {
    throw base::InputError("--threads",
                           fmt::format("got {}, must lie between 0 and {}", threads, kMaxThreads),
                           "0 stands for as many as the machine has cores.");
  }
}

RenderReport Render(const fs::path& results, const RenderOptions& options) {
  options.Check();
  const Json summary = ReadSummary(results);
  RenderReport report;
  report.out = OutFor(results, options);
  const std::map<std::string, std::string> found = FindVideos(summary, results, options.sources);
  // The videos are where FindVideos has them, whatever the scene says.
  const scene::Scene scene = scene::LoadScene(
      options.scene.empty()
          ? FindKeptPath(summary["files"]["scene"], results, "scene", "--scene FILE")
          : options.scene,
      scene::SceneFiles::kToDesign);
  const auto videos = SourcesOf(scene, found);
  const std::vector<fs::path> inputs = InputsOf(scene, videos);
  RefuseToReplace(inputs, report.out, "-o");
  const camera::Rig rig = scene::LoadRig(scene.cameras.rig);
  const auto time_offsets_s =
      summary.value("/options/time_offsets_s"_json_pointer, std::map<std::string, double>());
  vision::Recording recording =
      OpenRecording(scene, rig, videos, 0, results.string(), time_offsets_s);
  report.warnings = Changes(summary, inputs);

  const auto correction = CorrectMesh(scene, AimOf(summary), options.show_progress);
  const World world = BuildWorld(scene, correction);
  FrameFileReader frames(results / kFrameFile, world.mesh().num_nodes());
  OverlayVideo overlay(report.out, scene, world, rig, options.overlay_width, options.layers);
  FramesWithPictures input(&frames, &recording, options.stop);
  base::Progress progress("frames", summary.value("/frames/processed"_json_pointer, 0));

  using Order = Stage::Order;
  std::vector<Stage> stages{
      {"draw", Order::kAny, [&](FrameInWork* frame) { frame->overlay = overlay.Draw(*frame); }},
      {"overlay", Order::kInOrder, [&](FrameInWork* frame) {
         overlay.Add(*frame);
         ++report.frames;
         if (options.show_progress) progress.Update(report.frames);
       }}};
  if (overlay.wants_stress()) {
    stages.insert(stages.begin(), {"stress", Order::kInOrder,
                                   [&](FrameInWork* frame) { overlay.AddStress(frame); }});
  }
  const int threads = options.threads > 0 ? options.threads : DefaultThreads();
  StageClock clock;
  const auto start = std::chrono::steady_clock::now();
  const double start_cpu = CpuSeconds();
  RunStages({"decode", [&](FrameInWork* frame) { return input.Next(frame); }}, stages, threads,
            kFramesPerThread * threads, &clock);
  if (options.show_progress) progress.Finish();
  if (report.frames == 0) {
    throw base::InputError((results / kFrameFile).string(), "holds no frame",
                           "There is nothing to draw: the run had no frames.");
  }
  overlay.Commit();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.cpu_seconds = CpuSeconds() - start_cpu;
  report.stages = clock.Report();
  return report;
}

std::string RenderReport::BriefReport() const {
  return fmt::format("{}: {} frames in {:.1f} s, {:.0f} frames/s, {:.0f} ms of processor time each",
                     out.string(), frames, seconds, frames / seconds, 1e3 * cpu_seconds / frames);
}

std::string RenderReport::FullReport() const {
  std::string text = BriefReport() + "\n";
  for (const std::string& warning : warnings) text += fmt::format("warning: {}\n", warning);
  return text;
}

}  // namespace softforce::pipeline
