#include "render/body_picture.h"

#include <cmath>

namespace softforce::render {
namespace {

// Outside faces list their corners counter-clockwise as seen, which is clockwise with y downwards.
bool FacesCamera(const Sight& a, const Sight& b, const Sight& c) {
  if (!a.visible || !b.visible || !c.visible) return false;
  return (b.pixel - a.pixel).cross(c.pixel - a.pixel) < 0;
}

// Of a 6-node triangle.
constexpr std::array<std::array<int, 3>, 5> kPieces{
    {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}, {0, 1, 2}}};

int PiecesPerTriangle(const mesh::Surface& surface) {
  return surface.order() == 1 ? 1 : static_cast<int>(kPieces.size());
}

void AddPiece(const mesh::Surface& surface, int piece, BodyPicture* body) {
  const auto [i, j, k] = NodesOfPiece(surface, piece);
  const Sight &a = body->nodes[i], &b = body->nodes[j], &c = body->nodes[k];
  if (FacesCamera(a, b, c)) body->depth.AddTriangle(a, b, c, piece);
}

bool IsFlat(const mesh::Surface& surface, int triangle, const BodyPicture& body) {
  const auto node = [&](int i) -> const Sight& {
    return body.nodes[surface.triangles(i, triangle)];
  };
  return IsMiddle(node(0), node(3), node(1)) && IsMiddle(node(1), node(4), node(2)) &&
         IsMiddle(node(2), node(5), node(0));
}

}  // namespace

bool IsMiddle(const Sight& a, const Sight& b, const Sight& c) {
  constexpr double kPixels = 0.2, kDepth = 2e-4;  // of the depth; what hides has ten times as much
  if (!a.visible || !b.visible || !c.visible) return false;
  return cv::norm(b.pixel - (a.pixel + c.pixel) / 2) < kPixels &&
         std::abs(b.inverse_depth - (a.inverse_depth + c.inverse_depth) / 2) <
             kDepth * b.inverse_depth;
}

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

void PictureBody(const View& view, const mesh::Surface& surface, const Eigen::Matrix3Xd& x,
                 BodyPicture* body) {
  body->nodes.assign(x.cols(), {});
  body->faces_camera.assign(surface.num_triangles(), false);
  body->depth.Clear(view.size);
  std::vector<bool> seen(x.cols(), false);
  for (const int node : surface.triangles.reshaped()) {
    if (!seen[node]) body->nodes[node] = See(view, x.col(node));
    seen[node] = true;
  }
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const auto corner = [&](int i) -> const Sight& { return body->nodes[surface.triangles(i, t)]; };
    body->faces_camera[t] = FacesCamera(corner(0), corner(1), corner(2));
  }
  const int per_triangle = PiecesPerTriangle(surface);
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const int last = (t + 1) * per_triangle - 1;
    if (per_triangle == 1 || IsFlat(surface, t, *body)) {
      AddPiece(surface, last, body);
    } else {
      for (int p = t * per_triangle; p < last; ++p) AddPiece(surface, p, body);
    }
  }
}

}  // namespace softforce::render
