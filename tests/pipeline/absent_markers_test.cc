#include <gtest/gtest.h>

#include "pipeline/self_cover.h"
#include "softforce/pipeline/tracker.h"
#include "support/box_mesh.h"
#include "support/dotted_sheet.h"

namespace softforce::pipeline {
namespace {

using testing::DottedSheetRig;
using testing::DottedSheetScene;
using testing::MakeDottedSheet;

constexpr double kRadius = 2e-3, kClearance = 1e-3;  // m

struct Box {
  mesh::TetMesh mesh = testing::MakeBox(4, 4, 2, {0.04, 0.04, 0.02});
  mesh::Surface surface = mesh::ExtractSurface(mesh);

  bool Covers(const Eigen::Vector3d& eye, const Eigen::Vector3d& point,
              const Eigen::Vector3d& normal) const {
    return SelfCover(surface, mesh.nodes).Covers(eye, point, normal, kRadius, kClearance);
  }
};

TEST(SelfCover, HidesWhatLiesBehindTheBody) {
  const Box box;
  const Eigen::Vector3d eye(0.02, 0.02, 0.5), up = Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(box.Covers(eye, {0.02, 0.02, 0}, up));
  EXPECT_TRUE(box.Covers(eye, {0.01, 0.03, -0.1}, up));
  EXPECT_FALSE(box.Covers(eye, {0.02, 0.02, 0.02}, up)) << "it lies on top";
  EXPECT_FALSE(box.Covers(eye, {0.02, 0.02, 0.1}, up)) << "it is in front";
  EXPECT_FALSE(box.Covers(eye, {0.08, 0.02, 0}, up)) << "it is beside the body";
}

TEST(SelfCover, DoesNotHideADiscOfWhichAPartLooksOut) {
  const Box box;
  const Eigen::Vector3d eye(0.02, 0.02, 100), up = Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(box.Covers(eye, {0.04 - 1.5 * kRadius, 0.0201, 0}, up));
  EXPECT_FALSE(box.Covers(eye, {0.04 - 0.5 * kRadius, 0.0201, 0}, up));
}

// The cameras look down on the sheet.
TEST(Tracker, KnowsWhichMarkersNoCameraCanSee) {
  scene::Scene scene = DottedSheetScene();
  scene.markers.points.push_back({40, {0.1, 0.04, 0}});  // on its underside
  const World world = BuildWorld(scene, MakeDottedSheet({10, 5, 1}));
  const camera::Rig rig = DottedSheetRig();
  Tracker tracker(scene, world, rig, Eigen::Isometry3d::Identity(), geometry::Matrix6d::Zero());
  const FrameResult result = tracker.Process(0, 0, std::vector<CameraDetections>(2));
  ASSERT_EQ(result.markers.size(), 41u);
  for (int m = 0; m < 40; ++m) EXPECT_FALSE(result.markers[m].expected_absent) << m;
  EXPECT_TRUE(result.markers[40].expected_absent);
  EXPECT_EQ(result.markers[40].status, MarkerStatus::kHidden);
}

// The sheet at rest; `except` is hidden from the first so many cameras.
std::vector<CameraDetections> SeeAllBut(int except, int cameras, const World& world,
                                        const camera::Rig& rig) {
  std::vector<CameraDetections> seen;
  for (const camera::Camera& camera : rig.cameras) {
    seen.emplace_back();
    for (int m = 0; m < static_cast<int>(world.markers.size()); ++m) {
      if (m == except && static_cast<int>(seen.size()) <= cameras) continue;
      const Eigen::Vector3d p =
          camera.T_camera_rig * world.markers[m].weights.Apply(world.mesh().nodes);
      const Eigen::Vector3d normal = camera.T_camera_rig.linear() * Eigen::Vector3d::UnitZ();
      vision::Dot dot;
      dot.centroid = *camera::ProjectDiscCentroid(camera.lens, p, normal, testing::kDotDiameter);
      dot.covariance = 1e-3 * Eigen::Matrix2d::Identity();
      dot.long_axis = dot.short_axis = testing::kDotDiameter * camera.lens.fx / p.z();
      seen.back().dots.push_back(dot);
    }
  }
  return seen;
}

TEST(Tracker, BelievesADotThatComesBackInOneCameraAloneWhenItIsSeenAgain) {
  const scene::Scene scene = DottedSheetScene();
  const World world = BuildWorld(scene, MakeDottedSheet({10, 5, 1}));
  const camera::Rig rig = DottedSheetRig();
  Tracker tracker(scene, world, rig, Eigen::Isometry3d::Identity(), geometry::Matrix6d::Zero());
  constexpr int kMarker = 11;
  std::vector<MarkerStatus> statuses;
  for (const int cameras : {2, 1, 1, 0, 1, 2, 0}) {
    const int frame = static_cast<int>(statuses.size());
    const FrameResult result =
        tracker.Process(frame, frame / 30.0, SeeAllBut(kMarker, cameras, world, rig));
    ASSERT_EQ(result.status, estimation::ForceEstimate::Status::kOk) << result.reason;
    for (int m = 0; m < 40; ++m) {
      if (m == kMarker) continue;
      EXPECT_EQ(result.markers[m].status, MarkerStatus::kSeen) << m;
    }
    statuses.push_back(result.markers[kMarker].status);
  }
  using Status = MarkerStatus;
  EXPECT_EQ(statuses,
            (std::vector<Status>{Status::kHidden,
                                 Status::kHidden,     // in one camera, for the first time
                                 Status::kOneCamera,  // and again
                                 Status::kSeen,
                                 Status::kOneCamera,                 // one camera has lost it
                                 Status::kHidden, Status::kSeen}));  // back in both at once
}

}  // namespace
}  // namespace softforce::pipeline
