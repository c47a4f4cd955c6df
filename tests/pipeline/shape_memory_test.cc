#include "pipeline/shape_memory.h"

#include <gtest/gtest.h>

#include "support/dotted_sheet.h"

namespace softforce::pipeline {
namespace {

// The dotted sheet's markers, raised by so much at its free end.
std::vector<PredictedFeature> Raised(double z) {
  std::vector<PredictedFeature> features;
  for (const auto& point : testing::DottedSheetScene().markers.points) {
    PredictedFeature feature;
    feature.position = point.position;
    feature.position.z() += z * point.position.x() / 0.13;
    feature.normal = Eigen::Vector3d::UnitZ();
    feature.diameter = testing::kDotDiameter;
    features.push_back(feature);
  }
  return features;
}

// Marks a state, for it to be known again.
estimation::ForceEstimator::Memory StateOf(double z) {
  estimation::ForceEstimator::Memory state;
  state.intensity = Eigen::VectorXd::Constant(1, z);
  return state;
}

void LearnRaised(double z, ShapeMemory* memory) {
  const std::vector<PredictedFeature> features = Raised(z);
  if (memory->IsNew(features)) memory->Learn(StateOf(z), features);
}

// What the cameras see of the markers from number `first` on.
std::vector<CameraDetections> Seen(const std::vector<PredictedFeature>& features, size_t first) {
  const camera::Rig rig = testing::DottedSheetRig();
  std::vector<CameraDetections> seen(rig.cameras.size());
  for (size_t c = 0; c < seen.size(); ++c) {
    for (size_t f = first; f < features.size(); ++f) {
      const camera::Camera& camera = rig.cameras[c];
      const Eigen::Vector3d p = camera.T_camera_rig * features[f].position;
      vision::Dot dot;
      dot.centroid = camera::Project(camera.lens, p).pixel;
      dot.covariance = 0.01 * Eigen::Matrix2d::Identity();
      dot.long_axis = dot.short_axis = testing::kDotDiameter * camera.lens.fx / p.z();
      dot.contrast = 80;
      seen[c].dots.push_back(dot);
    }
  }
  return seen;
}

TEST(ShapeMemory, KeepsShapesThatDifferByHalfASpacing) {
  ShapeMemory memory(testing::kDotSpacing);
  LearnRaised(0, &memory);
  LearnRaised(0.4 * testing::kDotSpacing, &memory);
  EXPECT_EQ(memory.size(), 1u);
  LearnRaised(0.6 * testing::kDotSpacing, &memory);
  EXPECT_EQ(memory.size(), 2u);
}

TEST(ShapeMemory, FindsTheShapeOfWhichHalfIsSeen) {
  ShapeMemory memory(testing::kDotSpacing);
  for (const double z : {0.0, 0.01, 0.02, 0.03, 0.04}) LearnRaised(z, &memory);

  const auto found = memory.Resembling(testing::DottedSheetRig(), Eigen::Isometry3d::Identity(),
                                       Seen(Raised(0.031), 20), ObserveOptions(), {}, 2);

  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0]->state.intensity(0), 0.03);
}

TEST(ShapeMemory, CoversAllThatTheBodyDidWithAFewShapes) {
  ShapeMemory memory(testing::kDotSpacing);
  for (int i = 0; i <= 500; ++i) LearnRaised(2e-4 * i, &memory);  // 0.1 m

  EXPECT_LE(memory.size(), ShapeMemory::kMostShapes);
  EXPECT_GE(memory.size(), ShapeMemory::kMostShapes / 4);
  for (const double z : {0.0, 0.05, 0.1}) {
    EXPECT_FALSE(memory.IsNew(Raised(z))) << z << " m: something near it was seen";
  }
}

TEST(ShapeMemory, HasNothingToSayBeforeAnythingWasSeen) {
  const ShapeMemory memory(testing::kDotSpacing);
  EXPECT_TRUE(memory
                  .Resembling(testing::DottedSheetRig(), Eigen::Isometry3d::Identity(),
                              Seen(Raised(0), 0), ObserveOptions(), {}, 4)
                  .empty());
}

}  // namespace
}  // namespace softforce::pipeline
