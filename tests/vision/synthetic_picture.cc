#include "vision/synthetic_picture.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace softforce::testing {
namespace {

// What a pixel sees in one direction: its own width and the lens's blur. The share that lies below
// x, px.
double Seen(double x, double blur) {
  const auto integral = [&](double t) {  // of the normal distribution's share below t
    return 0.5 * t * std::erfc(-t / (blur * M_SQRT2)) +
           blur / std::sqrt(2 * M_PI) * std::exp(-0.5 * t * t / (blur * blur));
  };
  return integral(x + 0.5) - integral(x - 0.5);
}

// The place below which a share of it lies, by bisection.
double PlaceOfShare(double share, double blur) {
  double low = -8, high = 8;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (Seen(middle, blur) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double BitReversed(int i) {
  double share = 0;
  for (double half = 0.5; i > 0; i >>= 1, half *= 0.5) share += half * (i & 1);
  return share;
}

}  // namespace

SyntheticScene::SyntheticScene(int width, int height, double ground, double blur)
    : grey_(height, width, ground) {
  // Hammersley's points: no two share a row or a column, so that an edge along the pixels is
  // painted as finely as any other.
  constexpr int kSamples = 128;
  for (int i = 0; i < kSamples; ++i) {
    samples_.emplace_back(PlaceOfShare((i + 0.5) / kSamples, blur),
                          PlaceOfShare(BitReversed(i) + 0.5 / kSamples, blur));
  }
}

void SyntheticScene::Paint(const Eigen::Vector2d& middle, double reach,
                           const std::function<double(const Eigen::Vector2d&)>& level) {
  const int x0 = std::max(0, static_cast<int>(std::floor(middle.x() - reach)));
  const int x1 = std::min(grey_.cols - 1, static_cast<int>(std::ceil(middle.x() + reach)));
  const int y0 = std::max(0, static_cast<int>(std::floor(middle.y() - reach)));
  const int y1 = std::min(grey_.rows - 1, static_cast<int>(std::ceil(middle.y() + reach)));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      double sum = 0;
      for (const Eigen::Vector2d& sample : samples_) {
        const double here = level(Eigen::Vector2d(x, y) + sample);
        sum += std::isnan(here) ? grey_(y, x) : here;
      }
      grey_(y, x) = sum / static_cast<double>(samples_.size());
    }
  }
}

void SyntheticScene::Shade(const Eigen::Vector2d& slope) {
  for (int y = 0; y < grey_.rows; ++y) {
    for (int x = 0; x < grey_.cols; ++x) {
      grey_(y, x) *= 1 + slope.dot(Eigen::Vector2d(x - 0.5 * grey_.cols, y - 0.5 * grey_.rows));
    }
  }
}

cv::Mat SyntheticScene::TakePicture(double noise, std::mt19937& random) const {
  cv::Mat1d seen = grey_.clone();
  std::normal_distribution<double> level(0, 1);
  if (noise > 0) {
    for (double& value : seen) value += noise * level(random);
  }
  cv::Mat picture;
  seen.convertTo(picture, CV_8U);
  return picture;
}

void PaintEllipse(const EllipseShape& ellipse, double level, SyntheticScene* scene) {
  const Eigen::Matrix2d to_axes = Eigen::Rotation2Dd(-ellipse.angle).toRotationMatrix();
  const Eigen::Vector2d half(0.5 * ellipse.a, 0.5 * ellipse.b);
  scene->Paint(ellipse.centre, half.maxCoeff() + 4, [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d share = (to_axes * (p - ellipse.centre)).cwiseQuotient(half);
    return share.squaredNorm() <= 1 ? level : NAN;
  });
}

void PaintBox(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double level,
              SyntheticScene* scene) {
  const double reach = 0.5 * (high - low).norm() + 4;
  scene->Paint(0.5 * (low + high), reach, [&](const Eigen::Vector2d& p) {
    return (p.array() >= low.array() && p.array() < high.array()).all() ? level : NAN;
  });
}

void PaintDisc(const camera::Lens& lens, const Eigen::Vector3d& centre,
               const Eigen::Vector3d& normal, double diameter, double level,
               SyntheticScene* scene) {
  const double reach = 0.6 * lens.fx * diameter / centre.z() + 4;  // px
  scene->Paint(camera::Project(lens, centre).pixel, reach, [&](const Eigen::Vector2d& p) -> double {
    const Eigen::Vector3d ray = camera::Unproject(lens, p).value().homogeneous();
    const Eigen::Vector3d on_plane = ray * (normal.dot(centre) / normal.dot(ray));
    return (on_plane - centre).norm() <= 0.5 * diameter ? level : NAN;
  });
}

}  // namespace softforce::testing
