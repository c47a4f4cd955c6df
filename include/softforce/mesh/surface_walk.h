#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "softforce/mesh/surface.h"

namespace softforce::mesh {

// Walks over the flat triangles of a surface, from each into the next across their common edge.
class SurfaceWalk {
 public:
  // The nodes stand at X (m). Steps stay on triangles of one `region` (a number per triangle).
  // Throws nothing; the surface and X are copied.
  SurfaceWalk(const Surface& surface, const Eigen::Matrix3Xd& X, std::vector<int> region);

  // Goes from a point straight on by a step (m) in the plane of its triangle; what is normal to it
  // is left out. At an edge the way is bent with the surface, so that its length stays; at the end
  // of the region it slides along the edge.
  SurfacePoint Step(const SurfacePoint& from, const Eigen::Vector3d& step) const;

  // Orthonormal directions in the plane of a triangle, 3×2.
  Eigen::Matrix<double, 3, 2> Tangents(int triangle) const;

  Eigen::Vector3d Position(const SurfacePoint& point) const;
  const std::vector<int>& region() const { return region_; }

 private:
  Eigen::Vector3d Corner(int triangle, int i) const;

  Eigen::Matrix3Xi triangles_;
  Eigen::Matrix3Xd X_;
  Eigen::Matrix3Xd normals_;
  std::vector<int> region_;
  // Per triangle and edge (i → i+1): the triangle beyond it; −1 where the walk ends.
  std::vector<std::array<int, 3>> beyond_;
};

// The faces of a body: triangles that hang together without a crease sharper than `crease` (rad),
// numbered from 0.
std::vector<int> SmoothFaces(const Surface& surface, const Eigen::Matrix3Xd& X, double crease);

}  // namespace softforce::mesh
