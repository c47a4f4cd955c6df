#pragma once

#include <vector>

#include "scene/yaml_reader.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {

inline std::filesystem::path FileOf(const YamlValue& value, SceneFiles files) {
  return files == SceneFiles::kAll ? value.ExistingFile() : value.Path();
}

// The sections of a scene file.
void ReadBody(const YamlValue& body, SceneFiles files,
              Scene& scene);  // mesh, materials, fixed, gravity, density
std::vector<Actuator> ReadActuators(const YamlValue& actuators);
Markers ReadMarkers(YamlMap& markers);
Forces ReadForces(YamlMap& forces);
Cameras ReadCameras(YamlMap& cameras, SceneFiles files);

// The CSV table named by "actuation", its columns sorted like `actuators`. Throws InputError naming
// file, line and column.
ActuationTable ReadActuationTable(const std::filesystem::path& file,
                                  const std::vector<Actuator>& actuators);

}  // namespace softforce::scene
