#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace softforce::mesh {

// A body cut into tetrahedra of 4 nodes (order 1) or 10 nodes (order 2, straight or curved edges).
// Elements list their corners 0 1 2 3 with positive volume, then for order 2 the nodes in the
// middle of the edges 01 12 20 03 13 23 (the order of VTK; Gmsh's differs in the last two).
struct TetMesh {
  Eigen::Matrix3Xd nodes;                 // m, robot frame
  Eigen::MatrixXi elements;               // 4×E or 10×E
  std::vector<int> region;                // of each element: index into region_names
  std::vector<std::string> region_names;  // physical volumes; "" where the file names none
  // Named parts of the surface: the corner nodes of their triangles, in no particular orientation.
  std::map<std::string, std::vector<std::array<int, 3>>> surface_groups;

  int order() const { return elements.rows() == 10 ? 2 : 1; }
  int num_nodes() const { return static_cast<int>(nodes.cols()); }
  int num_elements() const { return static_cast<int>(elements.cols()); }
};

// The edges whose middle nodes are numbers 4 … 9 of a 10-node element.
inline constexpr std::array<std::array<int, 2>, 6> kEdges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

// A triangle's corners in ascending order, to find it whichever way it is written.
std::array<int, 3> Sorted(std::array<int, 3> corners);

// The same cells with 10 nodes each: a node is added in the middle of every edge. A mesh that has
// 10-node elements already is returned as it is.
TetMesh RaiseOrder(const TetMesh& mesh);

// The same cells with their corner nodes only (nodes renumbered).
TetMesh LowerOrder(const TetMesh& mesh);

// One or the other: `order` is 1 or 2.
TetMesh WithOrder(const TetMesh& mesh, int order);

// Refuses a mesh that no simulation can use: coordinates that are not finite, nodes that no element
// uses, elements that name a node twice or are inverted (volume ≤ 0). Throws InputError naming
// `where` and the offending node or element with its position in millimetres.
void CheckMesh(const TetMesh& mesh, const std::string& where);

}  // namespace softforce::mesh
