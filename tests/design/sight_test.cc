#include "softforce/design/sight.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "design/plate.h"
#include "softforce/base/input_error.h"
#include "softforce/camera/triangulate.h"
#include "support/stereo_rig.h"

namespace softforce::design {
namespace {

// The plate 0.4 m before the left camera, its top towards it.
Eigen::Isometry3d BeforeTheCameras() {
  Eigen::Isometry3d T_rig_robot = Eigen::Isometry3d::Identity();
  T_rig_robot.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  T_rig_robot.translation() = Eigen::Vector3d(-0.05, 0.03, 0.4);
  return T_rig_robot;
}

class SightTest : public ::testing::Test {
 protected:
  Sight Look(const SightOptions& options = {}) {
    return {rig_, T_rig_robot_, plate_.surface, plate_.body.mesh.nodes, options};
  }

  testing::Plate plate_;
  camera::Rig rig_ = testing::MakeStereoRig();
  Eigen::Isometry3d T_rig_robot_ = BeforeTheCameras();
};

TEST_F(SightTest, TheTopIsSeenAndTheUndersideIsNot) {
  const Sight sight = Look();

  EXPECT_EQ(sight.NumCameras(plate_.At({0.05, 0.03, 0.008})), 2);
  EXPECT_EQ(sight.NumCameras(plate_.At({0.05, 0.03, 0})), 0);
}

TEST_F(SightTest, AMarkerBesideThePictureIsNotSeen) {
  rig_.cameras[0].width = rig_.cameras[1].width = 660;  // what is right of x = 0.05 m is outside

  EXPECT_FALSE(Look().Sees(0, plate_.At({0.09, 0.03, 0.008})));
  EXPECT_TRUE(Look().Sees(0, plate_.At({0.02, 0.03, 0.008})));
}

TEST_F(SightTest, AMarkerBehindAnotherPartOfTheBodyIsNotSeen) {
  // A second plate 40 mm above the first half.
  mesh::TetMesh both = testing::MakeBox(4, 4, 1, {0.1, 0.06, 0.008});
  mesh::TetMesh above = testing::MakeBox(2, 4, 1, {0.05, 0.06, 0.008});
  above.nodes.row(2).array() += 0.048;
  const int offset = both.num_nodes();
  const Eigen::MatrixXi first = both.elements;
  both.elements.resize(4, first.cols() + above.elements.cols());
  both.elements << first, (above.elements.array() + offset).matrix();
  const Eigen::Matrix3Xd nodes = both.nodes;
  both.nodes.resize(3, offset + above.num_nodes());
  both.nodes << nodes, above.nodes;
  both.region.assign(both.num_elements(), 0);
  const mesh::Surface surface = mesh::ExtractSurface(both);
  const Sight sight(rig_, T_rig_robot_, surface, both.nodes, {});
  const auto at = [&](double x) {
    return mesh::ClosestSurfacePoint(surface, both.nodes, {x, 0.03, 0.008}).at;
  };

  EXPECT_FALSE(sight.Sees(0, at(0.03)));
  EXPECT_TRUE(sight.Sees(0, at(0.08)));
}

TEST_F(SightTest, ItsCovarianceIsThatOfTriangulation) {
  const mesh::SurfacePoint at = plate_.At({0.07, 0.02, 0.008});

  const MarkerSight seen = Look().Of(at);

  const auto pixels = testing::ProjectInto(rig_, T_rig_robot_ * seen.position, 0.05);
  const camera::Triangulation found = camera::Triangulate(rig_, pixels);
  ASSERT_TRUE(found.ok());
  const Eigen::Matrix3d R = T_rig_robot_.linear();
  const Eigen::Matrix3d expected = R.transpose() * found.covariance * R;
  const Eigen::Matrix3d covariance = seen.information.inverse();
  // Share: the second-order terms that triangulation leaves out as well; rounding.
  EXPECT_LT((covariance - expected).norm(), 1e-6 * expected.norm());
}

TEST_F(SightTest, RefusesOptionsOutOfRange) {
  const auto refuses = [](auto change) {
    SightOptions options;
    change(&options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  refuses([](SightOptions* o) { o->pixel_sd = 0; });
  refuses([](SightOptions* o) { o->marker_size = -1; });
  refuses([](SightOptions* o) { o->min_facing = 1; });
  refuses([](SightOptions* o) { o->edge = -1; });
}

}  // namespace
}  // namespace softforce::design
