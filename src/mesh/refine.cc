#include "softforce/mesh/refine.h"

#include <algorithm>
#include <tuple>

#include "mesh/subdivide.h"
#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

// An edge's place in the order in which cells are cut: longest first, ties by the nodes' numbers.
using EdgeRank = std::tuple<double, int, int>;

EdgeRank RankOf(const TetMesh& mesh, int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return {(mesh.nodes.col(low) - mesh.nodes.col(high)).squaredNorm(), low, high};
}

// Which middle nodes become corners: those of marked cells, and the longest edge's of every cell
// that has another.
std::vector<char> CutEdges(const TetMesh& raised, const std::vector<char>& marked) {
  std::vector<char> cut(raised.num_nodes(), false);
  std::vector<int> longest(raised.num_elements());
  for (int e = 0; e < raised.num_elements(); ++e) {
    EdgeRank best{-1, 0, 0};
    for (int i = 0; i < 6; ++i) {
      if (marked[e]) cut[raised.elements(4 + i, e)] = true;
      const EdgeRank rank =
          RankOf(raised, raised.elements(kEdges[i][0], e), raised.elements(kEdges[i][1], e));
      if (rank > best) {
        best = rank;
        longest[e] = raised.elements(4 + i, e);
      }
    }
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (int e = 0; e < raised.num_elements(); ++e) {
      const auto middles = raised.elements.col(e).tail<6>();
      const bool any = std::any_of(middles.begin(), middles.end(), [&](int n) { return cut[n]; });
      if (!any || cut[longest[e]]) continue;
      cut[longest[e]] = changed = true;
    }
  }
  return cut;
}

// Bisects a part of a cell at its highest-ranking cut edge, and its halves likewise. How a face is
// cut depends on its own edges only, so neighbours agree.
void Bisect(const TetMesh& raised, int element, const std::vector<char>& cut, const Part& part,
            std::vector<Part>* parts) {
  EdgeRank best{-1, 0, 0};
  int best_edge = -1;
  for (int i = 0; i < 6; ++i) {  // of the cell; those that are still whole in this part
    const auto has = [&](int node) {
      return std::find(part.begin(), part.end(), node) != part.end();
    };
    if (!cut[raised.elements(4 + i, element)] || !has(kEdges[i][0]) || !has(kEdges[i][1])) continue;
    const EdgeRank rank = RankOf(raised, raised.elements(kEdges[i][0], element),
                                 raised.elements(kEdges[i][1], element));
    if (rank > best) {
      best = rank;
      best_edge = i;
    }
  }
  if (best_edge < 0) {
    parts->push_back(part);
    return;
  }
  for (const int end : kEdges[best_edge]) {
    Part half = part;
    std::replace(half.begin(), half.end(), end, 4 + best_edge);
    Bisect(raised, element, cut, half, parts);
  }
}

}  // namespace

Refinement Refine(const TetMesh& mesh) {
  const TetMesh raised = RaiseOrder(mesh);
  // Middle nodes opposite each other in the octahedron, and the other four in a circle around.
  struct Diagonal {
    int from, to;
    std::array<int, 4> circle;
  };
  constexpr std::array<Diagonal, 3> kDiagonals{
      {{4, 9, {5, 6, 7, 8}}, {5, 7, {4, 6, 9, 8}}, {6, 8, {4, 5, 9, 7}}}};
  return Subdivide(mesh, raised, [&](int e) {
    std::vector<Part> parts{{0, 4, 6, 7}, {1, 5, 4, 8}, {2, 6, 5, 9}, {3, 7, 8, 9}};
    const auto length = [&](const Diagonal& diagonal) {
      return (raised.nodes.col(raised.elements(diagonal.from, e)) -
              raised.nodes.col(raised.elements(diagonal.to, e)))
          .squaredNorm();
    };
    const Diagonal& shortest =
        *std::min_element(kDiagonals.begin(), kDiagonals.end(),
                          [&](const auto& a, const auto& b) { return length(a) < length(b); });
    for (int i = 0; i < 4; ++i) {
      parts.push_back(
          {shortest.from, shortest.to, shortest.circle[i], shortest.circle[(i + 1) % 4]});
    }
    return parts;
  });
}

Refinement RefineWhere(const TetMesh& mesh, const std::vector<char>& marked) {
  if (static_cast<int>(marked.size()) != mesh.num_elements()) {
    throw base::InputError("RefineWhere", "needs one flag per cell of the mesh");
  }
  const TetMesh raised = RaiseOrder(mesh);
  const std::vector<char> cut = CutEdges(raised, marked);
  return Subdivide(mesh, raised, [&](int e) {
    std::vector<Part> parts;
    Bisect(raised, e, cut, {0, 1, 2, 3}, &parts);
    return parts;
  });
}

}  // namespace softforce::mesh
