#pragma once

#include <vector>

#include "softforce/mesh/surface.h"

namespace softforce::mesh {

// As ClosestSurfacePoint, but looks only at the given triangles (at least one). Of equally close
// ones the first in the list wins.
SurfaceProjection ClosestAmong(const std::vector<int>& triangles, const Surface& surface,
                               const Eigen::Matrix3Xd& x, const Eigen::Vector3d& p);

// How far p is from the box around a triangle's corners (m), squared: a lower bound of its distance
// from the triangle.
double SquaredDistanceToBox(const Surface& surface, const Eigen::Matrix3Xd& x, int triangle,
                            const Eigen::Vector3d& p);

}  // namespace softforce::mesh
