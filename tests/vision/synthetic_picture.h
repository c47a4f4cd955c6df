#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "softforce/camera/lens.h"

namespace softforce::testing {

// A grey scene as a lens with a little blur and square pixels see it, painted with sub-pixel
// accuracy.
class SyntheticScene {
 public:
  // px, px, grey levels; `blur` is the standard deviation of the lens's, px.
  SyntheticScene(int width, int height, double ground, double blur = 0.65);

  // Replaces what lies within `reach` (px) of `middle` by `level(p)`, averaged over what each pixel
  // sees. Where `level` is NaN, what was there stays.
  void Paint(const Eigen::Vector2d& middle, double reach,
             const std::function<double(const Eigen::Vector2d&)>& level);

  // Light that falls unevenly: the scene is multiplied by 1 + slope · (p − middle of the picture).
  void Shade(const Eigen::Vector2d& slope);  // 1/px

  // 8 bits; `noise` in grey levels, standard deviation.
  cv::Mat TakePicture(double noise, std::mt19937& random) const;

 private:
  cv::Mat1d grey_;
  std::vector<Eigen::Vector2d> samples_;  // px, where around its centre a pixel looks
};

// An ellipse of full axes a and b, the first turned by `angle` from the x axis.
struct EllipseShape {
  Eigen::Vector2d centre;  // px
  double a, b;             // px
  double angle;            // rad
};
void PaintEllipse(const EllipseShape& ellipse, double level, SyntheticScene* scene);

// An upright rectangle.
void PaintBox(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double level,
              SyntheticScene* scene);

// A flat disc seen through a lens. Centre and normal in the camera's frame, m.
void PaintDisc(const camera::Lens& lens, const Eigen::Vector3d& centre,
               const Eigen::Vector3d& normal, double diameter, double level, SyntheticScene* scene);

}  // namespace softforce::testing
