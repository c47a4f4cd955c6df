#include "pipeline/open_recording.h"

#include <fmt/format.h>

#include "pipeline/refusals.h"
#include "softforce/base/input_error.h"
#include "softforce/vision/live_cameras.h"

namespace softforce::pipeline {

std::vector<vision::Recording::Source> SourcesOf(
    const scene::Scene& scene, const std::map<std::string, std::string>& instead) {
  std::map<std::string, std::string> sources = scene.cameras.sources;
  for (const auto& [camera, source] : instead) sources[camera] = source;
  std::vector<vision::Recording::Source> files;
  files.reserve(sources.size());
  for (const auto& [camera, source] : sources) files.push_back({camera, source});
  return files;
}

std::vector<std::filesystem::path> InputsOf(const scene::Scene& scene,
                                            const std::vector<vision::Recording::Source>& sources) {
  std::vector<std::filesystem::path> inputs{scene.file, scene.mesh.file};
  if (scene.measured) inputs.push_back(scene.measured->file);
  const std::filesystem::path rig = scene.measured ? scene.measured->rig : scene.cameras.rig;
  if (!rig.empty()) inputs.push_back(rig);
  if (scene.actuation_file) inputs.push_back(*scene.actuation_file);
  for (const vision::Recording::Source& source : sources) {
    if (!vision::IsLive(source.file.string())) inputs.push_back(source.file);
  }
  return inputs;
}

bool AreLive(const std::vector<vision::Recording::Source>& sources) {
  const vision::Recording::Source *live = nullptr, *file = nullptr;
  for (const vision::Recording::Source& source : sources) {
    (vision::IsLive(source.file.string()) ? live : file) = &source;
  }
  if (live == nullptr || file == nullptr) return live != nullptr;
  throw base::InputError(
      "cameras: sources",
      fmt::format("camera \"{}\" is live ({}), but camera \"{}\" is the file {}", live->camera,
                  live->file.string(), file->camera, file->file.string()),
      "Give live sources for all cameras, or files for all.");
}

std::vector<std::filesystem::path> FilesOf(const scene::Scene& scene,
                                           const std::vector<vision::Recording::Source>& sources) {
  std::vector<std::filesystem::path> files = InputsOf(scene, sources);
  if (!scene.simulation) return files;
  for (const auto& file : {scene.simulation->mesh_file, scene.simulation->forces_file,
                           scene.simulation->actuation_file}) {
    if (file) files.push_back(*file);
  }
  return files;
}

vision::Recording OpenRecording(const scene::Scene& scene, const camera::Rig& rig,
                                const std::vector<vision::Recording::Source>& sources,
                                int first_frame, const std::string& asked_by,
                                const std::map<std::string, double>& time_offsets_s) {
  RefuseLiveSources(scene, sources);
  vision::Recording recording(rig, sources, time_offsets_s);
  const int announced = recording.announced_frames();
  if (announced > 0 && first_frame >= announced) {
    throw base::InputError(
        asked_by, fmt::format("asks for frame {}, but the recording has {} frames, 0 to {}",
                              first_frame, announced, announced - 1));
  }
  return recording;
}

}  // namespace softforce::pipeline
