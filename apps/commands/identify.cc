#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "commands/camera_sources.h"
#include "commands/commands.h"
#include "commands/model_options.h"
#include "commands/stop.h"
#include "commands/write_page.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/pipeline/identify.h"
#include "softforce/pipeline/known_weights.h"
#include "softforce/report/identification_page.h"

namespace softforce::apps {
namespace {

using Kind = estimation::Unknown::Kind;

struct IdentifyArguments {
  std::string scene;
  std::vector<std::string> cameras;
  std::vector<std::string> unknowns{"youngs_modulus"};
  std::string out, report;
  bool in_place = false;
  std::string correct_mesh = "none";
  pipeline::IdentifyOptions options;
};

Kind ParseUnknown(const std::string& name) {
  if (name == "youngs_modulus") return Kind::kYoungsModulus;
  if (name == "poissons_ratio") return Kind::kPoissonsRatio;
  if (name == "cable_offset") return Kind::kCableOffset;
  throw base::InputError(
      "--unknown",
      fmt::format("got \"{}\", expected youngs_modulus, poissons_ratio or cable_offset", name),
      "Write for example: --unknown youngs_modulus --unknown cable_offset");
}

// Where the scene with the new values goes; empty for nowhere.
std::filesystem::path Target(const IdentifyArguments& arguments) {
  if (!arguments.in_place) {
    if (arguments.out.empty()) return {};
    std::error_code ignored;  // a scene that is not there is refused when it is read
    if (std::filesystem::equivalent(arguments.out, arguments.scene, ignored)) {
      throw base::InputError("-o " + arguments.out, "is the scene itself",
                             "Use --in-place if you want it changed.");
    }
    base::CheckCanWrite(std::filesystem::weakly_canonical(arguments.out, ignored));
    return arguments.out;
  }
  if (!arguments.out.empty()) {
    throw base::InputError("--in-place", "got -o as well, expected one of them");
  }
  // Where it is a link: the file that it leads to. A scene that is not there is refused when read.
  std::error_code ignored;
  auto scene = std::filesystem::weakly_canonical(arguments.scene, ignored);
  if (std::filesystem::is_regular_file(scene, ignored)) base::CheckCanWrite(scene);
  return scene;
}

report::IdentificationRecord RecordOf(const pipeline::IdentifyReport& report) {
  report::IdentificationRecord record{report.found, {}, report.FullReport()};
  for (const pipeline::KnownForce& force : report.forces) {
    record.forces.push_back(
        {force.state, force.candidate, force.known.norm(), force.estimated.norm()});
  }
  return record;
}

int Identify(IdentifyArguments* arguments) {
  pipeline::IdentifyOptions& options = arguments->options;
  options.unknowns.clear();
  for (const std::string& name : arguments->unknowns) {
    options.unknowns.push_back(ParseUnknown(name));
  }
  options.mesh_aim = ParseMeshAim(arguments->correct_mesh);
  options.sources = ParseCameraSources(arguments->cameras);
  const std::filesystem::path target = Target(*arguments);
  if (!arguments->in_place) options.out = target;
  if (!arguments->report.empty()) CheckCanWritePage(arguments->report);
  options.stop = StopOnSignal();
  const pipeline::IdentifyReport report = pipeline::Identify(arguments->scene, options);
  fmt::print("{}", report.FullReport());
  if (!arguments->report.empty()) {
    WritePage(arguments->report, report::IdentificationPage(RecordOf(report)));
  }
  if (!report.usable || *options.stop) return 1;
  if (!target.empty()) {
    scene::WriteChangedScene(arguments->scene, report.changes, target);
    fmt::print("\nWritten: {}\n", target.string());
  }
  return 0;
}

}  // namespace

Command AddIdentify(CLI::App* program) {
  auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* app = program->add_subcommand(
      "identify", "Find Young's modulus, and more, from frames with known weights");
  app->add_option("scene", arguments->scene, "Scene file (scene.yaml)")->required();
  app->add_option("--weights", arguments->options.weights, pipeline::kWeightsHelp)
      ->required()
      ->allow_extra_args(false);
  app->add_option("--unknown", arguments->unknowns,
                  "What to find: youngs_modulus, poissons_ratio or cable_offset; may be repeated")
      ->allow_extra_args(false)
      ->capture_default_str();
  app->add_flag("--per-region", arguments->options.per_region,
                "A value for each material of the scene, instead of one change for all");
  app->add_option("-o", arguments->out,
                  "Scene file to write, with the values found and all else as it is");
  app->add_flag("--in-place", arguments->in_place, "Write the values into the scene file itself");
  app->add_option("--report", arguments->report, "HTML page to write, with the report in pictures");
  app->add_option("--camera", arguments->cameras,
                  "NAME=SOURCE: video file of a camera instead of the scene's; may be repeated")
      ->allow_extra_args(false);
  app->add_option("--registration-frames", arguments->options.registration_frames,
                  "Frames searched for base fiducials to find where the cameras stand")
      ->capture_default_str();
  AddModelOptions(app, &arguments->correct_mesh, &arguments->options.tracker.estimator);
  return {app, [arguments] { return Identify(arguments.get()); }};
}

}  // namespace softforce::apps
