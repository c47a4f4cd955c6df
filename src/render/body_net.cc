#include "render/body_net.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "render/palette.h"
#include "render/stroke.h"

namespace softforce::render {
namespace {

constexpr double kRidgeOpacity = 0.75;
constexpr double kRidge = 0.8;  // cosine of the angle between the faces of an edge to be stressed

struct Edge {
  int first, second;             // nodes at its ends, first < second
  int middle;                    // node, or -1 in surfaces of order 1
  int triangle, other_triangle;  // other_triangle is -1 at the rim of an open surface
};

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

Eigen::Vector3d FaceNormal(const mesh::Surface& surface, const Eigen::Matrix3Xd& x, int triangle) {
  const Eigen::Vector3d a = x.col(surface.triangles(0, triangle));
  const Eigen::Vector3d b = x.col(surface.triangles(1, triangle));
  const Eigen::Vector3d c = x.col(surface.triangles(2, triangle));
  return (b - a).cross(c - a).normalized();
}

bool IsStressed(const Edge& edge, const mesh::Surface& surface, const Eigen::Matrix3Xd& x,
                const std::vector<bool>& faces_camera) {
  if (edge.other_triangle < 0) return true;
  if (faces_camera[edge.triangle] != faces_camera[edge.other_triangle]) return true;
  return FaceNormal(surface, x, edge.triangle).dot(FaceNormal(surface, x, edge.other_triangle)) <
         kRidge;
}

// Outside faces list their corners counter-clockwise as seen, which is clockwise with y downwards.
bool FacesCamera(const Sight& a, const Sight& b, const Sight& c) {
  if (!a.visible || !b.visible || !c.visible) return false;
  return (b.pixel - a.pixel).cross(c.pixel - a.pixel) < 0;
}

// A 6-node triangle is four flat ones.
constexpr std::array<std::array<int, 3>, 4> kPieces{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};

int PiecesPerTriangle(const mesh::Surface& surface) { return surface.order() == 1 ? 1 : 4; }

}  // namespace

int NumPieces(const mesh::Surface& surface) {
  return PiecesPerTriangle(surface) * surface.num_triangles();
}

std::array<int, 3> NodesOfPiece(const mesh::Surface& surface, int piece) {
  const int per_triangle = PiecesPerTriangle(surface);
  const auto nodes = surface.triangles.col(piece / per_triangle);
  if (per_triangle == 1) return {nodes(0), nodes(1), nodes(2)};
  const std::array<int, 3>& corners = kPieces[piece % per_triangle];
  return {nodes(corners[0]), nodes(corners[1]), nodes(corners[2])};
}

BodyPicture PictureBody(const View& view, const mesh::Surface& surface, const Eigen::Matrix3Xd& x) {
  BodyPicture body{std::vector<Sight>(x.cols()), std::vector<bool>(surface.num_triangles()),
                   DepthBuffer(view.size)};
  std::vector<bool> seen(x.cols(), false);
  for (const int node : surface.triangles.reshaped()) {
    if (!seen[node]) body.nodes[node] = See(view, x.col(node));
    seen[node] = true;
  }
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const auto corner = [&](int i) -> const Sight& { return body.nodes[surface.triangles(i, t)]; };
    body.faces_camera[t] = FacesCamera(corner(0), corner(1), corner(2));
  }
  const int pieces = NumPieces(surface);
  for (int p = 0; p < pieces; ++p) {
    const std::array<int, 3> nodes = NodesOfPiece(surface, p);
    const Sight &a = body.nodes[nodes[0]], &b = body.nodes[nodes[1]], &c = body.nodes[nodes[2]];
    if (FacesCamera(a, b, c)) body.depth.AddTriangle(a, b, c, p);
  }
  return body;
}

void DrawNet(Brush* brush, const View& view, const mesh::Surface& surface,
             const Eigen::Matrix3Xd& x, const BodyPicture& body, const cv::Vec3b& colour,
             double opacity) {
  std::vector<Edge> edges = CollectEdges(surface);
  edges.erase(
      std::remove_if(edges.begin(), edges.end(),
                     [&](const Edge& edge) {
                       return !body.faces_camera[edge.triangle] &&
                              (edge.other_triangle < 0 || !body.faces_camera[edge.other_triangle]);
                     }),
      edges.end());
  const auto draw = [&](int from, int to, double width) {
    const Sight& a = body.nodes[from];
    const Sight& b = body.nodes[to];
    if (!a.visible || !b.visible) return;
    for (const Stroke& stroke : CutByVisibility(body.depth, a, b)) {
      if (!stroke.hidden) brush->Polyline(stroke.points, width);
    }
  };
  for (const bool stressed : {false, true}) {
    for (const Edge& edge : edges) {
      if (IsStressed(edge, surface, x, body.faces_camera) != stressed) continue;
      const double width = stressed ? 1.6 * view.unit : view.unit;
      if (edge.middle < 0) {
        draw(edge.first, edge.second, width);
      } else {
        draw(edge.first, edge.middle, width);
        draw(edge.middle, edge.second, width);
      }
    }
    brush->Paint(colour, stressed ? kRidgeOpacity : opacity);
  }
}

}  // namespace softforce::render
