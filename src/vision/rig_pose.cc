#include "softforce/vision/rig_pose.h"

#include <visp3/core/vpExponentialMap.h>
#include <visp3/core/vpVelocityTwistMatrix.h>
#include <visp3/vision/vpPose.h>
#include <visp3/visual_features/vpFeaturePoint.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace softforce::vision {
namespace {

using geometry::Matrix6d;
using geometry::Vector6d;

// A sighting in ViSP's terms: undistorted coordinates on the plane z = 1.
struct NormalisedSighting {
  const PointSighting* sighting;
  Eigen::Vector2d point;
  Eigen::Matrix2d whitening;  // of the pixel's covariance carried to the plane
};

// ViSP's cMo is our T_camera_object; both are 4×4 and homogeneous.
vpHomogeneousMatrix ToVisp(const Eigen::Isometry3d& T) {
  vpHomogeneousMatrix M;
  for (unsigned r = 0; r < 4; ++r) {
    for (unsigned c = 0; c < 4; ++c) M[r][c] = T.matrix()(r, c);
  }
  return M;
}
Eigen::Isometry3d FromVisp(const vpHomogeneousMatrix& M) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (unsigned r = 0; r < 3; ++r) {
    for (unsigned c = 0; c < 4; ++c) T.matrix()(r, c) = M[r][c];
  }
  return T;
}

std::vector<NormalisedSighting> Normalise(const camera::Rig& rig,
                                          const std::vector<PointSighting>& sightings) {
  std::vector<NormalisedSighting> normalised;
  for (const PointSighting& seen : sightings) {
    const camera::Lens& lens = rig.cameras[seen.camera].lens;
    if (!seen.pixel.allFinite() || !seen.covariance.allFinite()) continue;
    const auto point = camera::Unproject(lens, seen.pixel);
    if (!point) continue;
    const Eigen::Matrix2d to_pixel =
        camera::Project(lens, point->homogeneous()).jacobian.leftCols<2>();
    const Eigen::Matrix2d L = seen.covariance.llt().matrixL();
    normalised.push_back({&seen, *point, L.inverse() * to_pixel});
  }
  return normalised;
}

// vpPose in one camera. Nothing if its points do not span a plane.
std::optional<Eigen::Isometry3d> PoseInCamera(const std::vector<NormalisedSighting>& sightings,
                                              int camera) {
  vpPose pose;
  int points = 0;
  for (const NormalisedSighting& seen : sightings) {
    if (seen.sighting->camera != camera) continue;
    const Eigen::Vector3d& P = seen.sighting->p_robot;
    vpPoint point(P.x(), P.y(), P.z());
    point.set_x(seen.point.x());
    point.set_y(seen.point.y());
    pose.addPoint(point);
    ++points;
  }
  if (points < 4) return std::nullopt;
  // Lagrange's method refuses fewer than six points that are not on a plane.
  std::optional<vpHomogeneousMatrix> best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto method : {vpPose::DEMENTHON, vpPose::LAGRANGE}) {
    try {
      vpHomogeneousMatrix cMo;
      pose.computePose(method, cMo);
      const double residual = pose.computeResidual(cMo);
      if (!(residual < least)) continue;
      least = residual;
      best = cMo;
    } catch (const vpException&) {  // not its kind of points
    }
  }
  if (!best) return std::nullopt;
  try {
    pose.computePose(vpPose::VIRTUAL_VS, *best);
  } catch (const vpException&) {
    return std::nullopt;
  }
  const Eigen::Isometry3d T = FromVisp(*best);
  if (!T.matrix().allFinite()) return std::nullopt;
  return T;
}

// One linearisation of virtual visual servoing over all cameras: the rig moves by a velocity v that
// takes the whitened features to where they were seen.
struct Servoing {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double chi2 = 0;
  bool in_front = true;
};

Servoing Linearise(const camera::Rig& rig, const std::vector<NormalisedSighting>& sightings,
                   const Eigen::Isometry3d& T_rig_robot) {
  Servoing servoing;
  std::vector<vpVelocityTwistMatrix> twists;  // v_camera = twist · v_rig
  for (const camera::Camera& camera : rig.cameras) twists.emplace_back(ToVisp(camera.T_camera_rig));
  for (const NormalisedSighting& seen : sightings) {
    const int c = seen.sighting->camera;
    const Eigen::Vector3d p = rig.cameras[c].T_camera_rig * (T_rig_robot * seen.sighting->p_robot);
    if (!(p.z() > 0)) {
      servoing.in_front = false;
      return servoing;
    }
    vpFeaturePoint feature;
    feature.buildFrom(p.x() / p.z(), p.y() / p.z(), p.z());
    const vpMatrix L = feature.interaction() * twists[c];
    Eigen::Matrix<double, 2, 6> J;
    for (unsigned r = 0; r < 2; ++r) {
      for (unsigned k = 0; k < 6; ++k) J(r, k) = L[r][k];
    }
    J = seen.whitening * J;
    const Eigen::Vector2d error = seen.whitening * (p.head<2>() / p.z() - seen.point);
    servoing.information += J.transpose() * J;
    servoing.gradient -= J.transpose() * error;
    servoing.chi2 += error.squaredNorm();
  }
  return servoing;
}

double ReprojectionRms(const camera::Rig& rig, const std::vector<NormalisedSighting>& sightings,
                       const Eigen::Isometry3d& T_rig_robot) {
  double square = 0;
  for (const NormalisedSighting& seen : sightings) {
    const camera::Camera& camera = rig.cameras[seen.sighting->camera];
    const camera::Projection at =
        camera::Project(camera.lens, camera.T_camera_rig * (T_rig_robot * seen.sighting->p_robot));
    square += (at.pixel - seen.sighting->pixel).squaredNorm();
  }
  return std::sqrt(square / static_cast<double>(sightings.size()));
}

// The camera's own pose, carried to the rig, that explains all cameras best.
std::optional<Eigen::Isometry3d> BestStart(const camera::Rig& rig,
                                           const std::vector<NormalisedSighting>& sightings) {
  std::optional<Eigen::Isometry3d> best;
  double least = std::numeric_limits<double>::infinity();
  for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
    const auto T_camera_robot = PoseInCamera(sightings, c);
    if (!T_camera_robot) continue;
    const Eigen::Isometry3d T_rig_robot = rig.cameras[c].T_camera_rig.inverse() * *T_camera_robot;
    const Servoing there = Linearise(rig, sightings, T_rig_robot);
    if (there.in_front && there.chi2 < least) {
      least = there.chi2;
      best = T_rig_robot;
    }
  }
  return best;
}

RigPose Refine(const camera::Rig& rig, const std::vector<NormalisedSighting>& normalised,
               const Eigen::Isometry3d& start) {
  RigPose pose;
  pose.num_points = static_cast<int>(normalised.size());
  Eigen::Isometry3d T = start;
  Servoing servoing = Linearise(rig, normalised, T);
  pose.status = RigPose::Status::kNotConverged;
  for (int iteration = 0; iteration < 100 && servoing.in_front; ++iteration) {
    const Vector6d v = servoing.information.ldlt().solve(servoing.gradient);
    if (!v.allFinite()) break;
    vpColVector velocity(6);
    for (unsigned i = 0; i < 6; ++i) velocity[i] = v(i);
    // The rig moves by exp(v), so the robot moves by its inverse as seen from the rig.
    T = FromVisp(vpExponentialMap::direct(velocity).inverse() * ToVisp(T));
    servoing = Linearise(rig, normalised, T);
    if (v.norm() < 1e-10) {
      pose.status = RigPose::Status::kOk;
      break;
    }
  }
  if (!servoing.in_front || pose.status != RigPose::Status::kOk) return pose;

  const Eigen::SelfAdjointEigenSolver<Matrix6d> spectrum(servoing.information);
  if (!(spectrum.eigenvalues()(0) > 1e-12 * spectrum.eigenvalues()(5))) {
    pose.status = RigPose::Status::kDegenerate;
    return pose;
  }
  const double freedom = std::max(1, 2 * pose.num_points - 6);
  pose.T_rig_robot = T;
  pose.covariance = std::max(1.0, servoing.chi2 / freedom) * servoing.information.inverse();
  pose.rms_px = ReprojectionRms(rig, normalised, T);
  return pose;
}

RigPose TooFewPoints(size_t points) {
  RigPose pose;
  pose.num_points = static_cast<int>(points);
  pose.status = RigPose::Status::kTooFewPoints;
  return pose;
}

}  // namespace

RigPose EstimateRigPose(const camera::Rig& rig, const std::vector<PointSighting>& sightings) {
  const std::vector<NormalisedSighting> normalised = Normalise(rig, sightings);
  if (normalised.size() < 4) return TooFewPoints(normalised.size());
  const auto start = BestStart(rig, normalised);
  if (start) return Refine(rig, normalised, *start);
  RigPose pose;
  pose.num_points = static_cast<int>(normalised.size());
  pose.status = RigPose::Status::kDegenerate;
  return pose;
}

RigPose RefineRigPose(const camera::Rig& rig, const std::vector<PointSighting>& sightings,
                      const Eigen::Isometry3d& start) {
  const std::vector<NormalisedSighting> normalised = Normalise(rig, sightings);
  if (normalised.size() < 4) return TooFewPoints(normalised.size());
  return Refine(rig, normalised, start);
}

}  // namespace softforce::vision
