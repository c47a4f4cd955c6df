#include "estimation/model_error.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

namespace softforce::estimation {
namespace {

constexpr double kOffsetFloor = 1e-9;  // m; far below what any camera sees
constexpr double kExtentFloor = 1e-3;  // m; a single marker has none, and shows no rotation

}  // namespace

WhitenedObservation Whiten(const Observation& observation, int index, double model_sd,
                           int companions) {
  const Eigen::Matrix3d information = observation.whitening.transpose() * observation.whitening;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(information);  // ascending
  // Directions that the measurement says nothing about (one camera) stay without a row.
  const double least = 1e-12 * axes.eigenvalues()(2);
  const int rows = static_cast<int>((axes.eigenvalues().array() > least).count());
  WhitenedObservation whitened{index, &observation, Whitening(rows, 3), INFINITY};
  for (int i = 0; i < rows; ++i) {
    const int axis = 3 - rows + i;
    // n companions with one error in common, counted as n with independent ones of n times the
    // variance, say as much about where their mean is.
    const double variance = 1 / axes.eigenvalues()(axis) + companions * model_sd * model_sd;
    whitened.whitening.row(i) = axes.eigenvectors().col(axis).transpose() / std::sqrt(variance);
    whitened.sd = std::min(whitened.sd, std::sqrt(variance));
  }
  return whitened;
}

std::vector<int> CountCompanions(const std::vector<Observation>& observations) {
  std::map<int, int> count;
  for (const Observation& seen : observations) ++count[seen.marker];
  std::vector<int> companions;
  companions.reserve(observations.size());
  for (const Observation& seen : observations) {
    companions.push_back(seen.marker < 0 ? 1 : count[seen.marker]);
  }
  return companions;
}

PointCloud CloudOf(const std::vector<WhitenedObservation>& observations,
                   const Eigen::Matrix3Xd& x) {
  PointCloud cloud{Eigen::Vector3d::Zero(), 0};
  const auto n = static_cast<double>(observations.size());
  for (const WhitenedObservation& seen : observations) {
    cloud.centre += seen.observation->at.Apply(x) / n;
  }
  for (const WhitenedObservation& seen : observations) {
    cloud.extent += (seen.observation->at.Apply(x) - cloud.centre).squaredNorm() / n;
  }
  cloud.extent = std::sqrt(cloud.extent);
  return cloud;
}

geometry::Matrix6d OffsetCovariance(const PointCloud& cloud, const geometry::Matrix6d& registration,
                                    double model_sd) {
  // The rig's place, carried from the robot's origin to the centre.
  geometry::Matrix6d to_centre = geometry::Matrix6d::Identity();
  to_centre.topRightCorner<3, 3>() = -geometry::Skew(cloud.centre);
  geometry::Matrix6d P = to_centre * registration * to_centre.transpose();
  // The model's common error moves the points about as far by turning as by shifting. The floor
  // keeps P regular.
  const double shift = std::hypot(model_sd, kOffsetFloor);
  const double turn = shift / std::max(cloud.extent, kExtentFloor);
  P.diagonal().head<3>().array() += shift * shift;
  P.diagonal().tail<3>().array() += turn * turn;
  return P;
}

OffsetPrior MakeOffsetPrior(const std::vector<WhitenedObservation>& observations,
                            const Eigen::Matrix3Xd& x, const geometry::Matrix6d& registration,
                            double model_sd) {
  const PointCloud cloud = CloudOf(observations, x);
  const geometry::Matrix6d L = OffsetCovariance(cloud, registration, model_sd).llt().matrixL();
  return {cloud.centre, L.inverse()};
}

Eigen::Vector3d Misfit(const Observation& observation, const Eigen::Vector3d& on_model,
                       const OffsetPrior& prior, const geometry::Vector6d& offset) {
  const Eigen::Vector3d arm = on_model - prior.centre;
  return on_model + offset.head<3>() + offset.tail<3>().cross(arm) + observation.offset -
         observation.position;
}

Eigen::Matrix<double, 3, 6> OffsetJacobian(const Eigen::Vector3d& on_model,
                                           const OffsetPrior& prior) {
  Eigen::Matrix<double, 3, 6> J;
  J.leftCols<3>().setIdentity();
  J.rightCols<3>() = -geometry::Skew(on_model - prior.centre);
  return J;
}

}  // namespace softforce::estimation
