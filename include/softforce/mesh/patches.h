#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/mesh/surface.h"

namespace softforce::mesh {

// MovingPatchWeights for many places of one body.
class Patches {
 public:
  // The nodes stand at X (m); the diameter is in m. The surface and X are copied.
  Patches(const Surface& surface, const Eigen::Matrix3Xd& X, double diameter);

  // The disc moves along the columns of `directions` (3×k).
  MovingPatch At(const SurfacePoint& centre, const Eigen::Matrix3Xd& directions) const;

 private:
  // The sheet of surface on which the disc lies: triangles that hang together with the centre's
  // about it, and do not face backwards. A thin body's other side and parts that merely come close
  // are not among them.
  std::vector<int> SheetAround(const SurfacePoint& centre) const;

  Surface surface_;
  Eigen::Matrix3Xd X_;
  double diameter_;
  std::vector<std::vector<int>> at_node_;  // the triangles of which it is a corner
};

}  // namespace softforce::mesh
