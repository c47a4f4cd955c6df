#pragma once

#include <vector>

#include "scene/yaml_reader.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {

// The sections of a scene file.
void ReadBody(const YamlValue& body, Scene& scene);  // mesh, materials, fixed, gravity, density
std::vector<Actuator> ReadActuators(const YamlValue& actuators);
Markers ReadMarkers(YamlMap& markers);
Forces ReadForces(YamlMap& forces);
Cameras ReadCameras(YamlMap& cameras);

// The CSV table named by "actuation", its columns sorted like `actuators`. Throws InputError naming
// file, line and column.
ActuationTable ReadActuationTable(const std::filesystem::path& file,
                                  const std::vector<Actuator>& actuators);

}  // namespace softforce::scene
