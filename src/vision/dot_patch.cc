#include "vision/dot_patch.h"

#include <algorithm>
#include <cmath>

namespace softforce::vision {
namespace {

constexpr double kRing = 3;              // px, width of the ring of ground around a dot
constexpr double kMinEvenGround = 0.55;  // share of the ring that must be even ground
constexpr double kMinEvenFace = 0.7;     // share of the dot's inside that must be even
constexpr int kMinFaceForSlope = 30;     // pixels from which the dot's own shading can be told

}  // namespace

double Levels::Noise(double coverage) const {
  const double share = std::clamp(coverage, 0.0, 1.0);
  return (1 - share) * ground.noise2 + share * face.noise2;
}

std::optional<Patch> CutPatch(const cv::Mat& grey, const Ellipse& ellipse, double margin) {
  const Eigen::Vector2d reach = ellipse.Reach().array() + margin + kRing;
  const Eigen::Vector2d low = ellipse.centre() - reach;
  const Eigen::Vector2d high = ellipse.centre() + reach;
  if (!(low.minCoeff() >= 0) || !(high.x() <= grey.cols - 1) || !(high.y() <= grey.rows - 1)) {
    return std::nullopt;
  }
  Patch patch;
  patch.pixels.reserve(static_cast<size_t>(4 * (reach.x() + 1) * (reach.y() + 1)));
  for (int y = static_cast<int>(std::ceil(low.y())); y <= high.y(); ++y) {
    const uchar* row = grey.ptr<uchar>(y);
    for (int x = static_cast<int>(std::ceil(low.x())); x <= high.x(); ++x) {
      const Eigen::Vector2d d = Eigen::Vector2d(x, y) - ellipse.centre();
      const double outside = ellipse.Outside(d);
      if (outside > margin + kRing) continue;
      patch.pixels.push_back({d, static_cast<double>(row[x]), outside});
    }
  }
  // In a small dot no pixel is a margin away from the edge; its innermost ones must do.
  const double face_depth = std::min(margin, 0.6 * ellipse.short_half());
  for (const PatchPixel& pixel : patch.pixels) {
    if (pixel.outside < -face_depth) patch.face.push_back(&pixel);
    if (pixel.outside > margin) {
      patch.ground.push_back(&pixel);
    } else if (pixel.outside >= -margin) {
      patch.edge.push_back(&pixel);
    } else {
      ++patch.inside;
      patch.inside_sum += pixel.d;
      patch.inside_square += pixel.d * pixel.d.transpose();
    }
  }
  return patch;
}

std::optional<Levels> FitLevels(const Patch& patch) {
  const auto ground = FitGreyPlane(patch.ground, true);
  if (!ground || ground->inlier_share < kMinEvenGround) return std::nullopt;
  if (static_cast<int>(patch.face.size()) >= kMinFaceForSlope) {
    const auto face = FitGreyPlane(patch.face, true);
    if (!face || face->inlier_share < kMinEvenFace) return std::nullopt;
    return Levels{*ground, *face, true};
  }
  if (patch.face.empty()) return std::nullopt;
  double sum = 0;
  for (const PatchPixel* pixel : patch.face) sum += pixel->value - ground->At(pixel->d);
  const double count = static_cast<double>(patch.face.size());
  GreyPlane face{{0, 0, sum / count}, Eigen::Matrix3d::Zero(), ground->noise2, 1};
  face.covariance(2, 2) = ground->noise2 / count;
  return Levels{*ground, face, false};
}

}  // namespace softforce::vision
