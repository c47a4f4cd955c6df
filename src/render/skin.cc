#include "render/skin.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "render/colour_scale.h"

namespace softforce::render {
namespace {

constexpr double kOpacity = 0.55;  // what lies below must be seen: markers
constexpr double kDarkest = 0.45;  // of a face that is seen from its side

// A flat piece: the position on the colour scale over the picture, and its brightness.
struct Piece {
  double at_origin = 0, per_x = 0, per_y = 0;
  double brightness = 1;
};

Piece MakePiece(const View& view, const mesh::Surface& surface, const Eigen::Matrix3Xd& x,
                const BodyPicture& body, const SurfaceField& field, int index) {
  const std::array<int, 3> nodes = NodesOfPiece(surface, index);
  Eigen::Matrix3d corners;
  Eigen::Vector3d values;
  for (int i = 0; i < 3; ++i) {
    const cv::Point2d& pixel = body.nodes[nodes[i]].pixel;
    corners.row(i) << 1, pixel.x, pixel.y;
    values(i) = field.values(nodes[i]) / field.largest;
  }
  const Eigen::Vector3d plane = corners.partialPivLu().solve(values);
  const Eigen::Vector3d a = x.col(nodes[0]), b = x.col(nodes[1]), c = x.col(nodes[2]);
  const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
  const Eigen::Vector3d eye = view.T_camera_robot.inverse().translation();
  const double facing = std::abs(normal.dot((eye - (a + b + c) / 3).normalized()));
  return {plane(0), plane(1), plane(2), kDarkest + (1 - kDarkest) * facing};
}

}  // namespace

void DrawSkin(cv::Mat3b picture, const View& view, const mesh::Surface& surface,
              const Eigen::Matrix3Xd& x, const BodyPicture& body, const SurfaceField& field) {
  const ColourScale colours;
  std::vector<Piece> pieces(NumPieces(surface));
  std::vector<char> made(pieces.size(), 0);
  const cv::Mat1i& nearest = body.depth.Nearest();
  for (int row = 0; row < picture.rows; ++row) {
    const int* names = nearest[row];
    cv::Vec3b* pixels = picture[row];
    for (int column = 0; column < picture.cols; ++column) {
      const int p = names[column];
      if (p == DepthBuffer::kNothing) continue;
      Piece& piece = pieces[p];
      if (!made[p]) piece = MakePiece(view, surface, x, body, field, p);
      made[p] = 1;
      const cv::Vec3b colour =
          colours.At(piece.at_origin + piece.per_x * column + piece.per_y * row);
      const double share = kOpacity * piece.brightness;
      for (int channel = 0; channel < 3; ++channel) {
        pixels[column][channel] = cv::saturate_cast<uchar>(
            (1 - kOpacity) * pixels[column][channel] + share * colour[channel]);
      }
    }
  }
}

}  // namespace softforce::render
