#include <fmt/format.h>

#include <memory>

#include "commands/commands.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"
#include "softforce/scene/rig_file.h"

namespace softforce::apps {
namespace {

struct RigArguments {
  std::vector<std::string> files;
  std::string out, format = "softforce", unit, resolution;
};

// "640x480"
std::array<int, 2> ParseResolution(const std::string& text) {
  int width = 0, height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width < 1 ||
      height < 1) {
    throw base::InputError("--resolution", fmt::format("got \"{}\", expected WIDTHxHEIGHT", text),
                           "Example: --resolution 640x480");
  }
  return {width, height};
}

int Convert(const RigArguments& arguments) {
  scene::RigReadOptions options;
  if (!arguments.resolution.empty()) options.resolution = ParseResolution(arguments.resolution);
  if (!arguments.unit.empty()) {
    options.metres_per_unit = base::UnitInSi(arguments.unit, base::Dimension::kLength, "--unit");
  }
  const scene::RigFormat format = scene::ParseRigFormat(arguments.format, "--format");
  const std::vector<std::filesystem::path> files(arguments.files.begin(), arguments.files.end());
  const camera::Rig rig = scene::LoadRig(files, options);
  if (format == scene::RigFormat::kSoftforce && files.size() == 1) {
    scene::SaveRig(rig, arguments.out, scene::LoadRigStatistics(files[0]));
  } else {
    scene::SaveRigAs(rig, format, arguments.out);
  }
  fmt::print("Written: {} ({} camera{})\n", arguments.out, rig.cameras.size(),
             rig.cameras.size() == 1 ? "" : "s");
  return 0;
}

}  // namespace

Command AddRig(CLI::App* program) {
  auto arguments = std::make_shared<RigArguments>();
  CLI::App* app =
      program->add_subcommand("rig", "Convert the files of a rig: rig.yaml, OpenCV, Kalibr, ROS");
  app->add_option(
         "files", arguments->files,
         "Rig file; or those of one rig: intrinsics and extrinsics of OpenCV, a pair of ROS")
      ->required();
  app->add_option("-o", arguments->out, "File to write; a folder for ros")->required();
  app->add_option("--format", arguments->format,
                  "Of what is written: softforce, opencv, kalibr, ros")
      ->capture_default_str();
  app->add_option("--unit", arguments->unit,
                  "Unit of the translation in OpenCV's files, which do not say it, as \"mm\"");
  app->add_option("--resolution", arguments->resolution,
                  "Of the pictures, px, as 640x480, if OpenCV's files do not say it");
  return {app, [arguments] { return Convert(*arguments); }};
}

}  // namespace softforce::apps
