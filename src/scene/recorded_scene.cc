#include "softforce/scene/recorded_scene.h"

#include <yaml-cpp/yaml.h>

#include <fstream>

#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"

namespace softforce::scene {

void SaveRecordedScene(const std::filesystem::path& original, const RecordedFiles& files,
                       const std::filesystem::path& copy) {
  YAML::Node root = YAML::LoadFile(original.string());  // it was read before, and is valid
  root.remove("simulation");
  root["body"]["mesh"]["file"] = files.mesh;
  if (!files.actuation.empty()) root["actuation"] = files.actuation;
  if (files.sources.empty()) {
    root.remove("cameras");
    root["measured"] = files.measured;
  } else {
    root["cameras"]["rig"] = files.rig;
    YAML::Node sources;
    sources.SetStyle(YAML::EmitterStyle::Flow);
    for (const auto& [camera, file] : files.sources) sources[camera] = file;
    root["cameras"]["sources"] = sources;
  }
  base::PendingFile pending(copy);
  std::ofstream stream(pending.temporary());
  stream << root << '\n';
  stream.close();
  if (!stream) {
    throw base::InputError(copy.string(), "cannot be written",
                           "Check the folder's permissions and the disk's space.");
  }
  pending.Commit();
}

}  // namespace softforce::scene
