#include "mesh/overlap.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "softforce/mesh/disjoint_sets.h"

namespace softforce::mesh {
namespace {

using Corners = Eigen::Matrix<double, 3, 4>;
using Bucket = std::array<int, 3>;

Corners CornersOf(const TetMesh& mesh, int e) {
  Corners corners;
  for (int i = 0; i < 4; ++i) corners.col(i) = mesh.nodes.col(mesh.elements(i, e));
  return corners;
}

bool Holds(const Corners& corners, const Eigen::Vector3d& p) {
  constexpr double kInside = 1e-6;  // of the barycentric coordinates; a common face is no overlap
  const Eigen::Matrix3d edges = corners.rightCols<3>().colwise() - corners.col(0);
  const Eigen::Vector3d b = edges.inverse() * (p - corners.col(0));
  return b.minCoeff() > kInside && b.sum() < 1 - kInside;
}

// Cells by the cubes of a grid that their bounding boxes reach into.
class CellGrid {
 public:
  explicit CellGrid(const TetMesh& mesh) {
    double sum = 0;
    for (int e = 0; e < mesh.num_elements(); ++e) sum += Extent(CornersOf(mesh, e)).maxCoeff();
    side_ = sum / mesh.num_elements();
    for (int e = 0; e < mesh.num_elements(); ++e) {
      const Corners corners = CornersOf(mesh, e);
      const Bucket low = BucketOf(corners.rowwise().minCoeff());
      const Bucket high = BucketOf(corners.rowwise().maxCoeff());
      for (int x = low[0]; x <= high[0]; ++x) {
        for (int y = low[1]; y <= high[1]; ++y) {
          for (int z = low[2]; z <= high[2]; ++z) cells_[{x, y, z}].push_back(e);
        }
      }
    }
  }

  const std::vector<int>& Near(const Eigen::Vector3d& p) const {
    static const std::vector<int> none;
    const auto found = cells_.find(BucketOf(p));
    return found == cells_.end() ? none : found->second;
  }

 private:
  static Eigen::Vector3d Extent(const Corners& corners) {
    return corners.rowwise().maxCoeff() - corners.rowwise().minCoeff();
  }
  Bucket BucketOf(const Eigen::Vector3d& p) const {
    const Eigen::Array3i bucket = (p / side_).array().floor().cast<int>();
    return {bucket.x(), bucket.y(), bucket.z()};
  }

  double side_ = 0;  // m
  std::map<Bucket, std::vector<int>> cells_;
};

}  // namespace

Overlap FindOverlap(const TetMesh& mesh) {
  DisjointSets joined(mesh.num_nodes());
  for (int e = 0; e < mesh.num_elements(); ++e) {
    for (int i = 1; i < mesh.elements.rows(); ++i) {
      joined.Join(mesh.elements(0, e), mesh.elements(i, e));
    }
  }
  const std::vector<int> part = joined.Numbers();
  Overlap overlap;
  if (*std::max_element(part.begin(), part.end()) == 0) return overlap;
  const CellGrid grid(mesh);
  for (int e = 0; e < mesh.num_elements(); ++e) {
    // Near the centre, but not on the faces of an equal mesh that is shifted by half a cell.
    const Eigen::Vector3d centre = CornersOf(mesh, e) * Eigen::Vector4d(0.33, 0.27, 0.22, 0.18);
    const std::vector<int>& near = grid.Near(centre);
    const bool inside = std::any_of(near.begin(), near.end(), [&](int other) {
      return part[mesh.elements(0, other)] != part[mesh.elements(0, e)] &&
             Holds(CornersOf(mesh, other), centre);
    });
    if (inside && overlap.cells++ == 0) overlap.at = centre;
  }
  return overlap;
}

}  // namespace softforce::mesh
