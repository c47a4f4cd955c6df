#include "render/skin.h"

#include <algorithm>
#include <cmath>

#include "render/colour_scale.h"
#include "render/plane.h"

namespace softforce::render {
namespace {

constexpr unsigned kOne = 256;     // of shares, in whole numbers
constexpr double kOpacity = 0.55;  // what lies below must be seen: markers
constexpr double kDarkest = 0.45;  // of a face that is seen from its side
constexpr unsigned kKept = static_cast<unsigned>((1 - kOpacity) * kOne);  // of the picture

// A flat piece: the position on the colour scale over the picture, and how strong its colour is.
struct Piece {
  Plane position;         // 0 to the number of colours less one
  unsigned strength = 0;  // of kOne
};

Piece MakePiece(const Eigen::Vector3d& eye, const mesh::Surface& surface, const Eigen::Matrix3Xd& x,
                const BodyPicture& body, const SurfaceField& field, int index) {
  const std::array<int, 3> nodes = NodesOfPiece(surface, index);
  std::array<cv::Point2d, 3> corners;
  std::array<double, 3> positions;
  for (int i = 0; i < 3; ++i) {
    corners[i] = body.nodes[nodes[i]].pixel;
    positions[i] = (ColourScale::kColours - 1) * field.values(nodes[i]) / field.largest;
  }
  const Eigen::Vector3d a = x.col(nodes[0]), b = x.col(nodes[1]), c = x.col(nodes[2]);
  const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
  const double facing = std::abs(normal.dot((eye - (a + b + c) / 3).normalized()));
  const double brightness = kDarkest + (1 - kDarkest) * facing;
  return {Plane::Through(corners, positions), static_cast<unsigned>(kOpacity * brightness * kOne)};
}

// The pixels of a row from `begin` to before `end`, which show one piece.
void PaintRun(const Piece& piece, const ColourScale& colours, int row, int begin, int end,
              cv::Vec3b* pixels) {
  const auto start = static_cast<float>(piece.position.At(begin, row));
  const auto step = static_cast<float>(piece.position.per_x);
  for (int column = begin; column < end; ++column) {
    const cv::Vec3b& colour = colours.Number(start + step * static_cast<float>(column - begin));
    cv::Vec3b& pixel = pixels[column];
    for (int i = 0; i < 3; ++i) {
      const unsigned mixed = kKept * pixel[i] + piece.strength * colour[i] + kOne / 2;
      pixel[i] = static_cast<uchar>(mixed / kOne);  // the shares are 1 together, or less
    }
  }
}

}  // namespace

void DrawSkin(cv::Mat3b picture, const View& view, const mesh::Surface& surface,
              const Eigen::Matrix3Xd& x, const BodyPicture& body, const SurfaceField& field) {
  const ColourScale colours;
  const Eigen::Vector3d eye = view.T_camera_robot.inverse().translation();
  std::vector<Piece> pieces(NumPieces(surface));
  const cv::Rect reach = body.depth.Reach();
  for (int row = reach.y; row < reach.br().y; ++row) {
    const int* names = body.depth.Nearest()[row];
    for (int begin = reach.x, end = begin; begin < reach.br().x; begin = end) {
      const int name = names[begin];
      while (end < reach.br().x && names[end] == name) ++end;
      if (name == DepthBuffer::kNothing) continue;
      Piece& piece = pieces[name];
      if (!piece.position.exists) piece = MakePiece(eye, surface, x, body, field, name);
      PaintRun(piece, colours, row, begin, end, picture[row]);
    }
  }
}

}  // namespace softforce::render
