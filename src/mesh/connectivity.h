#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/mesh/disjoint_sets.h"
#include "softforce/mesh/surface.h"

namespace softforce::mesh {

// Two triangles of the surface that share an edge. Edges of more than two triangles, where parts of
// the surface only touch, are left out.
struct TrianglePair {
  int first, second;
};
std::vector<TrianglePair> Neighbours(const Surface& surface);

// Outward unit normals of the flat triangles through the corners, 3×T.
Eigen::Matrix3Xd FlatNormals(const Surface& surface, const Eigen::Matrix3Xd& x);

// The part of the surface that each triangle belongs to; parts share no edge.
std::vector<int> SurfaceParts(const Surface& surface);

// The volume on the inner side of each part (m³): negative for a part that bounds a cavity.
std::vector<double> EnclosedVolumes(const Surface& surface, const Eigen::Matrix3Xd& x,
                                    const std::vector<int>& part);

}  // namespace softforce::mesh
