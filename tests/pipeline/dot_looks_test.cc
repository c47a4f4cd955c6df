#include <gtest/gtest.h>

#include "softforce/base/input_error.h"
#include "softforce/pipeline/tracker.h"
#include "support/dotted_sheet.h"

namespace softforce::pipeline {
namespace {

using testing::DottedSheetRig;
using testing::DottedSheetScene;
using testing::MakeDottedSheet;

constexpr int kMarker = 11;  // that is hidden, and has something else in its place

// The sheet at rest, all dots printed 1.2 times as large as the scene says; where kMarker is, there
// is a thing `size` times as large as the others, of a contrast of its own.
std::vector<CameraDetections> See(double size, double contrast, const World& world,
                                  const camera::Rig& rig) {
  constexpr double kPrint = 1.2;
  std::vector<CameraDetections> seen;
  for (const camera::Camera& camera : rig.cameras) {
    seen.emplace_back();
    for (int m = 0; m < static_cast<int>(world.markers.size()); ++m) {
      const Eigen::Vector3d p =
          camera.T_camera_rig * world.markers[m].weights.Apply(world.mesh().nodes);
      const Eigen::Vector3d normal = camera.T_camera_rig.linear() * Eigen::Vector3d::UnitZ();
      vision::Dot dot;
      dot.centroid = *camera::ProjectDiscCentroid(camera.lens, p, normal, testing::kDotDiameter);
      dot.covariance = 1e-3 * Eigen::Matrix2d::Identity();
      dot.long_axis = dot.short_axis =
          (m == kMarker ? size : 1) * kPrint * testing::kDotDiameter * camera.lens.fx / p.z();
      dot.contrast = m == kMarker ? contrast : 80;
      seen.back().dots.push_back(dot);
    }
  }
  return seen;
}

// After a frame in which all markers were seen as they are.
MarkerStatus StatusWith(double size, double contrast) {
  const scene::Scene scene = DottedSheetScene();
  const World world = BuildWorld(scene, MakeDottedSheet({10, 5, 1}));
  const camera::Rig rig = DottedSheetRig();
  Tracker tracker(scene, world, rig, Eigen::Isometry3d::Identity(), geometry::Matrix6d::Zero());
  tracker.Process(0, 0, See(1, 80, world, rig));
  const FrameResult result = tracker.Process(1, 1 / 30.0, See(size, contrast, world, rig));
  EXPECT_EQ(result.status, estimation::ForceEstimate::Status::kOk) << result.reason;
  for (int m = 0; m < 40; ++m) {
    if (m == kMarker) continue;
    EXPECT_EQ(result.markers[m].status, MarkerStatus::kSeen) << m;
  }
  return result.markers[kMarker].status;
}

TEST(DotLooks, AThingOfAnotherSizeInTheMarkersPlaceIsNotTheMarker) {
  EXPECT_EQ(StatusWith(1.4, 80), MarkerStatus::kHidden);
  EXPECT_EQ(StatusWith(0.7, 80), MarkerStatus::kHidden);
}

TEST(DotLooks, ADarkThingIsNoBrightMarker) { EXPECT_EQ(StatusWith(1, -80), MarkerStatus::kHidden); }

TEST(DotLooks, AMarkerThatLooksALittleDifferentIsSeen) {
  EXPECT_EQ(StatusWith(1.15, 30), MarkerStatus::kSeen);
  EXPECT_EQ(StatusWith(0.87, 160), MarkerStatus::kSeen);
}

TEST(ObserveOptions, RefusesASpreadOfSizesThatLeavesNone) {
  ObserveOptions options;
  options.size_spread = 1;
  EXPECT_THROW(options.Check(), base::InputError);
}

}  // namespace
}  // namespace softforce::pipeline
