#include "pipeline/registration.h"

#include <gtest/gtest.h>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

camera::Rig PlacedRig() {
  camera::Rig rig;
  rig.cameras.resize(1);
  rig.T_rig_robot = Eigen::Translation3d(0.1, -0.2, 0.7) *
                    Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized());
  rig.T_rig_robot_covariance.diagonal() << 1e-8, 2e-8, 3e-8, 4e-8, 5e-8, 6e-8;
  rig.T_rig_robot_covariance(0, 4) = rig.T_rig_robot_covariance(4, 0) = 1e-8;
  return rig;
}

TEST(FindRig, TakesPlaceAndCovarianceFromTheRigIfThereAreNoFiducials) {
  const scene::Scene scene;
  const camera::Rig rig = PlacedRig();
  const Standing standing = FindRig(scene, rig, Detector(scene, rig), {});
  EXPECT_EQ(standing.T_rig_robot.matrix(), rig.T_rig_robot->matrix());
  EXPECT_EQ(standing.covariance, rig.T_rig_robot_covariance);
  EXPECT_FALSE(standing.from_fiducials.has_value());
}

TEST(FindRig, RefusesARigOfWhichNothingSaysWhereItStands) {
  const scene::Scene scene;
  const camera::Rig rig;
  EXPECT_THROW(FindRig(scene, rig, Detector(scene, rig), {}), base::InputError);
}

TEST(PointCovariance, IsThatOfThePointUnderSmallMotionsOfTheRig) {
  const camera::Rig rig = PlacedRig();
  const Eigen::Vector3d p(0.3, 0.1, -0.2);
  // By finite differences of the motion.
  const double step = 1e-6;
  Eigen::Matrix<double, 3, 6> J;
  for (int i = 0; i < 6; ++i) {
    const geometry::Vector6d xi = step * geometry::Vector6d::Unit(i);
    J.col(i) = (geometry::ExpSe3(xi) * *rig.T_rig_robot * p -
                geometry::ExpSe3(-xi) * *rig.T_rig_robot * p) /
               (2 * step);
  }
  const Eigen::Matrix3d expected = J * rig.T_rig_robot_covariance * J.transpose();
  const Eigen::Matrix3d found = PointCovariance(*rig.T_rig_robot, rig.T_rig_robot_covariance, p);
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-15);  // m²; of 1e-8, differences to 1e-9
}

}  // namespace
}  // namespace softforce::pipeline
