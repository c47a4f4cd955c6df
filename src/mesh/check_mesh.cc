#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>

#include "softforce/base/input_error.h"
#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {
namespace {

// Refuses the mesh if there are offenders: tells of the first one, and how many more there are.
template <typename Describe>
void RefuseIfAny(const std::string& where, const std::vector<int>& offenders, Describe describe,
                 const std::string& advice) {
  if (offenders.empty()) return;
  std::string problem = describe(offenders[0]);
  if (offenders.size() > 1) problem += fmt::format("; so are {} more", offenders.size() - 1);
  throw base::InputError(where, problem, advice);
}

std::string InMillimetres(const Eigen::Vector3d& p) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) mm", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
}

Eigen::Vector3d CornerMean(const TetMesh& mesh, int e) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) sum += mesh.nodes.col(mesh.elements(i, e));
  return sum / 4;
}

// Six times the volume per unit of the reference element, at its local node `at`: for 10-node
// elements with curved edges it differs from place to place.
double Jacobian(const TetMesh& mesh, int e, int at) {
  Eigen::Matrix3d J;
  const auto node = [&](int i) -> Eigen::Vector3d { return mesh.nodes.col(mesh.elements(i, e)); };
  if (mesh.order() == 1) {
    for (int i = 0; i < 3; ++i) J.col(i) = node(i + 1) - node(0);
    return J.determinant();
  }
  Eigen::Vector4d L = Eigen::Vector4d::Zero();
  if (at < 4) {
    L(at) = 1;
  } else {
    for (const int corner : kEdges[at - 4]) L(corner) = 0.5;
  }
  Eigen::Matrix<double, 3, 4> dx;  // along each barycentric coordinate
  for (int i = 0; i < 4; ++i) dx.col(i) = (4 * L(i) - 1) * node(i);
  for (int i = 0; i < 6; ++i) {
    const auto [a, b] = kEdges[i];
    dx.col(a) += 4 * L(b) * node(4 + i);
    dx.col(b) += 4 * L(a) * node(4 + i);
  }
  for (int i = 0; i < 3; ++i) J.col(i) = dx.col(i + 1) - dx.col(0);
  return J.determinant();
}

double LeastJacobian(const TetMesh& mesh, int e) {
  double least = Jacobian(mesh, e, 0);
  for (int at = 1; mesh.order() == 2 && at < 10; ++at) {
    least = std::min(least, Jacobian(mesh, e, at));
  }
  return least;
}

bool NamesANodeTwice(const TetMesh& mesh, int e) {
  Eigen::VectorXi nodes = mesh.elements.col(e);
  std::sort(nodes.begin(), nodes.end());
  return std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end();
}

template <typename Predicate>
std::vector<int> Where(int count, Predicate predicate) {
  std::vector<int> found;
  for (int i = 0; i < count; ++i) {
    if (predicate(i)) found.push_back(i);
  }
  return found;
}

}  // namespace

void CheckMesh(const TetMesh& mesh, const std::string& where) {
  if (mesh.num_elements() == 0) {
    throw base::InputError(where, "has no tetrahedra", "Mesh the volume, not only its surface.");
  }
  RefuseIfAny(
      where, Where(mesh.num_nodes(), [&](int n) { return !mesh.nodes.col(n).allFinite(); }),
      [&](int n) {
        return fmt::format("node {} stands at {}, its coordinates must be finite", n,
                           InMillimetres(mesh.nodes.col(n)));
      },
      "Export the mesh again.");

  std::vector<char> used(mesh.num_nodes(), false);
  for (const int node : mesh.elements.reshaped()) used[node] = true;
  RefuseIfAny(
      where, Where(mesh.num_nodes(), [&](int n) { return !used[n]; }),
      [&](int n) {
        return fmt::format("node {} at {} belongs to no tetrahedron", n,
                           InMillimetres(mesh.nodes.col(n)));
      },
      // Gmsh's optimiser itself leaves such nodes behind; its format 2.2 does not keep them.
      "Remove them, in Gmsh for example with: gmsh -save -format msh22 IN -o OUT.msh");

  RefuseIfAny(
      where, Where(mesh.num_elements(), [&](int e) { return NamesANodeTwice(mesh, e); }),
      [&](int e) {
        return fmt::format("element {} at {} names a node twice, its nodes must differ", e,
                           InMillimetres(CornerMean(mesh, e)));
      },
      "Mesh the body again; the file may have been merged carelessly.");

  RefuseIfAny(
      where, Where(mesh.num_elements(), [&](int e) { return !(LeastJacobian(mesh, e) > 0); }),
      [&](int e) {
        return fmt::format(
            "element {} at {} is inverted or flat: its volume is {:.3g} mm^3, must "
            "be positive everywhere in it",
            e, InMillimetres(CornerMean(mesh, e)), 1e9 * LeastJacobian(mesh, e) / 6);
      },
      "Mesh the body again, and optimise the mesh (in Gmsh: Mesh.Optimize = 1, and for curved "
      "10-node elements Mesh.HighOrderOptimize = 1).");
}

}  // namespace softforce::mesh
