#pragma once

#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "softforce/calibration/match_markers.h"
#include "support/stereo_rig.h"

namespace softforce::calibration {

// 14 dots strewn over a flat sheet of 200 mm.
inline std::vector<KnownDot> SheetDots() {
  const std::vector<Eigen::Vector2d> places = {
      {41, 37},  {83, 40},  {122, 35},  {165, 41},  {57, 79},  {104, 83},  {147, 78},
      {33, 121}, {80, 117}, {121, 123}, {168, 119}, {55, 164}, {101, 161}, {146, 166}};
  std::vector<KnownDot> dots;
  for (const Eigen::Vector2d& at : places) {
    dots.push_back({1e-3 * Eigen::Vector3d(at.x(), at.y(), 10), Eigen::Vector3d::UnitZ(), 6e-3});
  }
  return dots;
}

// 9 dots on a body with legs: a square of four at the tip, three on one leg, two on the next one. A
// quarter turn takes six of them to each other.
inline std::vector<KnownDot> LeggedDots() {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d out_x(0.743, 0, 0.669), out_y(0, 0.743, 0.669);
  std::vector<KnownDot> dots;
  for (const auto& [p, normal] :
       std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>{{{7.6, 7.6, 110}, up},
                                                                {{-7.6, 7.6, 110}, up},
                                                                {{-7.6, -7.6, 110}, up},
                                                                {{7.6, -7.6, 110}, up},
                                                                {{54.5, 0, 60.6}, out_x},
                                                                {{39.8, 0, 76.9}, out_x},
                                                                {{0, 54.5, 60.6}, out_y},
                                                                {{0, 39.8, 76.9}, out_y},
                                                                {{25.4, 0, 92.9}, out_x}}) {
    dots.push_back({1e-3 * p, normal.normalized(), 6e-3});
  }
  return dots;
}

inline Eigen::Vector3d CentreOf(const std::vector<KnownDot>& dots) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const KnownDot& dot : dots) sum += dot.p_robot;
  return sum / static_cast<double>(dots.size());
}

// The rig looks down on the dots from half a metre.
inline Eigen::Isometry3d LookingDown(const std::vector<KnownDot>& dots) {
  return Eigen::Translation3d(0, 0, 0.5) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()) *
         Eigen::Translation3d(-CentreOf(dots));
}

struct Disturbance {
  double pixel_sd = 0.05;   // px
  double misplacement = 0;  // m, standard deviation of each coordinate of a dot
  std::vector<int> hidden;  // dots
  int decoys = 0;           // dots about the body that both cameras see
  int clutter = 0;          // spots of one camera alone, in each
};

// What the cameras of a rig at `T_rig_robot` see, in random order.
inline std::vector<std::vector<DetectedSpot>> SpotsOf(const camera::Rig& rig,
                                                      std::vector<KnownDot> dots,
                                                      const Eigen::Isometry3d& T_rig_robot,
                                                      const Disturbance& how,
                                                      std::mt19937& random) {
  std::normal_distribution<double> noise(0, 1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Eigen::Vector3d centre = CentreOf(dots);
  for (KnownDot& dot : dots) {
    dot.p_robot += how.misplacement * Eigen::Vector3d(noise(random), noise(random), noise(random));
  }
  std::vector<KnownDot> seen;
  for (int d = 0; d < static_cast<int>(dots.size()); ++d) {
    if (std::find(how.hidden.begin(), how.hidden.end(), d) == how.hidden.end()) {
      seen.push_back(dots[d]);
    }
  }
  for (int i = 0; i < how.decoys; ++i) {
    const Eigen::Vector3d p(0.1 * uniform(random), 0.1 * uniform(random), 0.03 * uniform(random));
    seen.push_back({centre + p, Eigen::Vector3d::UnitZ(), 6e-3});
  }
  std::vector<std::vector<DetectedSpot>> spots(rig.cameras.size());
  for (size_t c = 0; c < rig.cameras.size(); ++c) {
    const camera::Camera& camera = rig.cameras[c];
    const Eigen::Isometry3d T = camera.T_camera_rig * T_rig_robot;
    const Eigen::Matrix2d covariance = how.pixel_sd * how.pixel_sd * Eigen::Matrix2d::Identity();
    for (const KnownDot& dot : seen) {
      const Eigen::Vector3d p = T * dot.p_robot, normal = T.linear() * dot.normal;
      const auto pixel = camera::ProjectDiscCentroid(camera.lens, p, normal, dot.diameter);
      if (!pixel || -normal.dot(p.normalized()) < 0.2) continue;
      if (!(pixel->x() > 5 && pixel->y() > 5 && pixel->x() < camera.width - 6 &&
            pixel->y() < camera.height - 6)) {
        continue;
      }
      spots[c].push_back({*pixel + how.pixel_sd * Eigen::Vector2d(noise(random), noise(random)),
                          covariance, dot.diameter * camera.lens.fx / p.z()});
    }
    for (int i = 0; i < how.clutter; ++i) {
      spots[c].push_back({{640 + 600 * uniform(random), 512 + 500 * uniform(random)},
                          covariance,
                          17 + 4 * uniform(random)});
    }
    std::shuffle(spots[c].begin(), spots[c].end(), random);
  }
  return spots;
}

// m, the largest distance between where two poses have a dot.
inline double ErrorAt(const std::vector<KnownDot>& dots, const Eigen::Isometry3d& a,
                      const Eigen::Isometry3d& b) {
  double largest = 0;
  for (const KnownDot& dot : dots) {
    largest = std::max(largest, (a * dot.p_robot - b * dot.p_robot).norm());
  }
  return largest;
}

}  // namespace softforce::calibration
