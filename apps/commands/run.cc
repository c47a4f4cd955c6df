#include <fmt/format.h>

#include <map>
#include <memory>

#include "commands/camera_sources.h"
#include "commands/commands.h"
#include "commands/live_options.h"
#include "commands/model_options.h"
#include "commands/stop.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"
#include "softforce/pipeline/run.h"

namespace softforce::apps {
namespace {

struct RunArguments {
  std::string scene;
  std::string out;
  std::vector<std::string> cameras;
  std::string frames;
  std::string correct_mesh = "none";
  std::string method, allocation, force_walk;
  std::string duration, record;
  std::string draw = "all";
  int serve = -1;
  pipeline::RunControls controls;
  LiveArguments live;
  bool no_overlay = false;
  bool no_report = false;
  bool no_frames = false;
  pipeline::RunOptions options;
};

// "A:B" with either end left out.
void ParseFrames(const std::string& text, pipeline::RunOptions* options) {
  const size_t colon = text.find(':');
  const auto number = [&](const std::string& digits, int otherwise) {
    if (digits.empty()) return otherwise;
    size_t read = 0;
    int value = -1;
    try {
      value = std::stoi(digits, &read);
    } catch (const std::exception&) {
      read = 0;
    }
    if (read != digits.size() || value < 0) {
      throw base::InputError("--frames", fmt::format("got \"{}\", expected A:B", text),
                             "Example: --frames 10:20 for frames 10 up to and including 19.");
    }
    return value;
  };
  if (colon == std::string::npos) number("?", 0);
  options->first_frame = number(text.substr(0, colon), options->first_frame);
  options->end_frame = number(text.substr(colon + 1), options->end_frame);
}

estimation::EstimationMethod ParseMethod(const std::string& name) {
  using estimation::EstimationMethod;
  for (const auto method : {EstimationMethod::kConverged, EstimationMethod::kLinearStep}) {
    if (name == estimation::Name(method)) return method;
  }
  throw base::InputError("--method", fmt::format("got \"{}\", expected converged or linear", name),
                         "Write for example: --method linear");
}

allocation::Rule ParseRule(const std::string& name) {
  using allocation::Rule;
  for (const auto rule : {Rule::kOptimal, Rule::kNearest}) {
    if (name == allocation::Name(rule)) return rule;
  }
  throw base::InputError("--allocation",
                         fmt::format("got \"{}\", expected optimal or nearest", name),
                         "Write for example: --allocation nearest");
}

int Run(RunArguments* arguments) {
  pipeline::RunOptions& options = arguments->options;
  estimation::EstimatorOptions& estimator = options.tracker.estimator;
  estimator.method = ParseMethod(arguments->method);
  options.tracker.observe.allocation.rule = ParseRule(arguments->allocation);
  if (!arguments->force_walk.empty()) {
    estimator.force_walk =
        base::ParseQuantity(arguments->force_walk, base::Dimension::kForce, 1, "--force-walk")[0];
  }
  if (!arguments->duration.empty()) {
    options.duration_s =
        base::ParseQuantity(arguments->duration, base::Dimension::kTime, 1, "--duration")[0];
  }
  options.record = arguments->record;
  options.live = ParseLiveOptions(arguments->live);
  options.time_offsets_s = ParseTimeOffsets(arguments->live);
  options.out = arguments->out;
  options.overlay = !arguments->no_overlay;
  options.report = !arguments->no_report;
  options.frames = !arguments->no_frames;
  options.layers = pipeline::ParseOverlayLayers(arguments->draw, "--draw");
  options.mesh_aim = ParseMeshAim(arguments->correct_mesh);
  if (!arguments->frames.empty()) ParseFrames(arguments->frames, &options);
  if (arguments->serve >= 0) options.serve_port = arguments->serve;
  options.sources = ParseCameraSources(arguments->cameras);
  options.stop = &arguments->controls.stop;
  options.controls = &arguments->controls;
  StopOnSignal(&arguments->controls.stop);
  const pipeline::RunReport report = pipeline::Run(arguments->scene, options);
  fmt::print("{}", report.FullReport());
  return report.usable ? 0 : 1;
}

}  // namespace

Command AddRun(CLI::App* program) {
  auto arguments = std::make_shared<RunArguments>();
  arguments->out = arguments->options.out.string();
  CLI::App* app =
      program->add_subcommand("run", "Estimate forces from the scene's recording, or live");
  app->add_option("scene", arguments->scene, "Scene file (scene.yaml)")->required();
  app->add_option("--out", arguments->out, "Folder for the results")->capture_default_str();
  app->add_option("--camera", arguments->cameras,
                  "NAME=SOURCE: video file of a camera instead of the scene's, or its live source: "
                  "device (/dev/video0), URL (rtsp://, http://, tcp://) or GStreamer pipeline; may "
                  "be repeated")
      ->allow_extra_args(false);
  app->add_option("--frames", arguments->frames,
                  "A:B: frames A up to but not including B, counted from 0; default all");
  app->add_option("--every", arguments->options.every,
                  "Process every so many frames only, as a camera that is so much slower would")
      ->capture_default_str();
  app->add_option("--duration", arguments->duration,
                  "End after so much time, as \"60 s\"; default: at the end of the recording, or "
                  "with Ctrl-C");
  app->add_option("--record", arguments->record,
                  "Folder: also write the frames that are processed there, without loss, to run "
                  "them again");
  app->add_option("--registration-frames", arguments->options.registration_frames,
                  "Frames searched for base fiducials to find where the cameras stand")
      ->capture_default_str();
  app->add_option("--watch-rig", arguments->options.watch_rig,
                  "Look whether the rig was bumped in every so many frames; 0: never")
      ->capture_default_str();
  AddModelOptions(app, &arguments->correct_mesh, &arguments->options.tracker.estimator);
  arguments->method = estimation::Name(arguments->options.tracker.estimator.method);
  app->add_option("--method", arguments->method,
                  "converged: forces and equilibrium converge in every frame; linear: the paper's "
                  "single linear step per frame, plain least squares, for comparison")
      ->capture_default_str();
  arguments->allocation = allocation::Name(arguments->options.tracker.observe.allocation.rule);
  app->add_option(
         "--allocation", arguments->allocation,
         "Which dot is which marker. optimal: the best assignment in all cameras together; "
         "nearest: the paper's rule, the nearest dot within a threshold displacement, for "
         "comparison")
      ->capture_default_str();
  app->add_option("--force-walk", arguments->force_walk,
                  "How far a force component may go from one frame to the next (standard "
                  "deviation), as \"0.05 N\": smooths noise; default: any way");
  app->add_option("--max-markers", arguments->options.tracker.max_markers,
                  "Estimate from so many markers in each frame, those that tell most about the "
                  "forces; 0: from all")
      ->capture_default_str();
  app->add_option("--threads", arguments->options.threads,
                  "Threads that share the work; 0: as many as there are cores. The tables do not "
                  "depend on it")
      ->capture_default_str();
  app->add_option("--overlay-width", arguments->options.overlay_width, "Width of overlay.mp4, px")
      ->capture_default_str();
  app->add_option("--draw", arguments->draw,
                  "What the overlay shows: all, none, or names separated by commas, from " +
                      pipeline::OverlayLayerNames() + "; with a minus sign: all but these")
      ->capture_default_str();
  app->add_option("--serve", arguments->serve,
                  "PORT: show the run on a page for browsers of this machine while it goes on; 0: "
                  "any port that is free. Its address and the token for its buttons are printed")
      ->check(CLI::Range(0, 65535));
  app->add_flag("--view", arguments->options.view,
                "Show the run in a window while it goes on, with keys for pause, tare, record, "
                "screenshot and quit");
  app->add_flag("--no-overlay", arguments->no_overlay, "Do not write overlay.mp4");
  app->add_flag("--no-report", arguments->no_report, "Do not write report.html");
  app->add_flag("--no-frames", arguments->no_frames,
                "Do not write frames.bin, from which `softforce render` draws the overlay again");
  app->add_flag("--vtu", arguments->options.vtu, "Write a ParaView series (results.pvd)");
  AddLiveOptions(app, &arguments->live);
  return {app, [arguments] { return Run(arguments.get()); }};
}

}  // namespace softforce::apps
