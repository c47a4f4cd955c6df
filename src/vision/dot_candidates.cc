#include "vision/dot_candidates.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace softforce::vision {
namespace {

// px, side of the square whose mean a pixel is held against. Larger discs become rings, and only
// their outer contour counts; larger squares would join a dot to a bright or dark surface near by.
constexpr int kNeighbourhood = 25;

// Share of the smallest contrast that a pixel near the edge must stand out from the mean.
constexpr double kThresholdShare = 0.3;

int GreyAt(const cv::Mat& grey, const Eigen::Vector2d& p) {
  const int x = std::clamp(cvRound(p.x()), 0, grey.cols - 1);
  const int y = std::clamp(cvRound(p.y()), 0, grey.rows - 1);
  return grey.at<uchar>(y, x);
}

// The ellipse with the area moments of a closed contour through pixel centres. The blob reaches
// half a pixel further out. Nothing if its short axis is less than `min_short` (px), or the blob
// fills less of its ellipse than a disc does.
std::optional<Ellipse> EllipseOf(const std::vector<cv::Point>& contour, double min_short) {
  constexpr double kMinAreaShare = 0.85;  // a disc has 1
  const cv::Moments m = cv::moments(contour);
  if (!(m.m00 > 0)) return std::nullopt;
  Eigen::Matrix2d covariance;
  covariance << m.mu20, m.mu11, m.mu11, m.mu02;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(covariance / m.m00);
  const Eigen::Vector2d half = 2 * axes.eigenvalues().cwiseMax(0).cwiseSqrt();  // px
  if (m.m00 < kMinAreaShare * M_PI * half.prod()) return std::nullopt;
  const Eigen::Vector2d grown = half.array() + 0.5;
  if (2 * grown(0) < min_short) return std::nullopt;
  const Eigen::Matrix2d shape =
      axes.eigenvectors() * grown.cwiseAbs2().asDiagonal() * axes.eigenvectors().transpose();
  return Ellipse({m.m10 / m.m00, m.m01 / m.m00}, shape);
}

double Median(double* values, int count) {
  std::nth_element(values, values + count / 2, values + count);
  return values[count / 2];
}

template <int kCount>
std::array<Eigen::Vector2d, kCount> UnitVectors() {
  std::array<Eigen::Vector2d, kCount> units;
  for (int i = 0; i < kCount; ++i) {
    units[i] << std::cos(2 * M_PI * i / kCount), std::sin(2 * M_PI * i / kCount);
  }
  return units;
}

// A first look at a few pixels: a disc is brighter (darker) inside than around it, nearly
// everywhere a little and at the median by its contrast. Few blobs of a picture's clutter are, so
// that only few need to be measured.
bool StandsOut(const cv::Mat& smooth, const cv::Point& corner, const Ellipse& ellipse, bool bright,
               double min_contrast) {
  constexpr int kDirections = 16;
  static const auto kUnit = UnitVectors<kDirections>();
  constexpr int kMaxExceptions = 4;
  constexpr double kOutside = 2.5;  // px from the contour, where blur has faded
  constexpr double kShare = 0.65;   // of the smallest contrast, that the first look must show
  // px², of the lens, the pixel and the smoothing: a small disc is nowhere as bright as it is.
  constexpr double kBlur2 = 2;
  const Eigen::Vector2d centre = ellipse.centre() - Eigen::Vector2d(corner.x, corner.y);
  const int inside = GreyAt(smooth, centre);
  const double sign = bright ? 1 : -1;
  std::array<double, kDirections> here, around;
  int exceptions = 0;
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector2d contour = ellipse.ContourAt(kUnit[i]);
    here[i] = sign * GreyAt(smooth, centre + 0.4 * contour);
    around[i] = sign * GreyAt(smooth, centre + contour + kOutside * contour.normalized());
    exceptions += std::min(here[i], sign * inside) - around[i] < 0.5 * min_contrast;
    if (exceptions > kMaxExceptions) return false;
  }
  const double left = 1 - std::exp(-0.5 * ellipse.short_half() * ellipse.short_half() / kBlur2);
  return Median(here.data(), kDirections) - Median(around.data(), kDirections) >=
         kShare * left * min_contrast;
}

// Whether a contour ends where only the part that is looked at does.
bool IsCut(const cv::Rect& box, const cv::Rect& part, const cv::Size& picture) {
  return (box.x == 0 && part.x > 0) || (box.y == 0 && part.y > 0) ||
         (box.br().x == part.width && part.br().x < picture.width) ||
         (box.br().y == part.height && part.br().y < picture.height);
}

// What is left to look at in a part of the picture.
struct Part {
  cv::Rect rect;     // px, of `mask` in the picture
  cv::Size picture;  // px
  cv::Mat smooth;    // larger than the part
  cv::Point corner;  // px, of `smooth` in the picture
};

void CollectBlobs(const cv::Mat& mask, const Part& part, bool bright, const DotOptions& options,
                  std::vector<Ellipse>* blobs) {
  constexpr double kSlack = 2;  // px; blur and the threshold shift the contour
  std::vector<std::vector<cv::Point>> contours;
  std::vector<cv::Vec4i> hierarchy;
  cv::findContours(mask, contours, hierarchy, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE,
                   part.rect.tl());
  for (size_t i = 0; i < contours.size(); ++i) {
    if (hierarchy[i][3] >= 0 || contours[i].size() < 4) continue;  // a hole, or a speck
    const cv::Rect box = cv::boundingRect(contours[i]);
    if (std::max(box.width, box.height) > options.max_diameter + kSlack ||
        std::max(box.width, box.height) < options.min_diameter - kSlack) {
      continue;
    }
    if (IsCut(box - part.rect.tl(), part.rect, part.picture)) continue;
    const std::optional<Ellipse> ellipse = EllipseOf(contours[i], options.min_diameter - kSlack);
    if (ellipse && StandsOut(part.smooth, part.corner, *ellipse, bright, options.min_contrast)) {
      blobs->push_back(*ellipse);
    }
  }
}

}  // namespace

std::vector<Ellipse> FindEllipticBlobs(const cv::Mat& grey, const cv::Rect& rect,
                                       const DotOptions& options) {
  const cv::Rect all(0, 0, grey.cols, grey.rows);
  // What is around the part counts for means and for first looks, as in the whole picture.
  const cv::Rect wide =
      cv::Rect(rect.x - kNeighbourhood, rect.y - kNeighbourhood, rect.width + 2 * kNeighbourhood,
               rect.height + 2 * kNeighbourhood) &
      all;
  Part part{rect, grey.size(), {}, wide.tl()};
  cv::Mat mean, above, mask;
  // Single noisy pixels would each become a blob. OpenCV rounds differently if it reads beyond the
  // part; there is room for what the part's border gets wrong.
  cv::GaussianBlur(grey(wide), part.smooth, cv::Size(3, 3), 0, 0,
                   cv::BORDER_DEFAULT | cv::BORDER_ISOLATED);
  const cv::Mat smooth = part.smooth(rect - wide.tl());
  cv::blur(smooth, mean, cv::Size(kNeighbourhood, kNeighbourhood));
  std::vector<Ellipse> blobs;
  for (const bool bright : {true, false}) {
    if (options.polarity == (bright ? DotPolarity::kDark : DotPolarity::kBright)) continue;
    if (bright) {
      cv::subtract(smooth, mean, above);
    } else {
      cv::subtract(mean, smooth, above);
    }
    cv::threshold(above, mask, kThresholdShare * options.min_contrast, 255, cv::THRESH_BINARY);
    CollectBlobs(mask, part, bright, options, &blobs);
  }
  return blobs;
}

}  // namespace softforce::vision
