#include "render/body_picture.h"

namespace softforce::render {
namespace {

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
  const int pieces = NumPieces(surface);
  for (int p = 0; p < pieces; ++p) {
    const auto [i, j, k] = NodesOfPiece(surface, p);
    const Sight &a = body->nodes[i], &b = body->nodes[j], &c = body->nodes[k];
    if (FacesCamera(a, b, c)) body->depth.AddTriangle(a, b, c, p);
  }
}

}  // namespace softforce::render
