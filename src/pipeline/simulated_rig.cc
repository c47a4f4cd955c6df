#include "pipeline/simulated_rig.h"

#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

// The rig frame such that the first camera stands and looks as told, the robot's z up in its
// picture, or y if it looks along z.
Eigen::Isometry3d RigAt(const scene::SimulatedStand& stand, const camera::Rig& rig) {
  const Eigen::Vector3d z = (stand.looks_at - stand.position).normalized();
  const bool along_z = std::abs(z.z()) > 0.99;
  const Eigen::Vector3d up = along_z ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d x = z.cross(up).normalized();
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear() << x, z.cross(x), z;
  T_robot_camera.translation() = stand.position;
  return rig.cameras[0].T_camera_rig.inverse() * T_robot_camera.inverse();
}

}  // namespace

Eigen::Isometry3d PlaceSimulatedRig(const scene::Scene& scene, const scene::Simulation& simulation,
                                    const camera::Rig& rig) {
  if (simulation.T_rig_robot) return *simulation.T_rig_robot;
  if (simulation.stand) return RigAt(*simulation.stand, rig);
  if (rig.T_rig_robot) return *rig.T_rig_robot;
  throw base::InputError(
      scene.file.string() + ": simulation: rig",
      "nothing says where the cameras stand: there is no such key, and no T_rig_robot in " +
          scene.cameras.rig.string(),
      "Write for example: rig: {position: 100 -300 600 mm, looks_at: 100 100 0 mm}");
}

}  // namespace softforce::pipeline
