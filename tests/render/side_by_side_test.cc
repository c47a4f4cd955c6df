#include "softforce/render/side_by_side.h"

#include <gtest/gtest.h>

namespace softforce::render {
namespace {

TEST(SideBySide, KeepsPicturesThatFit) {
  const PictureRow row = SideBySide({{640, 512}, {640, 512}}, 1280);

  EXPECT_EQ(row.size, cv::Size(1280, 512));
  EXPECT_EQ(row.cells[1], cv::Rect(640, 0, 640, 512));
}

TEST(SideBySide, ScalesAllPicturesDownTogether) {
  const PictureRow row = SideBySide({{1280, 1024}, {640, 512}}, 960);

  EXPECT_EQ(row.size, cv::Size(960, 512));
  EXPECT_EQ(row.cells[1], cv::Rect(640, 0, 320, 256));
}

TEST(SideBySide, NeverExceedsTheWidthAndHasEvenSides) {
  for (int max_width = 301; max_width < 340; ++max_width) {
    const PictureRow row = SideBySide({{641, 511}, {641, 511}, {333, 511}}, max_width);
    EXPECT_LE(row.size.width, max_width);
    EXPECT_EQ(row.size.width % 2, 0);
    EXPECT_EQ(row.size.height % 2, 0);
  }
}

TEST(PutPicture, TakesGreyPicturesAndColouredOnesOfAnySize) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    for (const cv::Size& size : {cv::Size(40, 30), cv::Size(80, 60)}) {
      cv::Mat3b page(40, 50, cv::Vec3b(1, 2, 3));
      PutPicture(cv::Mat(size, type, cv::Scalar::all(90)), page(cv::Rect(5, 5, 40, 30)));
      EXPECT_EQ(page(5, 5), cv::Vec3b(90, 90, 90));
      EXPECT_EQ(page(34, 44), cv::Vec3b(90, 90, 90));
      EXPECT_EQ(page(35, 45), cv::Vec3b(1, 2, 3)) << "beside the cell";
    }
  }
}

TEST(Scaled, SeesAPointWhereTheScaledPictureShowsIt) {
  camera::Camera camera;
  camera.width = 1280;
  camera.height = 1024;
  camera.lens.fx = camera.lens.fy = 1500;
  camera.lens.cx = 640;
  camera.lens.cy = 500;
  camera.lens.distortion[0] = -0.1;
  const Eigen::Vector3d p_camera(0.1, -0.07, 0.5);
  const Eigen::Vector2d full = camera::Project(camera.lens, p_camera).pixel;

  const camera::Camera half = Scaled(camera, {1280, 1024}, {640, 512});

  // Pixels count from the centre of the first one, which is half a pixel from the picture's corner.
  const Eigen::Vector2d expected = (full.array() + 0.5) / 2 - 0.5;
  EXPECT_LT((camera::Project(half.lens, p_camera).pixel - expected).norm(), 1e-9);  // px; rounding
  EXPECT_EQ(half.width, 640);
}

TEST(DrawName, WritesADifferentNameOnEachPicture) {
  cv::Mat3b left(512, 640, cv::Vec3b::all(90)), right = left.clone();
  Easel easel;

  DrawName(left, "left", &easel);
  DrawName(right, "right", &easel);

  EXPECT_GT(cv::norm(left, right, cv::NORM_INF), 50);
}

}  // namespace
}  // namespace softforce::render
