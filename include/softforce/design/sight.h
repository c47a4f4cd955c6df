#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/design/expected_errors.h"
#include "softforce/mesh/surface.h"

namespace softforce::design {

struct SightOptions {
  double pixel_sd = 0.05;     // px, of a marker's centre in each direction
  double marker_size = 6e-3;  // m, diameter of what must be seen of it
  // Cosine between the surface's normal and the way to the camera: below, a marker is too
  // foreshortened. 70°.
  double min_facing = 0.34;
  double edge = 8;  // px of background that a marker needs around it in the picture

  void Check() const;  // throws InputError naming the option
};

// Whether and how well cameras see markers on a body that stands still.
class Sight {
 public:
  // The surface with its nodes at x (3×N, m, robot frame). All must outlive it. Throws InputError
  // for options out of range.
  Sight(const camera::Rig& rig, const Eigen::Isometry3d& T_rig_robot, const mesh::Surface& surface,
        const Eigen::Matrix3Xd& x, const SightOptions& options);

  // Whether a camera sees the whole of a marker: it faces the camera, is in the picture, and the
  // body does not stand before its middle or its rim.
  bool Sees(int camera, const mesh::SurfacePoint& at) const;

  // From the cameras that see it.
  MarkerSight Of(const mesh::SurfacePoint& at) const;
  int NumCameras(const mesh::SurfacePoint& at) const;

 private:
  bool Hidden(const Eigen::Vector3d& point, const Eigen::Vector3d& eye) const;

  const camera::Rig& rig_;
  Eigen::Isometry3d T_rig_robot_;
  const mesh::Surface& surface_;
  const Eigen::Matrix3Xd& x_;
  SightOptions options_;
};

}  // namespace softforce::design
