#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>

#include "commands/camera_sources.h"
#include "commands/commands.h"
#include "commands/live_options.h"
#include "commands/stop.h"
#include "commands/write_page.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/base/quantity.h"
#include "softforce/pipeline/calibrate.h"

namespace softforce::apps {
namespace {

using calibration::LensFit;
using scene::RigFormat;

struct CalibrateArguments {
  std::vector<std::string> inputs, cameras, also;
  std::string board, out, report, distance;
  std::string model = "auto";
  LiveArguments live;
  pipeline::CalibrateOptions options;
  pipeline::GuideOptions guide;
};

// A further file of the rig in another tool's format.
struct AlsoFile {
  RigFormat format = RigFormat::kOpenCv;
  std::string path;
};

std::optional<LensFit> ParseModel(const std::string& name) {
  if (name == "auto") return std::nullopt;
  if (name == "brown4") return LensFit::kBrownConrady4;
  if (name == "brown5") return LensFit::kBrownConrady5;
  if (name == "brown8") return LensFit::kBrownConrady8;
  if (name == "fisheye") return LensFit::kKannalaBrandt;
  throw base::InputError(
      "--model", fmt::format("got \"{}\", expected auto, brown4, brown5, brown8 or fisheye", name),
      "Write for example: --model brown5");
}

// What can be told before the work: that a format has no room for the lens or the cameras.
void CheckHolds(const AlsoFile& file, const pipeline::CalibrateOptions& options) {
  const bool four = options.lens && calibration::NumDistortion(*options.lens) == 4;
  if (file.format == RigFormat::kKalibr && !four) {
    throw base::InputError("--also kalibr=" + file.path,
                           "Kalibr's lenses have 4 coefficients of distortion",
                           "Add --model brown4, or --model fisheye.");
  }
  if (file.format == RigFormat::kOpenCv && options.inputs.size() > 2) {
    throw base::InputError(
        "--also opencv=" + file.path,
        fmt::format("OpenCV's file has at most 2 cameras, got {}", options.inputs.size()),
        "Use kalibr, which has any number.");
  }
}

std::vector<AlsoFile> ParseAlso(const std::vector<std::string>& texts) {
  std::vector<AlsoFile> files;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size()) {
      throw base::InputError("--also", fmt::format("got \"{}\", expected FORMAT=PATH", text),
                             "Example: --also opencv=stereo.yaml, --also ros=FOLDER");
    }
    const RigFormat format = scene::ParseRigFormat(text.substr(0, equals), "--also " + text);
    files.push_back({format, text.substr(equals + 1)});
    if (format != RigFormat::kRos) base::CheckCanWrite(files.back().path);
  }
  return files;
}

// Named and unnamed ones in one list; the first camera's frame is the rig's.
std::vector<vision::CameraInput> Inputs(const CalibrateArguments& arguments) {
  ParseCameraSources(arguments.cameras);  // refuses another form than NAME=SOURCE
  std::vector<std::string> inputs = arguments.inputs;
  inputs.insert(inputs.end(), arguments.cameras.begin(), arguments.cameras.end());
  if (inputs.empty()) {
    throw base::InputError("calibrate", "got no pictures, expected at least one camera's",
                           "Example: softforce calibrate \"left*.jpg\" \"right*.jpg\" --board "
                           "chessboard:9x6,square=25mm -o rig.yaml");
  }
  return vision::SortInputs(inputs);
}

bool AnyLive(const std::vector<std::string>& cameras) {
  return std::any_of(cameras.begin(), cameras.end(), [](const std::string& text) {
    const size_t equals = text.find('=');
    return equals != std::string::npos && vision::IsLive(text.substr(equals + 1));
  });
}

// Collects views from cameras that run.
report::CalibrationRecord CalibrateLive(const CalibrateArguments& arguments) {
  std::vector<vision::LiveCamera> cameras;
  std::vector<std::string> names;
  const std::map<std::string, double> offsets = ParseTimeOffsets(arguments.live);
  for (const std::string& text : arguments.cameras) {
    const std::map<std::string, std::string> parsed = ParseCameraSources({text});
    const auto& [name, source] = *parsed.begin();
    const auto offset = offsets.find(name);
    cameras.push_back({name, source, {}, offset == offsets.end() ? 0 : offset->second});
    names.push_back(name);
    if (vision::IsLive(source)) continue;
    throw base::InputError("--camera " + text, "is a file, but other cameras are live",
                           "Give either live cameras or files.");
  }
  if (!arguments.inputs.empty()) {
    throw base::InputError(arguments.inputs[0], "is a file, but there are live cameras",
                           "Give either live cameras or files.");
  }
  arguments.guide.Check();
  vision::LiveCameras source(cameras, ParseLiveOptions(arguments.live));
  return pipeline::CalibrateLive(source, names, arguments.options, arguments.guide);
}

int Calibrate(CalibrateArguments* arguments) {
  pipeline::CalibrateOptions& options = arguments->options;
  options.board = vision::ParseBoard(arguments->board);
  options.lens = ParseModel(arguments->model);
  if (!arguments->distance.empty()) {
    options.calibration.working_distance =
        base::ParseQuantity(arguments->distance, base::Dimension::kLength, 1, "--distance")[0];
  }
  base::CheckCanWrite(arguments->out);
  if (!arguments->report.empty()) CheckCanWritePage(arguments->report);
  const std::vector<AlsoFile> also = ParseAlso(arguments->also);
  const bool live = AnyLive(arguments->cameras);
  if (!live) options.inputs = Inputs(*arguments);
  for (const AlsoFile& file : also) CheckHolds(file, options);
  options.calibration.stop = StopOnSignal();

  const report::CalibrationRecord record =
      live ? CalibrateLive(*arguments) : pipeline::Calibrate(options);
  fmt::print("{}\n", report::FullReport(record));
  if (!arguments->report.empty()) WritePage(arguments->report, report::CalibrationPage(record));
  if (!record.result.ok()) return 1;
  scene::SaveRig(record.result.rig, arguments->out, pipeline::StatisticsOf(record));
  fmt::print("Written: {}\n", arguments->out);
  for (const AlsoFile& file : also) {
    scene::SaveRigAs(record.result.rig, file.format, file.path);
    fmt::print("Written: {}\n", file.path);
  }
  return 0;
}

}  // namespace

Command AddCalibrate(CLI::App* program) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* app = program->add_subcommand(
      "calibrate", "Calibrate one or more cameras from pictures or videos of a board");
  app->add_option("inputs", arguments->inputs,
                  "Pictures, folders of pictures, patterns (\"left*.jpg\"), or a video per camera");
  app->add_option("--board", arguments->board,
                  std::string("What is printed on the board; one of\n") + vision::kBoardHelp)
      ->required();
  app->add_option("-o", arguments->out, "Rig file to write (rig.yaml)")->required();
  app->add_option(
         "--camera", arguments->cameras,
         "NAME=PICTURES: a pattern, folder or video; or a live camera (device, URL, GStreamer "
         "pipeline), which guides to the poses that are wanted; may be repeated")
      ->allow_extra_args(false);
  app->add_option("--report", arguments->report, "HTML page to write, with the report in pictures");
  app->add_option("--model", arguments->model,
                  "Lens: brown4, brown5, brown8 (Brown-Conrady with so many coefficients), fisheye "
                  "(Kannala-Brandt), or auto: the one that predicts held-out views best")
      ->capture_default_str();
  app->add_option("--distance", arguments->distance,
                  "Working distance at which the uncertainty is reported, as \"0.45 m\"; default: "
                  "the median distance of the board");
  app->add_option("--also", arguments->also,
                  "FORMAT=PATH: write the rig for another tool too: opencv=FILE, kalibr=FILE, "
                  "ros=FOLDER; may be repeated")
      ->allow_extra_args(false);
  app->add_option("--max-uncertainty", arguments->guide.max_uncertainty_px,
                  "Live: collect views until the projection is this certain, px (standard "
                  "deviation at the working distance, over nine tenths of each picture)")
      ->capture_default_str();
  app->add_option("--max-views", arguments->guide.max_views,
                  "Live: collect no more views than these for that")
      ->capture_default_str();
  AddLiveOptions(app, &arguments->live);
  return {app, [arguments] { return Calibrate(arguments.get()); }};
}

}  // namespace softforce::apps
