#include "mesh/connectivity.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>

namespace softforce::mesh {

std::vector<TrianglePair> Neighbours(const Surface& surface) {
  struct Side {
    std::array<int, 2> ends;
    int triangle;
  };
  std::vector<Side> sides;
  for (int t = 0; t < surface.num_triangles(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax({surface.triangles(i, t), surface.triangles((i + 1) % 3, t)});
      sides.push_back({{a, b}, t});
    }
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.ends < b.ends; });
  std::vector<TrianglePair> pairs;
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last = std::find_if(first, sides.end(),
                                   [&](const Side& side) { return side.ends != first->ends; });
    if (last - first == 2) pairs.push_back({first->triangle, (first + 1)->triangle});
    first = last;
  }
  return pairs;
}

Eigen::Matrix3Xd FlatNormals(const Surface& surface, const Eigen::Matrix3Xd& x) {
  Eigen::Matrix3Xd normals(3, surface.num_triangles());
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const Eigen::Vector3d a = x.col(surface.triangles(0, t));
    const Eigen::Vector3d b = x.col(surface.triangles(1, t));
    const Eigen::Vector3d c = x.col(surface.triangles(2, t));
    normals.col(t) = (b - a).cross(c - a).normalized();
  }
  return normals;
}

std::vector<int> SurfaceParts(const Surface& surface) {
  DisjointSets parts(surface.num_triangles());
  for (const TrianglePair& pair : Neighbours(surface)) parts.Join(pair.first, pair.second);
  return parts.Numbers();
}

std::vector<double> EnclosedVolumes(const Surface& surface, const Eigen::Matrix3Xd& x,
                                    const std::vector<int>& part) {
  std::vector<double> volumes;
  const Eigen::Vector3d centre = x.rowwise().mean();  // near the body, for less rounding
  for (int t = 0; t < surface.num_triangles(); ++t) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = x.col(surface.triangles(i, t)) - centre;
    if (part[t] >= static_cast<int>(volumes.size())) volumes.resize(part[t] + 1, 0);
    volumes[part[t]] += corners.determinant() / 6;
  }
  return volumes;
}

}  // namespace softforce::mesh
