#pragma once

#include <Eigen/Geometry>

#include "softforce/camera/rig.h"
#include "softforce/scene/scene.h"

namespace softforce::pipeline {

// T_rig_robot of a simulated recording: as the section "simulation" says, or the rig's own file.
// Throws InputError if neither does.
Eigen::Isometry3d PlaceSimulatedRig(const scene::Scene& scene, const scene::Simulation& simulation,
                                    const camera::Rig& rig);

}  // namespace softforce::pipeline
