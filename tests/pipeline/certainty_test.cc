#include "pipeline/certainty.h"

#include <gtest/gtest.h>

#include <cmath>

namespace softforce::pipeline {
namespace {

using calibration::Calibration;

// A calibration of cameras whose projection is uncertain by so many px all over.
Calibration Certain(const std::vector<double>& sds, camera::LensModel model) {
  Calibration calibration;
  calibration.status = Calibration::Status::kOk;
  for (const double sd : sds) {
    camera::Camera camera;
    camera.lens.model = model;
    calibration.rig.cameras.push_back(camera);
    calibration::ProjectionUncertainty map;
    map.distance = 0.4;
    for (int i = 0; i < 10; ++i) map.x.push_back(64 * i);
    map.y = map.x;
    map.sd_px = Eigen::MatrixXd::Constant(10, 10, sd);
    calibration.uncertainty.push_back(map);
  }
  return calibration;
}

constexpr auto kBrown = camera::LensModel::kBrownConrady;
constexpr auto kFisheye = camera::LensModel::kKannalaBrandt;

TEST(CertaintyOf, IsThatOfTheWorstCamera) {
  const Certainty certainty = CertaintyOf(Certain({0.1, 0.3, 0.2}, kBrown));
  EXPECT_EQ(certainty.camera, 1);
  EXPECT_EQ(certainty.sd_px, 0.3);
  EXPECT_EQ(certainty.distance, 0.4);
  EXPECT_TRUE(certainty.Within(0.3));
  EXPECT_FALSE(certainty.Within(0.29));
}

TEST(CertaintyOf, LeavesATenthOfThePictureOutButTellsWhere) {
  Calibration calibration = Certain({0.1}, kBrown);
  calibration.uncertainty[0].sd_px.row(9).head(9).setConstant(5);
  calibration.uncertainty[0].sd_px(9, 3) = 7;
  const Certainty certainty = CertaintyOf(calibration);
  EXPECT_EQ(certainty.sd_px, 0.1);
  EXPECT_EQ(certainty.worst, Eigen::Vector2d(64 * 3, 64 * 9));
  calibration.uncertainty[0].sd_px.row(8).setConstant(5);
  EXPECT_EQ(CertaintyOf(calibration).sd_px, 5);
}

TEST(CertaintyOf, IsNoneWhereALensHasFoldedOver) {
  Calibration calibration = Certain({0.1}, kBrown);
  calibration.uncertainty[0].sd_px.leftCols(2).setConstant(NAN);
  EXPECT_FALSE(CertaintyOf(calibration).Within(1e9));
}

TEST(CertaintyOf, DoesNotLookBeyondTheCircleOfAFisheye) {
  Calibration calibration = Certain({0.1}, kFisheye);
  calibration.uncertainty[0].sd_px.leftCols(2).setConstant(NAN);
  EXPECT_TRUE(CertaintyOf(calibration).Within(0.1));
}

TEST(CertaintyOf, SaysWhyThereIsNone) {
  Calibration calibration;
  calibration.status = Calibration::Status::kUndetermined;
  calibration.reason = "the board never tilts";
  const Certainty certainty = CertaintyOf(calibration);
  EXPECT_FALSE(certainty.Within(1e9));
  EXPECT_EQ(certainty.Text({}), "the board never tilts");
}

}  // namespace
}  // namespace softforce::pipeline
