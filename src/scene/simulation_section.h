#pragma once

#include "scene/sections.h"

namespace softforce::scene {

// A file that only the section "simulation" names: needed to simulate, and not looked at otherwise.
inline bool ReadsFilesOfSimulation(SceneFiles files) { return files == SceneFiles::kToSimulate; }

inline std::filesystem::path FileOfSimulation(const YamlValue& value, SceneFiles files) {
  return ReadsFilesOfSimulation(files) ? value.ExistingFile() : value.Path();
}

// Parts of that section.
std::vector<SimulatedForce> ReadSimulatedForces(const YamlValue& value, SceneFiles files,
                                                const Scene& scene);
// How much more the actuators really do than they are told, by name.
std::map<std::string, double> ReadActuatorOffsets(YamlMap& map, const Scene& scene);
simulation::MeasureOptions ReadMarkerNoise(YamlMap& map, const Scene& scene);
void ReadPictures(YamlMap& map, Simulation* simulation);

// From "from" up to "until"; both may be left out.
template <class Span>
void ReadSpan(YamlMap& map, Span* span) {
  if (const auto from = map.Optional("from")) span->from_s = from->Quantity(base::Dimension::kTime);
  if (const auto until = map.Optional("until")) {
    span->until_s = until->Quantity(base::Dimension::kTime);
    if (span->until_s <= span->from_s) until->Fail("ends before it begins");
  }
}

}  // namespace softforce::scene
