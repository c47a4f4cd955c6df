#include "scene/time_table.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {

Eigen::Vector3d SimulatedForce::At(double time) const { return Interpolate(time_s, force, time); }

}  // namespace softforce::scene
