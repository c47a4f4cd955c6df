#include <gtest/gtest.h>

#include "softforce/render/overlay.h"

namespace softforce::render {
namespace {

cv::Mat MakePicture(int width, int height, int type = CV_8UC3) {
  return cv::Mat(height, width, type, cv::Scalar::all(90));
}

TEST(SideBySide, KeepsPicturesThatFit) {
  const cv::Mat row =
      SideBySide({MakePicture(640, 512), MakePicture(640, 512)}, {"left", "right"}, 1280);

  EXPECT_EQ(row.size(), cv::Size(1280, 512));
  EXPECT_EQ(row.type(), CV_8UC3);
}

TEST(SideBySide, ScalesAllPicturesDownTogether) {
  const cv::Mat row =
      SideBySide({MakePicture(1280, 1024), MakePicture(640, 512)}, {"left", "right"}, 960);

  EXPECT_EQ(row.size(), cv::Size(960, 512));
  EXPECT_EQ(row.at<cv::Vec3b>(128, 800), cv::Vec3b(90, 90, 90));  // the second is half as large
  EXPECT_EQ(row.at<cv::Vec3b>(400, 800), cv::Vec3b(0, 0, 0));
}

TEST(SideBySide, NeverExceedsTheWidthAndHasEvenSides) {
  for (int max_width = 301; max_width < 340; ++max_width) {
    const cv::Mat row =
        SideBySide({MakePicture(641, 511), MakePicture(641, 511), MakePicture(333, 511)},
                   {"a", "b", "c"}, max_width);
    EXPECT_LE(row.cols, max_width);
    EXPECT_EQ(row.cols % 2, 0);
    EXPECT_EQ(row.rows % 2, 0);
  }
}

TEST(SideBySide, TakesGreyPictures) {
  const cv::Mat row = SideBySide({MakePicture(640, 512, CV_8UC1)}, {"left"}, 1280);

  EXPECT_EQ(row.type(), CV_8UC3);
  EXPECT_EQ(row.at<cv::Vec3b>(100, 100), cv::Vec3b(90, 90, 90));
}

TEST(SideBySide, WritesADifferentNameOnEachPicture) {
  const cv::Mat row =
      SideBySide({MakePicture(640, 512), MakePicture(640, 512)}, {"left", "right"}, 1280);

  const cv::Mat left = row.colRange(0, 640);
  const cv::Mat right = row.colRange(640, 1280);
  EXPECT_GT(cv::norm(left, right, cv::NORM_INF), 50);
}

}  // namespace
}  // namespace softforce::render
