#include <fmt/format.h>

#include <algorithm>

#include "mesh/jacobian.h"
#include "mesh/millimetres.h"
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

Eigen::Vector3d CornerMean(const TetMesh& mesh, int e) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) sum += mesh.nodes.col(mesh.elements(i, e));
  return sum / 4;
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
      where,
      Where(mesh.num_elements(), [&](int e) { return !(JacobianRangeOf(mesh, e).least > 0); }),
      [&](int e) {
        return fmt::format(
            "element {} at {} is inverted or flat: its volume is {:.3g} mm^3, must "
            "be positive everywhere in it",
            e, InMillimetres(CornerMean(mesh, e)), 1e9 * JacobianRangeOf(mesh, e).least / 6);
      },
      "Mesh the body again, and optimise the mesh (in Gmsh: Mesh.Optimize = 1, and for curved "
      "10-node elements Mesh.HighOrderOptimize = 1).");
}

}  // namespace softforce::mesh
