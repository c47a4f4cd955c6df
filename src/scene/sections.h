#pragma once

#include <vector>

#include "scene/yaml_reader.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {

// A file that belongs to the scene itself.
inline std::filesystem::path FileOf(const YamlValue& value, SceneFiles files) {
  return files == SceneFiles::kNone ? value.Path() : value.ExistingFile();
}

// The sections of a scene file.
void ReadBody(const YamlValue& body, SceneFiles files,
              Scene& scene);  // mesh, materials, fixed, gravity, density
std::vector<Actuator> ReadActuators(const YamlValue& actuators);
// `measured`: by motion capture, which does not need to know what they look like.
Markers ReadMarkers(YamlMap& markers, bool measured);
// `scene`: with its body, over which candidates may be spread.
Forces ReadForces(YamlMap& forces, const Scene& scene);
Cameras ReadCameras(YamlMap& cameras, SceneFiles files);
Measured ReadMeasured(const YamlValue& measured, SceneFiles files);
Simulation ReadSimulation(YamlMap& simulation, SceneFiles files, const Scene& scene);

// One material for the whole body, called "", or one for each region.
std::map<std::string, fem::Material> ReadMaterials(const YamlValue& materials);
Eigen::Isometry3d ReadTransform(const YamlValue& transform);  // 4×4, metres

// The CSV table named by "actuation", its columns sorted like `actuators`. Throws InputError naming
// file, line and column.
ActuationTable ReadActuationTable(const std::filesystem::path& file,
                                  const std::vector<Actuator>& actuators);

}  // namespace softforce::scene
