#include "pipeline/register_points.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>

#include "pipeline/capture_source.h"
#include "pipeline/register_markers.h"
#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

using base::InputError;

constexpr size_t kFewest = 4;  // markers: one more than a place needs, so that a wrong one shows

struct Pair {
  int marker = -1;                 // number in the scene's list
  Eigen::Vector3d p_robot, p_rig;  // m
  double sd = NAN;                 // m
  double misfit = NAN;             // m
};

const scene::MeasuredFrame& FrameAt(const scene::MeasuredPoints& points, int frame,
                                    const scene::Scene& scene) {
  for (const scene::MeasuredFrame& candidate : points.frames) {
    if (candidate.frame >= frame) return candidate;
  }
  throw InputError(
      "--frame", fmt::format("asks for frame {}, but the last in {} is {}", frame,
                             scene.measured->file.filename().string(), points.frames.back().frame));
}

std::vector<Pair> LabelledPairs(const scene::Scene& scene, const scene::MeasuredFrame& frame) {
  const World world = BuildWorld(scene);
  const Eigen::Matrix3Xd x = UnloadedBody(world, scene, frame.time_s);
  std::vector<Pair> pairs;
  for (const scene::MeasuredPoint& point : frame.points) {
    if (point.marker < 0) continue;
    const BodyPoint& marker = world.markers[point.marker];
    pairs.push_back({point.marker, marker.weights.Apply(x) + marker.offset, point.p_rig, point.sd});
  }
  if (pairs.size() >= kFewest) return pairs;
  throw InputError(scene.measured->file.string(),
                   fmt::format("frame {} has {} points with labels, expected {} or more",
                               frame.frame, pairs.size(), kFewest),
                   "Label the markers in the motion-capture program, or give a frame in which they "
                   "are seen (--frame).");
}

struct Means {
  Eigen::Vector3d robot = Eigen::Vector3d::Zero(), rig = Eigen::Vector3d::Zero();
};

Means MeansOf(const std::vector<Pair>& pairs) {
  Means means;
  for (const Pair& pair : pairs) {
    means.robot += pair.p_robot / static_cast<double>(pairs.size());
    means.rig += pair.p_rig / static_cast<double>(pairs.size());
  }
  return means;
}

// The least-squares rigid fit (Arun, Huang, Blostein 1987), and the misfit of every pair by it.
Eigen::Isometry3d Fit(std::vector<Pair>* pairs) {
  const Means means = MeansOf(*pairs);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Pair& pair : *pairs) {
    moments += (pair.p_rig - means.rig) * (pair.p_robot - means.robot).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1, 1);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs(2) = -1;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  T.translation() = means.rig - T.linear() * means.robot;
  for (Pair& pair : *pairs) pair.misfit = (pair.p_rig - T * pair.p_robot).norm();
  return T;
}

// Markers in a row leave the turn about it open.
void RefuseCollinear(const std::vector<Pair>& pairs, const scene::Scene& scene) {
  const Means means = MeansOf(pairs);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double sd = 0;
  for (const Pair& pair : pairs) {
    spread += (pair.p_robot - means.robot) * (pair.p_robot - means.robot).transpose();
    sd = std::max(sd, pair.sd);
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread);
  const double width = std::sqrt(svd.singularValues()(1) / static_cast<double>(pairs.size()));
  constexpr double kWidth = 10;  // beside the noise: a turn known to 0.1 rad
  if (width > kWidth * sd) return;
  throw InputError(scene.measured->file.string(),
                   fmt::format("the {} markers with labels lie on a line, to {:.2f} mm, which does "
                               "not fix the turn about it",
                               pairs.size(), 1e3 * width),
                   "Label markers to the side of the line.");
}

double RmsOf(const std::vector<Pair>& pairs) {
  double squares = 0;
  for (const Pair& pair : pairs) squares += pair.misfit * pair.misfit;
  return std::sqrt(squares / static_cast<double>(pairs.size()));
}

geometry::Matrix6d CovarianceOf(const std::vector<Pair>& pairs, const Eigen::Isometry3d& T) {
  const double unknowns = 6, rows = 3.0 * static_cast<double>(pairs.size());
  const double variance = RmsOf(pairs) * RmsOf(pairs) * static_cast<double>(pairs.size()) /
                          (rows - unknowns);  // m², per coordinate
  geometry::Matrix6d information = geometry::Matrix6d::Zero();
  for (const Pair& pair : pairs) {
    Eigen::Matrix<double, 3, 6> J;
    J << Eigen::Matrix3d::Identity(), -geometry::Skew(T * pair.p_robot);
    information += J.transpose() * J / std::max(variance, pair.sd * pair.sd);
  }
  return information.inverse();
}

}  // namespace

RegisterReport RegisterByPoints(const scene::Scene& scene, const RegisterOptions& options) {
  RegisterReport report;
  report.rig_file = scene.measured->rig;
  const scene::MeasuredPoints points = scene::ReadMeasuredPoints(*scene.measured, scene.markers);
  const scene::MeasuredFrame& frame = FrameAt(points, options.frame, scene);
  std::vector<Pair> pairs = LabelledPairs(scene, frame);
  const size_t labelled = pairs.size();
  Eigen::Isometry3d T = Fit(&pairs);
  const auto worse = [](const Pair& a, const Pair& b) { return a.misfit < b.misfit; };
  while (true) {
    const auto worst = std::max_element(pairs.begin(), pairs.end(), worse);
    constexpr double kSds = 4;
    if (worst->misfit <= options.match.max_misplacement + kSds * worst->sd) break;
    if (pairs.size() == kFewest || 2 * (pairs.size() - 1) < labelled) {
      throw InputError(
          scene.file.string() + ": markers",
          fmt::format("they do not fit the points of frame {}: marker {} is still {:.2f} mm from "
                      "where {} others put it",
                      frame.frame, scene.markers.points[worst->marker].id, 1e3 * worst->misfit,
                      pairs.size() - 1),
          "Nothing but its actuators may act on the body in that frame (--frame); check the "
          "markers' places and labels, and the file's unit.");
    }
    report.warnings.push_back(
        fmt::format("marker {} is {:.2f} mm from where the others put it, and was left out",
                    scene.markers.points[worst->marker].id, 1e3 * worst->misfit));
    pairs.erase(worst);
    T = Fit(&pairs);
  }
  RefuseCollinear(pairs, scene);
  report.pose.status = vision::RigPose::Status::kOk;
  report.pose.T_rig_robot = T;
  report.pose.covariance = CovarianceOf(pairs, T);
  report.pose.num_points = static_cast<int>(pairs.size());
  report.rms = RmsOf(pairs);
  report.how = fmt::format("by {} of {} markers with labels", pairs.size(), labelled);
  return report;
}

}  // namespace softforce::pipeline
