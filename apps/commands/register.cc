#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "commands/camera_sources.h"
#include "commands/commands.h"
#include "commands/live_options.h"
#include "commands/stop.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/base/quantity.h"
#include "softforce/pipeline/register.h"
#include "softforce/pipeline/time_offsets.h"
#include "softforce/scene/place_rig.h"
#include "softforce/scene/scene.h"
#include "softforce/scene/set_time_offsets.h"

namespace softforce::apps {
namespace {

using pipeline::RegisterFrom;

struct RegisterArguments {
  std::string scene;
  std::string from, pairs, out;
  bool in_place = false;
  bool clocks = false;
  std::string duration, search;
  std::vector<std::string> cameras;
  LiveArguments live;
  pipeline::RegisterOptions options;
};

RegisterFrom ParseFrom(const RegisterArguments& arguments) {
  if (arguments.from.empty()) {
    return arguments.pairs.empty() ? RegisterFrom::kAnything : RegisterFrom::kPairs;
  }
  if (arguments.from == "fiducials") return RegisterFrom::kFiducials;
  if (arguments.from == "markers") return RegisterFrom::kMarkers;
  if (arguments.from == "pairs") return RegisterFrom::kPairs;
  throw base::InputError(
      "--from", fmt::format("got \"{}\", expected fiducials, markers or pairs", arguments.from),
      "Write for example: --from markers");
}

// Where the rig file with the place goes; empty for nowhere.
std::filesystem::path Target(const RegisterArguments& arguments) {
  if (arguments.in_place && !arguments.out.empty()) {
    throw base::InputError("--in-place", "got -o as well, expected one of them");
  }
  if (!arguments.in_place && arguments.out.empty()) return {};
  const scene::Scene scene = scene::LoadScene(arguments.scene, scene::SceneFiles::kNone);
  const std::filesystem::path rig = scene.measured ? scene.measured->rig : scene.cameras.rig;
  if (arguments.in_place && rig.empty()) {
    throw base::InputError("--in-place", "the scene names no file for it under \"measured: rig\"",
                           "Write for example: measured: {file: take.csv, rig: capture.yaml}");
  }
  std::filesystem::path target = arguments.in_place ? rig : std::filesystem::path(arguments.out);
  std::error_code ignored;
  if (!scene.measured) scene::CheckCanHoldPlace(rig, target);
  const std::filesystem::path points =
      scene.measured ? scene.measured->file : std::filesystem::path();
  for (const auto& input :
       {scene.file, scene.mesh.file, points, std::filesystem::path(arguments.pairs)}) {
    if (!input.empty() && std::filesystem::equivalent(target, input, ignored)) {
      throw base::InputError("-o " + target.string(), "would replace the input " + input.string(),
                             "Give another name.");
    }
  }
  for (const auto& [camera, source] : scene.cameras.sources) {
    if (std::filesystem::equivalent(target, source, ignored)) {
      throw base::InputError("-o " + target.string(), "would replace the input " + source,
                             "Give another name.");
    }
  }
  base::CheckCanWrite(std::filesystem::weakly_canonical(target, ignored));
  return target;
}

void Read(const std::string& text, const char* option, double* seconds) {
  if (!text.empty()) *seconds = base::ParseQuantity(text, base::Dimension::kTime, 1, option)[0];
}

// The cameras' time offsets instead of the rig's place.
int FindClocks(const RegisterArguments& arguments) {
  if (!arguments.from.empty() || !arguments.pairs.empty()) {
    throw base::InputError("--clocks", "goes without --from and --pairs",
                           "Find the rig's place in a second call.");
  }
  pipeline::TimeOffsetsOptions options;
  options.sources = ParseCameraSources(arguments.cameras);
  options.live = ParseLiveOptions(arguments.live);
  options.time_offsets_s = ParseTimeOffsets(arguments.live);
  Read(arguments.duration, "--duration", &options.duration_s);
  Read(arguments.search, "--largest-offset", &options.search.longest_s);
  options.stop = StopOnSignal();
  const std::filesystem::path target = Target(arguments);
  const pipeline::TimeOffsetsReport report = pipeline::FindTimeOffsets(arguments.scene, options);
  fmt::print("{}", report.FullReport());
  if (!report.usable()) return 1;
  if (!target.empty()) {
    scene::WriteTimeOffsets(report.rig_file, report.rig, target);
    fmt::print("\nWritten: {}\n", target.string());
  }
  return 0;
}

int Register(RegisterArguments* arguments) {
  if (arguments->clocks) return FindClocks(*arguments);
  if (!arguments->duration.empty() || !arguments->search.empty()) {
    throw base::InputError(arguments->search.empty() ? "--duration" : "--largest-offset",
                           "goes with --clocks only");
  }
  pipeline::RegisterOptions& options = arguments->options;
  options.from = ParseFrom(*arguments);
  options.pairs = arguments->pairs;
  options.sources = ParseCameraSources(arguments->cameras);
  options.live = ParseLiveOptions(arguments->live);
  options.time_offsets_s = ParseTimeOffsets(arguments->live);
  options.stop = StopOnSignal();
  const std::filesystem::path target = Target(*arguments);
  const pipeline::RegisterReport report = pipeline::Register(arguments->scene, options);
  fmt::print("{}", report.FullReport());
  if (*options.stop) return 1;
  if (!target.empty()) {
    const scene::RigPlace place{report.pose.T_rig_robot, report.pose.covariance,
                                fmt::format("found {}\n{}", report.how, report.Spread())};
    if (std::isfinite(report.rms)) {
      scene::WritePlace(place, target);  // motion capture has no cameras to keep
    } else {
      scene::WritePlacedRig(report.rig_file, place, target);
    }
    fmt::print("\nWritten: {}\n", target.string());
  }
  return 0;
}

}  // namespace

Command AddRegister(CLI::App* program) {
  auto arguments = std::make_shared<RegisterArguments>();
  CLI::App* app = program->add_subcommand(
      "register", "Find where the cameras, or motion capture, stand in the robot's frame");
  app->add_option("scene", arguments->scene, "Scene file (scene.yaml)")->required();
  app->add_option("--from", arguments->from,
                  "What to find it from: fiducials (tags on the base), markers (of the body, "
                  "unloaded) or pairs (typed points); default: fiducials if the scene has any, "
                  "else markers")
      ->option_text("fiducials|markers|pairs");
  app->add_option("--pairs", arguments->pairs,
                  "File of points of the robot (mm) and where cameras see them (px): CSV with the "
                  "columns x_mm,y_mm,z_mm,camera,u_px,v_px");
  app->add_option("-o", arguments->out,
                  "Rig file to write, with T_rig_robot and all else as in the scene's");
  app->add_flag("--in-place", arguments->in_place, "Write T_rig_robot into the scene's rig file");
  app->add_option("--frame", arguments->options.frame,
                  "The first frame to look at; of markers the only one, with the body unloaded")
      ->capture_default_str();
  app->add_option("--registration-frames", arguments->options.fiducial_frames,
                  "Frames searched for base fiducials")
      ->capture_default_str();
  app->add_option("--camera", arguments->cameras,
                  "NAME=SOURCE: video file or live source of a camera instead of the scene's; may "
                  "be repeated")
      ->allow_extra_args(false);
  app->add_flag("--clocks", arguments->clocks,
                "Instead of the place: by how much the time stamps of each camera are late, from "
                "the markers' motion; writes time_offset into the rig file");
  app->add_option("--duration", arguments->duration,
                  "With --clocks: time to look at, as \"10 s\"; default: all of a recording, or "
                  "until Ctrl-C");
  app->add_option("--largest-offset", arguments->search,
                  fmt::format("With --clocks: what is searched to either side of the offsets that "
                              "are known, default \"{:g} ms\"",
                              1e3 * vision::TimeOffsetOptions().longest_s));
  AddLiveOptions(app, &arguments->live);
  return {app, [arguments] { return Register(arguments.get()); }};
}

}  // namespace softforce::apps
