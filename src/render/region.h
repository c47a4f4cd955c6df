#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/brush.h"
#include "render/view.h"

namespace softforce::render {

// Of a 95 % interval, standard deviations.
constexpr double kHalfWidth = 1.96;

// The outline of the picture of a 95 % region: of a place (m, robot frame) with this covariance
// (m²), to first order. Nothing is drawn, and no outline (px) given, if either is not finite, the
// covariance is 0, or the lens does not show the place.
std::vector<cv::Point2d> DrawRegion(Brush* brush, const View& view, const Eigen::Vector3d& place,
                                    const Eigen::Matrix3d& covariance, const cv::Vec3b& colour);

}  // namespace softforce::render
