#include "render/body_net.h"

#include "render/stroke.h"

namespace softforce::render {
namespace {

constexpr double kRidgeOpacity = 0.75;
constexpr double kRidge = 0.8;  // cosine of the angle between the faces of an edge to be stressed

Eigen::Matrix3Xd FaceNormals(const mesh::Surface& surface, const Eigen::Matrix3Xd& x) {
  Eigen::Matrix3Xd normals(3, surface.num_triangles());
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const Eigen::Vector3d a = x.col(surface.triangles(0, t));
    const Eigen::Vector3d b = x.col(surface.triangles(1, t));
    const Eigen::Vector3d c = x.col(surface.triangles(2, t));
    normals.col(t) = (b - a).cross(c - a).normalized();
  }
  return normals;
}

bool IsSeen(const Edge& edge, const BodyPicture& body) {
  return body.faces_camera[edge.triangle] ||
         (edge.other_triangle >= 0 && body.faces_camera[edge.other_triangle]);
}

bool IsStressed(const Edge& edge, const BodyPicture& body, const Eigen::Matrix3Xd& normals) {
  if (edge.other_triangle < 0) return true;
  if (body.faces_camera[edge.triangle] != body.faces_camera[edge.other_triangle]) return true;
  return normals.col(edge.triangle).dot(normals.col(edge.other_triangle)) < kRidge;
}

}  // namespace

void DrawNet(Brush* brush, const View& view, const mesh::Surface& surface,
             const Eigen::Matrix3Xd& x, const BodyPicture& body, const std::vector<Edge>& edges,
             const cv::Vec3b& colour, double opacity) {
  const Eigen::Matrix3Xd normals = FaceNormals(surface, x);
  std::vector<const Edge*> stressed;
  const auto draw = [&](int from, int to, double width) {
    const Sight& a = body.nodes[from];
    const Sight& b = body.nodes[to];
    if (!a.visible || !b.visible) return;
    ForEachPart(body.depth, a, b, [&](double begin, double end, bool hidden) {
      if (!hidden) brush->Line(Along(a, b, begin), Along(a, b, end), width);
    });
  };
  const auto draw_edge = [&](const Edge& edge, double width) {
    const bool straight =
        edge.middle < 0 ||
        IsMiddle(body.nodes[edge.first], body.nodes[edge.middle], body.nodes[edge.second]);
    if (straight) {
      draw(edge.first, edge.second, width);
    } else {
      draw(edge.first, edge.middle, width);
      draw(edge.middle, edge.second, width);
    }
  };
  for (const Edge& edge : edges) {
    if (!IsSeen(edge, body)) continue;
    if (IsStressed(edge, body, normals)) {
      stressed.push_back(&edge);
    } else {
      draw_edge(edge, view.unit);
    }
  }
  brush->Paint(colour, opacity);
  for (const Edge* edge : stressed) draw_edge(*edge, 1.6 * view.unit);
  brush->Paint(colour, kRidgeOpacity);
}

}  // namespace softforce::render
