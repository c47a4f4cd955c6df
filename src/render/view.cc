#include "render/view.h"

#include <algorithm>
#include <cmath>

namespace softforce::render {

Sight See(const View& view, const Eigen::Vector3d& p_robot) {
  Sight sight;
  if (!p_robot.allFinite()) return sight;
  const Eigen::Vector3d p_camera = view.T_camera_robot * p_robot;
  const camera::Projection projection = camera::Project(view.camera->lens, p_camera);
  if (!projection.visible) return sight;
  // Lines that leave the picture need their outer end, but OpenCV draws with 32-bit fixed-point
  // pixels.
  const double far = 4.0 * std::max(view.size.width, view.size.height);  // px
  if (projection.pixel.cwiseAbs().maxCoeff() > far) return sight;
  sight.pixel = {projection.pixel.x(), projection.pixel.y()};
  sight.inverse_depth = 1 / p_camera.z();
  sight.visible = true;
  return sight;
}

}  // namespace softforce::render
