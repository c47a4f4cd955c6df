#include "render/surface_edges.h"

#include <algorithm>
#include <tuple>

namespace softforce::render {
namespace {

std::vector<Edge> CollectEdges(const mesh::Surface& surface) {
  std::vector<Edge> edges;
  edges.reserve(3 * surface.num_triangles());
  for (int t = 0; t < surface.num_triangles(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] =
          std::minmax(surface.triangles(i, t), surface.triangles((i + 1) % 3, t));
      const int middle = surface.order() == 2 ? surface.triangles(3 + i, t) : -1;
      edges.push_back({low, high, middle, t, -1});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.first, a.second, a.triangle) < std::tie(b.first, b.second, b.triangle);
  });
  size_t kept = 0;
  for (const Edge& edge : edges) {
    Edge* last = kept > 0 ? &edges[kept - 1] : nullptr;
    if (last && last->first == edge.first && last->second == edge.second) {
      last->other_triangle = edge.triangle;
    } else {
      edges[kept++] = edge;
    }
  }
  edges.resize(kept);
  return edges;
}

}  // namespace

const std::vector<Edge>& SurfaceEdges::Of(const mesh::Surface& surface) {
  const bool same = triangles_.rows() == surface.triangles.rows() &&
                    triangles_.cols() == surface.triangles.cols() &&
                    triangles_ == surface.triangles;
  if (!same) {
    triangles_ = surface.triangles;
    edges_ = CollectEdges(surface);
  }
  return edges_;
}

}  // namespace softforce::render
