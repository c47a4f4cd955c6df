#include <fmt/format.h>

#include "softforce/base/input_error.h"
#include "softforce/vision/live_cameras.h"
#include "softforce/vision/recording.h"

namespace softforce::vision {
namespace {

using base::InputError;

std::string NamesOf(const camera::Rig& rig) {
  std::string names;
  for (const camera::Camera& camera : rig.cameras) names += " \"" + camera.name + "\"";
  return names;
}

}  // namespace

std::vector<LiveCamera> LiveCamerasOf(const camera::Rig& rig,
                                      const std::map<std::string, std::string>& sources,
                                      const std::map<std::string, double>& time_offsets_s) {
  for (const auto& [name, source] : sources) {
    if (rig.Find(name)) continue;
    throw InputError("cameras: sources",
                     fmt::format("the rig has no camera \"{}\"; it has:{}", name, NamesOf(rig)));
  }
  for (const auto& [name, offset] : time_offsets_s) {
    if (rig.Find(name)) continue;
    throw InputError("time offset",
                     fmt::format("the rig has no camera \"{}\"; it has:{}", name, NamesOf(rig)));
  }
  std::vector<LiveCamera> cameras;
  for (const camera::Camera& camera : rig.cameras) {
    const auto source = sources.find(camera.name);
    if (source == sources.end()) {
      throw InputError(
          "cameras: sources", fmt::format("camera \"{}\" of the rig has no source", camera.name),
          fmt::format("Name one under 'sources', or with --camera {}=SOURCE.", camera.name));
    }
    const auto offset = time_offsets_s.find(camera.name);
    cameras.push_back({camera.name, source->second, cv::Size(camera.width, camera.height),
                       offset == time_offsets_s.end() ? camera.time_offset_s : offset->second});
  }
  return cameras;
}

std::unique_ptr<FrameSource> OpenFrameSource(const camera::Rig& rig,
                                             const std::map<std::string, std::string>& sources,
                                             const LiveOptions& options,
                                             const std::map<std::string, double>& time_offsets_s) {
  const std::string* live = nullptr;
  const std::string* file = nullptr;
  std::vector<Recording::Source> files;
  for (const auto& [name, source] : sources) {
    (IsLive(source) ? live : file) = &name;
    files.push_back({name, source});
  }
  if (live != nullptr && file != nullptr) {
    throw InputError("cameras: sources",
                     fmt::format("camera \"{}\" is live (\"{}\"), but \"{}\" is a file (\"{}\")",
                                 *live, sources.at(*live), *file, sources.at(*file)),
                     "Give live cameras for all, or files for all.");
  }
  if (live == nullptr) return std::make_unique<Recording>(rig, files, time_offsets_s);
  return std::make_unique<LiveCameras>(LiveCamerasOf(rig, sources, time_offsets_s), options);
}

}  // namespace softforce::vision
