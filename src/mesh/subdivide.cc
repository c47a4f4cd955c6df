#include "mesh/subdivide.h"

#include <Eigen/LU>
#include <algorithm>
#include <cstdint>
#include <set>
#include <unordered_map>
#include <utility>

#include "softforce/mesh/tet_shapes.h"

namespace softforce::mesh {
namespace {

using Corners = std::array<int, 3>;  // of a triangle, ascending

// Barycentric coordinates of a cell's ten nodes in the cell, as columns.
const Eigen::Matrix<double, 4, 10>& NodeBarycentrics() {
  static const Eigen::Matrix<double, 4, 10> barycentrics = [] {
    Eigen::Matrix<double, 4, 10> b = Eigen::Matrix<double, 4, 10>::Zero();
    b.leftCols<4>().setIdentity();
    for (int i = 0; i < 6; ++i) b(kEdges[i][0], 4 + i) = b(kEdges[i][1], 4 + i) = 0.5;
    return b;
  }();
  return barycentrics;
}

// The point of a 10-node cell at barycentric coordinates.
Eigen::Vector3d PointIn(const TetMesh& mesh, int element, const Eigen::Vector4d& at) {
  return mesh.nodes(Eigen::all, mesh.elements.col(element)) * TetShapes(2, at);
}

// The same part with its corners in positive order.
Part Oriented(Part part) {
  Eigen::Matrix4d corners;
  for (int i = 0; i < 4; ++i) corners.col(i) = NodeBarycentrics().col(part[i]);
  if (corners.determinant() < 0) std::swap(part[2], part[3]);
  return part;
}

// Builds a mesh of parts of the cells of a 10-node mesh.
class Subdivision {
 public:
  Subdivision(const TetMesh& coarse, const PartsOf& parts_of) : coarse_(coarse) {
    for (int e = 0; e < coarse.num_elements(); ++e) {
      for (const Part& part : parts_of(e)) {
        parts_.push_back(Oriented(part));
        result_.parent.push_back(e);
        result_.corners.emplace_back();
        for (int i = 0; i < 4; ++i) {
          result_.corners.back()[i] = NodeBarycentrics().col(parts_.back()[i]);
        }
      }
    }
    NumberCorners();
    result_.mesh.region_names = coarse.region_names;
    for (const int e : result_.parent) result_.mesh.region.push_back(coarse.region[e]);
    CutGroups();
  }

  Refinement WithFourNodes() && {
    result_.mesh.elements = std::move(corners_);
    return std::move(result_);
  }

  Refinement WithTenNodes() &&;

 private:
  void NumberCorners();
  void CutGroups();

  const TetMesh& coarse_;  // 10-node cells
  std::vector<Part> parts_;
  std::vector<int> number_;  // new number of each coarse node; −1 if it is no corner
  Eigen::MatrixXi corners_;  // 4×parts, new numbers
  Refinement result_;
};

// In the order of the coarse nodes, whose corners come first.
void Subdivision::NumberCorners() {
  number_.assign(coarse_.num_nodes(), -1);
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    for (const int i : parts_[p]) number_[coarse_.elements(i, result_.parent[p])] = 0;
  }
  int next = 0;
  result_.mesh.nodes.resize(3, coarse_.num_nodes());
  for (int node = 0; node < coarse_.num_nodes(); ++node) {
    if (number_[node] < 0) continue;
    result_.mesh.nodes.col(next) = coarse_.nodes.col(node);
    number_[node] = next++;
  }
  result_.mesh.nodes.conservativeResize(3, next);
  corners_.resize(4, static_cast<Eigen::Index>(parts_.size()));
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    for (int i = 0; i < 4; ++i) {
      corners_(i, static_cast<Eigen::Index>(p)) =
          number_[coarse_.elements(parts_[p][i], result_.parent[p])];
    }
  }
}

// A part's face lies in the cell's face opposite corner c if the c-th barycentric coordinate of its
// corners is zero. A face between two cells is cut the same in both, so the first one counts.
void Subdivision::CutGroups() {
  std::vector<std::vector<int>> parts_of(coarse_.num_elements());
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    parts_of[result_.parent[p]].push_back(static_cast<int>(p));
  }
  for (const auto& [name, triangles] : coarse_.surface_groups) {
    auto& cut = result_.mesh.surface_groups[name];
    std::set<Corners> wanted;
    for (Corners triangle : triangles) {
      std::sort(triangle.begin(), triangle.end());
      wanted.insert(triangle);
    }
    for (int e = 0; e < coarse_.num_elements(); ++e) {
      for (int c = 0; c < 4; ++c) {
        Corners face{coarse_.elements((c + 1) % 4, e), coarse_.elements((c + 2) % 4, e),
                     coarse_.elements((c + 3) % 4, e)};
        std::sort(face.begin(), face.end());
        if (wanted.erase(face) == 0) continue;
        for (const int p : parts_of[e]) {
          for (int omitted = 0; omitted < 4; ++omitted) {
            Corners triangle;
            bool inside = true;
            for (int i = 0, k = 0; i < 4; ++i) {
              if (i == omitted) continue;
              inside = inside && NodeBarycentrics()(c, parts_[p][i]) == 0;
              triangle[k++] = corners_(i, p);
            }
            if (inside) cut.push_back(triangle);
          }
        }
      }
    }
  }
}

// Middle nodes are numbered as their edges first occur.
Refinement Subdivision::WithTenNodes() && {
  TetMesh& fine = result_.mesh;
  fine.elements.resize(10, corners_.cols());
  fine.elements.topRows(4) = corners_;
  std::unordered_map<std::uint64_t, int> middle_of_edge;
  std::vector<Eigen::Vector3d> middles;
  const int num_corners = fine.num_nodes();
  for (int p = 0; p < corners_.cols(); ++p) {
    for (int i = 0; i < 6; ++i) {
      const auto [from, to] = kEdges[i];
      const int a = corners_(from, p), b = corners_(to, p);
      const auto key = std::uint64_t(std::min(a, b)) << 32 | std::uint64_t(std::max(a, b));
      const auto [entry, is_new] =
          middle_of_edge.try_emplace(key, num_corners + static_cast<int>(middles.size()));
      if (is_new) {
        const Eigen::Vector4d at =
            (NodeBarycentrics().col(parts_[p][from]) + NodeBarycentrics().col(parts_[p][to])) / 2;
        middles.push_back(PointIn(coarse_, result_.parent[p], at));
      }
      fine.elements(4 + i, p) = entry->second;
    }
  }
  fine.nodes.conservativeResize(3, num_corners + static_cast<int>(middles.size()));
  for (std::size_t i = 0; i < middles.size(); ++i) {
    fine.nodes.col(num_corners + static_cast<int>(i)) = middles[i];
  }
  return std::move(result_);
}

}  // namespace

Refinement Subdivide(const TetMesh& mesh, const TetMesh& raised, const PartsOf& parts_of) {
  Subdivision subdivision(raised, parts_of);
  return mesh.order() == 2 ? std::move(subdivision).WithTenNodes()
                           : std::move(subdivision).WithFourNodes();
}

}  // namespace softforce::mesh
