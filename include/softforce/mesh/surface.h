#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

// The boundary of a tetrahedral mesh: the faces that belong to one element only.
struct Surface {
  // Node numbers of each triangle, 3×T or 6×T: corners counter-clockwise seen from outside, then
  // for order 2 the nodes in the middle of the edges 01 12 20.
  Eigen::MatrixXi triangles;
  std::vector<int> element;  // the element that each triangle bounds

  int num_triangles() const { return static_cast<int>(triangles.cols()); }
  int order() const { return triangles.rows() == 6 ? 2 : 1; }
};

Surface ExtractSurface(const TetMesh& mesh);

// A material point of the surface.
struct SurfacePoint {
  int triangle = -1;
  Eigen::Vector3d barycentric = Eigen::Vector3d::Constant(NAN);  // of the triangle's corners, sum 1
};

// Values of nodal shape functions, or means of them over a patch: a linear map from nodal vectors
// to one vector of the body (a row of the paper's H). The weights add up to 1.
struct NodalWeights {
  std::vector<int> nodes;       // each node once, ascending
  std::vector<double> weights;  // same length

  // Σ w_i · column i of a nodal field (3×N): position, displacement, …
  Eigen::Vector3d Apply(const Eigen::Matrix3Xd& field) const;
};

NodalWeights ShapeFunctions(const Surface& surface, const SurfacePoint& point);

// How they change along the columns of `directions` (3×k) as the point moves over its flat triangle
// (nodes at X, straight edges): a row per node of ShapeFunctions, 1/m.
Eigen::MatrixXd ShapeFunctionSlopes(const Surface& surface, const Eigen::Matrix3Xd& X,
                                    const SurfacePoint& point, const Eigen::Matrix3Xd& directions);

// Where a surface point is when the nodes stand at `x` (3×N, m).
Eigen::Vector3d Position(const Surface& surface, const Eigen::Matrix3Xd& x,
                         const SurfacePoint& point);

// The outward unit normal there.
Eigen::Vector3d Normal(const Surface& surface, const Eigen::Matrix3Xd& x,
                       const SurfacePoint& point);

struct SurfaceProjection {
  SurfacePoint at;
  Eigen::Vector3d position;  // m
  double distance;           // m, unsigned
};

// The surface point closest to p when the nodes stand at `x`. For order 2 the flat triangle through
// the corners is searched, which is exact while edges are straight (a body at rest).
SurfaceProjection ClosestSurfacePoint(const Surface& surface, const Eigen::Matrix3Xd& x,
                                      const Eigen::Vector3d& p);

// The mean of the shape functions over a flat disc of the given diameter (m) around a surface point
// of the body at rest (nodes at X): how a force spread evenly over the disc acts on the nodes, and
// equally the mean position of the disc. Parts of the disc beyond an edge of the body count at the
// nearest place of the surface. Diameter 0 is the point itself.
NodalWeights PatchWeights(const Surface& surface, const Eigen::Matrix3Xd& X,
                          const SurfacePoint& centre, double diameter);

// The same, and how the weights change (1/m, a row per node) as the disc moves along the columns of
// `directions` (3×k).
struct MovingPatch {
  NodalWeights weights;
  Eigen::MatrixXd slopes;
};
MovingPatch MovingPatchWeights(const Surface& surface, const Eigen::Matrix3Xd& X,
                               const SurfacePoint& centre, double diameter,
                               const Eigen::Matrix3Xd& directions);

}  // namespace softforce::mesh
