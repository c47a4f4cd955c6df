#include "scene/simulation_section.h"

namespace softforce::scene {
namespace {

using base::Dimension;

bool ReadMesh(YamlMap& map, SceneFiles files, Simulation* simulation) {
  if (const auto file = map.Optional("file")) {
    simulation->mesh_file = FileOfSimulation(*file, files);
    simulation->refine = 0;
    const YamlValue unit = map.Required("unit", "Mesh files do not say their unit: mm, m, …");
    simulation->metres_per_unit = base::UnitInSi(unit.Text(), Dimension::kLength, unit.where());
  }
  if (const auto order = map.Optional("order")) {
    simulation->order = order->Choice<int>({{"1", 1}, {"2", 2}});
  }
  if (const auto refine = map.Optional("refine")) {
    simulation->refine = refine->Choice<int>({{"0", 0}, {"1", 1}, {"2", 2}, {"3", 3}});
  }
  return true;
}

Eigen::Isometry3d ReadRegistration(YamlMap& map) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  if (const auto translation = map.Optional("translation")) {
    T.translation() = translation->Vector(Dimension::kLength);
  }
  if (const auto rotation = map.Optional("rotation")) {
    const Eigen::Vector3d turn = rotation->Vector(Dimension::kAngle);
    if (!turn.isZero(0)) {
      T.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    }
  }
  return T;
}

void ReadRig(YamlMap& map, Simulation* simulation) {
  if (const auto T = map.Optional("T_rig_robot")) {
    simulation->T_rig_robot = ReadTransform(*T);
    return;
  }
  SimulatedStand stand;
  stand.position = map.Required("position", "Of the first camera; or give T_rig_robot.")
                       .Vector(Dimension::kLength);
  stand.looks_at = map.Required("looks_at", "What the first camera has in its middle.")
                       .Vector(Dimension::kLength);
  if ((stand.looks_at - stand.position).norm() < 1e-6) {
    map.value().Fail("the camera stands where it looks at");
  }
  simulation->stand = stand;
}

// What acts on the body, and where it really stands.
void ReadLoads(YamlMap& map, SceneFiles files, const Scene& scene, Simulation* simulation) {
  if (const auto forces = map.Optional("forces")) {
    simulation->forces = ReadSimulatedForces(*forces, files, scene);
    if (!forces->IsList()) simulation->forces_file = FileOfSimulation(*forces, files);
  }
  if (const auto actuation = map.Optional("actuation")) {
    if (scene.actuators.empty()) actuation->Fail("the scene has no actuators");
    simulation->actuation_file = FileOfSimulation(*actuation, files);
    if (ReadsFilesOfSimulation(files)) {
      simulation->actuation = ReadActuationTable(*simulation->actuation_file, scene.actuators);
    }
  }
  if (const auto offsets = map.Optional("actuator_offsets")) {
    simulation->actuator_offsets =
        offsets->ReadMap([&](YamlMap& keys) { return ReadActuatorOffsets(keys, scene); });
  }
  if (const auto registration = map.Optional("registration")) {
    simulation->T_robot_mesh = registration->ReadMap(ReadRegistration);
  }
}

// What is measured and seen of it.
void ReadSight(YamlMap& map, const Scene& scene, Simulation* simulation) {
  if (const auto markers = map.Optional("markers")) {
    simulation->markers =
        markers->ReadMap([&](YamlMap& keys) { return ReadMarkerNoise(keys, scene); });
  }
  if (const auto rig = map.Optional("rig")) {
    rig->ReadMap([&](YamlMap& keys) {
      ReadRig(keys, simulation);
      return true;
    });
  }
  if (const auto pictures = map.Optional("pictures")) {
    if (pictures->IsMap()) {
      pictures->ReadMap([&](YamlMap& keys) {
        ReadPictures(keys, simulation);
        return true;
      });
    } else {
      simulation->pictures = pictures->Choice<bool>({{"true", true}, {"false", false}});
    }
  }
}

}  // namespace

Simulation ReadSimulation(YamlMap& map, SceneFiles files, const Scene& scene) {
  Simulation simulation;
  if (const auto seed = map.Optional("seed")) {
    simulation.seed = static_cast<std::uint32_t>(seed->Integer(0));
  }
  if (const auto frames = map.Optional("frames")) simulation.frames = frames->Integer(1);
  if (const auto rate = map.Optional("rate")) {
    simulation.rate = rate->PositiveQuantity(Dimension::kFrequency);
  }
  if (const auto mesh = map.Optional("mesh")) {
    mesh->ReadMap([&](YamlMap& keys) { return ReadMesh(keys, files, &simulation); });
  }
  if (const auto material = map.Optional("material")) {
    simulation.materials = ReadMaterials(*material);
  }
  ReadLoads(map, files, scene, &simulation);
  ReadSight(map, scene, &simulation);
  return simulation;
}

}  // namespace softforce::scene
