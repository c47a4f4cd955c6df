#include "pipeline/refusals.h"

#include <fmt/format.h>

#include "pipeline/frame_file.h"
#include "softforce/base/input_error.h"
#include "softforce/vision/live_cameras.h"

namespace softforce::pipeline {
namespace {

std::vector<std::string> OldResults(const std::filesystem::path& out) {
  std::vector<std::string> old{"forces.csv",    "markers.csv",  "information.csv", "locations.csv",
                               "actuation.csv", "summary.json", "overlay.mp4",     "report.html",
                               "results.pvd",   kFrameFile};
  std::error_code ignored;  // a folder that is not there has no old frames
  for (const auto& entry : std::filesystem::directory_iterator(out / "vtu", ignored)) {
    const std::string name = entry.path().filename().string();
    if ((name.rfind("frame_", 0) == 0 || name.rfind("forces_", 0) == 0 ||
         name.rfind("markers_", 0) == 0) &&
        entry.path().extension() == ".vtu") {
      old.push_back("vtu/" + name);
    }
  }
  return old;
}

void Remove(const std::filesystem::path& out, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::filesystem::path file = out / name;
    std::error_code error;
    std::filesystem::remove(file, error);
    if (!error) continue;
    throw base::InputError(file.string(), "an older result cannot be removed: " + error.message(),
                           "Choose another folder with --out.");
  }
}

void MakeFolder(const std::filesystem::path& out) {
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) {
    throw base::InputError(out.string(), "the folder cannot be made: " + error.message(),
                           "Choose another with --out.");
  }
}

}  // namespace

void RefuseLiveSources(const scene::Scene& scene,
                       const std::vector<vision::Recording::Source>& sources) {
  for (const vision::Recording::Source& source : sources) {
    if (!vision::IsLive(source.file.string())) continue;
    throw base::InputError(
        scene.file.string() + ": cameras: sources: " + source.camera,
        fmt::format("\"{}\" is a live source, but only a recording will do here",
                    source.file.string()),
        "Record the cameras first, with softforce record or with softforce run --record.");
  }
}

void RefuseUnknownLocations(const scene::Scene& scene) {
  if (scene.forces.known_locations) return;
  throw base::InputError(
      scene.file.string() + ": forces: known",
      "is false, but values are found from forces at known places only",
      "Set 'known: true' and list the places where the weights hang as candidates.");
}

void RefuseToOverwrite(const std::vector<std::filesystem::path>& inputs,
                       const std::filesystem::path& out_folder) {
  std::error_code ignored;  // a path that cannot be resolved is compared as it is
  const auto out = std::filesystem::weakly_canonical(out_folder, ignored);
  for (const std::filesystem::path& input : inputs) {
    // A link is an input in its own folder, and where it leads to.
    const auto here = std::filesystem::weakly_canonical(input.parent_path(), ignored);
    const auto there = std::filesystem::weakly_canonical(input, ignored).parent_path();
    if (here != out && here != out / "vtu" && there != out && there != out / "vtu") continue;
    throw base::InputError(
        "--out " + out_folder.string(),
        fmt::format("is the folder of the input {}, which results could overwrite",
                    input.filename().string()),
        "Choose a folder that holds none of the scene's files.");
  }
}

void RefuseToReplace(const std::vector<std::filesystem::path>& inputs,
                     const std::filesystem::path& out, const std::string& option) {
  std::error_code ignored;  // a path that cannot be resolved is compared as it is
  const auto resolved = std::filesystem::weakly_canonical(out, ignored);
  for (const std::filesystem::path& input : inputs) {
    if (std::filesystem::weakly_canonical(input, ignored) != resolved &&
        !std::filesystem::equivalent(input, out, ignored)) {
      continue;
    }
    throw base::InputError(option + " " + out.string(),
                           fmt::format("would replace the input {}", input.string()),
                           "Choose a name that none of the scene's files has.");
  }
}

void PrepareFolder(const std::filesystem::path& out) { PrepareFolder(out, OldResults(out)); }

void PrepareFolder(const std::filesystem::path& out, const std::vector<std::string>& names) {
  MakeFolder(out);
  Remove(out, names);
}

}  // namespace softforce::pipeline
