#include "mesh/thickness.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mesh/connectivity.h"

namespace softforce::mesh {
namespace {

// Corners of the face opposite to each corner, counter-clockwise seen from outside.
constexpr int kOpposite[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

std::array<int, 3> FaceOf(const TetMesh& mesh, int e, int f) {
  std::array<int, 3> nodes{};
  for (int i = 0; i < 3; ++i) nodes[i] = mesh.elements(kOpposite[f][i], e);
  return nodes;
}

// The face (4 · element + number) on the other side of each face, or -1.
std::vector<int> OtherSides(const TetMesh& mesh) {
  struct Face {
    std::array<int, 3> nodes;
    int index;
  };
  std::vector<Face> faces;
  for (int index = 0; index < 4 * mesh.num_elements(); ++index) {
    faces.push_back({FaceOf(mesh, index / 4, index % 4), index});
    std::sort(faces.back().nodes.begin(), faces.back().nodes.end());
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.nodes < b.nodes; });
  std::vector<int> other(faces.size(), -1);
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    if (faces[i].nodes != faces[i + 1].nodes) continue;
    other[faces[i].index] = faces[i + 1].index;
    other[faces[i + 1].index] = faces[i].index;
  }
  return other;
}

struct Exit {
  std::array<int, 3> nodes;
  Eigen::Vector3d point, normal;
};

// Follows a ray from the inner side of face `entry` of element e to the surface.
Exit Leave(const TetMesh& mesh, const std::vector<int>& other, int face,
           const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  for (int step = 0;; ++step) {
    const int e = face / 4;
    Exit exit;
    double shortest = INFINITY;
    int out = -1;
    for (int f = 0; f < 4; ++f) {
      if (4 * e + f == face) continue;
      const auto nodes = FaceOf(mesh, e, f);
      const Eigen::Vector3d a = mesh.nodes.col(nodes[0]);
      const Eigen::Vector3d normal = (Eigen::Vector3d(mesh.nodes.col(nodes[1])) - a)
                                         .cross(Eigen::Vector3d(mesh.nodes.col(nodes[2])) - a)
                                         .normalized();
      const double towards = normal.dot(direction);
      const double length = normal.dot(a - origin) / towards;
      if (!(towards > 0) || !(length < shortest)) continue;
      shortest = length;
      out = 4 * e + f;
      exit = {nodes, origin + length * direction, normal};
    }
    // A ray through an edge may by rounding run in a circle between the elements around it.
    if (out < 0 || step > mesh.num_elements()) return {{-1, -1, -1}, origin, direction};
    if (other[out] < 0) return exit;
    face = other[out];
  }
}

// Nodes joined to each node by an edge.
std::vector<std::vector<int>> Adjacency(const TetMesh& mesh) {
  std::vector<std::vector<int>> adjacent(mesh.num_nodes());
  for (int e = 0; e < mesh.num_elements(); ++e) {
    for (const auto& [a, b] : kEdges) {
      adjacent[mesh.elements(a, e)].push_back(mesh.elements(b, e));
      adjacent[mesh.elements(b, e)].push_back(mesh.elements(a, e));
    }
  }
  for (auto& nodes : adjacent) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  return adjacent;
}

bool Contains(const std::vector<int>& sorted, int value) {
  return std::binary_search(sorted.begin(), sorted.end(), value);
}

// Edges on the shortest way between two triangles: 0, 1, 2, or 3 for more.
int EdgesBetween(const std::vector<std::vector<int>>& adjacent, const std::array<int, 3>& from,
                 const std::array<int, 3>& to) {
  int edges = 3;
  for (const int a : from) {
    for (const int b : to) {
      if (a == b) return 0;
      if (edges > 1 && Contains(adjacent[a], b)) edges = 1;
      for (std::size_t i = 0; edges > 2 && i < adjacent[a].size(); ++i) {
        if (Contains(adjacent[b], adjacent[a][i])) edges = 2;
      }
    }
  }
  return edges;
}

}  // namespace

Thickness MeasureThickness(const TetMesh& mesh, const Surface& surface) {
  const std::vector<int> other = OtherSides(mesh);
  const auto adjacent = Adjacency(mesh);
  const Eigen::Matrix3Xd normals = FlatNormals(surface, mesh.nodes);
  Thickness thickness;
  std::array<double, 4> areas{};  // with so many cells across
  for (int t = 0; t < surface.num_triangles(); ++t) {
    std::array<int, 3> corners{};
    for (int i = 0; i < 3; ++i) corners[i] = surface.triangles(i, t);
    int face = 4 * surface.element[t];
    const auto is_corner = [&](int i) {
      const int node = mesh.elements(i, surface.element[t]);
      return std::find(corners.begin(), corners.end(), node) != corners.end();
    };
    while (is_corner(face % 4)) ++face;  // the corner opposite to the triangle numbers its face

    const Eigen::Vector3d a = mesh.nodes.col(corners[0]), b = mesh.nodes.col(corners[1]);
    const Eigen::Vector3d c = mesh.nodes.col(corners[2]), middle = (a + b + c) / 3;
    const Exit exit = Leave(mesh, other, face, middle, -normals.col(t));
    if (exit.nodes[0] < 0 || exit.normal.dot(normals.col(t)) > -0.5) continue;
    const int cells = EdgesBetween(adjacent, corners, exit.nodes);
    if (cells == 0) continue;  // the tip of a wedge, which is thin at any cell size
    areas[cells] += (b - a).cross(c - a).norm() / 2;
    const double length = (exit.point - middle).norm();
    if (length < thickness.thinnest) {
      thickness.thinnest = length;
      thickness.thinnest_at = (exit.point + middle) / 2;
    }
  }
  const double sum = areas[1] + areas[2] + areas[3];
  if (sum == 0) return thickness;
  thickness.one_cell = areas[1] / sum;
  thickness.two_cells = areas[2] / sum;
  thickness.more_cells = areas[3] / sum;
  return thickness;
}

}  // namespace softforce::mesh
