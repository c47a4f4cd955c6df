#include "softforce/vision/tags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <iostream>
#include <random>

#include "softforce/base/input_error.h"
#include "vision/tag_pictures.h"

namespace softforce::vision {
namespace {

using softforce::testing::Corners;
using softforce::testing::PaintBox;
using softforce::testing::PaintTag;
using softforce::testing::SquareAt;
using softforce::testing::SyntheticScene;
using ::testing::HasSubstr;

constexpr double kGround = 220;  // grey levels; a tag's own paper
constexpr double kBlur = 0.7;    // px

cv::Mat PictureOf(const TagCells& tag, const Corners& corners, double noise = 2,
                  unsigned seed = 1) {
  SyntheticScene scene(260, 240, kGround, kBlur);
  PaintTag(tag, corners, &scene);
  std::mt19937 random(seed);
  return scene.TakePicture(noise, random);
}

double WorstError(const Tag& tag, const Corners& truth) {
  double worst = 0;
  for (int i = 0; i < 4; ++i) worst = std::max(worst, (tag.corners[i] - truth[i]).norm());
  return worst;
}

// The tag of id 5 as cv::aruco::drawMarker draws it (OpenCV 4.6, DICT_APRILTAG_36h11).
TagCells DrawnByOpenCv() {
  const std::vector<std::string> rows = {"........", "...##.#.", "..###...", ".##.#.#.",
                                         "..##.##.", ".#...##.", "...####.", "........"};
  TagCells tag{cv::Mat1b(10, 10, uchar{255}), 1};
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) tag.cells(y + 1, x + 1) = rows[y][x] == '#' ? 255 : 0;
  }
  return tag;
}

TEST(TagDetector, GivesTheCornersOfAnUprightTagAsOpenCvDrawsIt) {
  const Corners truth = SquareAt({120.3, 110.7}, 64);

  const auto tags = TagDetector("tag36h11").Detect(PictureOf(DrawnByOpenCv(), truth));

  ASSERT_EQ(tags.size(), 1u);
  EXPECT_EQ(tags[0].id, 5);
  EXPECT_EQ(tags[0].family, "tag36h11");
  EXPECT_LT(WorstError(tags[0], truth), 0.15);  // px; order TL TR BR BL
}

TEST(TagDetector, HasTheCentreOfTheFirstPixelAtZero) {
  const TagDetector detector("tag36h11");
  const TagCells drawn = DrawTag("tag36h11", 7);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr int kTags = 30;
  Eigen::Vector2d bias = Eigen::Vector2d::Zero();
  double square = 0, normalised = 0;
  for (int i = 0; i < kTags; ++i) {
    const Corners truth = SquareAt({120 + unit(random), 110 + unit(random)}, 60 + 5 * unit(random),
                                   0.5 * unit(random));
    const auto tags = detector.Detect(PictureOf(drawn, truth, 2, static_cast<unsigned>(i)));
    ASSERT_EQ(tags.size(), 1u) << i;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d error = tags[0].corners[k] - truth[k];
      bias += error / (4 * kTags);
      square += error.squaredNorm() / (4 * kTags);
      normalised += error.dot(tags[0].corner_covariances[k].inverse() * error) / (8 * kTags);
    }
  }
  std::cout << "tag corners: bias " << bias.transpose() << " px, RMS (2-D) " << std::sqrt(square)
            << " px, normalised " << normalised << "\n";
  RecordProperty("rms_px", std::to_string(std::sqrt(square)));
  EXPECT_LT(bias.cwiseAbs().maxCoeff(), 0.02);  // px; AprilTag's own convention would give 0.5
  EXPECT_LT(std::sqrt(square), 0.02);           // px; noise leaves 0.01
  // The covariance is honest; standard error 0.09, corners of one tag sharing edges.
  EXPECT_GT(normalised, 0.6);
  EXPECT_LT(normalised, 1.6);
}

TEST(TagDetector, IsExactlyPlacedWithoutTurn) {
  const TagDetector detector("tag36h11");
  Eigen::Vector2d bias = Eigen::Vector2d::Zero();
  constexpr int kShifts = 8;
  for (int i = 0; i < kShifts; ++i) {
    const double shift = static_cast<double>(i) / kShifts;
    const Corners truth = SquareAt({120 + shift, 110 + 0.7 * shift}, 64);
    const auto tags = detector.Detect(PictureOf(DrawTag("tag36h11", 3), truth, 0));
    ASSERT_EQ(tags.size(), 1u) << shift;
    for (int k = 0; k < 4; ++k) bias += (tags[0].corners[k] - truth[k]) / (4 * kShifts);
  }
  EXPECT_LT(bias.cwiseAbs().maxCoeff(), 0.02);  // px
}

class TagFamilies : public ::testing::TestWithParam<const char*> {};

TEST_P(TagFamilies, HaveTheirCornersAndCentreFound) {
  const TagDetector detector(GetParam());
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr int kTags = 12;
  double square = 0, centre2 = 0, normalised = 0;
  for (int i = 0; i < kTags; ++i) {
    const int id = 2 * i;
    const Corners truth = SquareAt({125 + unit(random), 118 + unit(random)}, 56 + 8 * unit(random),
                                   2 * M_PI * unit(random));
    const auto tags =
        detector.Detect(PictureOf(DrawTag(GetParam(), id), truth, 2, static_cast<unsigned>(i)));
    ASSERT_EQ(tags.size(), 1u) << id;
    EXPECT_EQ(tags[0].id, id);
    EXPECT_EQ(tags[0].family, GetParam());
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d error = tags[0].corners[k] - truth[k];
      centre += 0.25 * error;
      square += error.squaredNorm() / (4 * kTags);
      normalised += error.dot(tags[0].corner_covariances[k].inverse() * error) / (8 * kTags);
    }
    centre2 += centre.squaredNorm() / kTags;
  }
  std::cout << GetParam() << ": corners " << std::sqrt(square) << " px, centres "
            << std::sqrt(centre2) << " px (RMS, 2-D), normalised " << normalised << "\n";
  EXPECT_LT(std::sqrt(square), 0.03);   // px; noise leaves 0.01
  EXPECT_LT(std::sqrt(centre2), 0.02);  // px
  // Three standard errors; the corners of a tag share edges.
  EXPECT_GT(normalised, 0.4);
  EXPECT_LT(normalised, 1.7);
}

INSTANTIATE_TEST_SUITE_P(Printed, TagFamilies,
                         ::testing::Values("tag36h11", "tag25h9", "tag16h5", "tagStandard41h12"));

TEST(TagDetector, SeesTagsWhoseCellsAreLessThanTwoPixelsWide) {
  TagOptions options;
  options.decimate = 1;
  const TagDetector detector("tag36h11", options);
  const Corners truth = SquareAt({120.3, 110.7}, 16, 0.4);  // 8 cells

  const auto tags = detector.Detect(PictureOf(DrawTag("tag36h11", 7), truth));

  ASSERT_EQ(tags.size(), 1u);
  EXPECT_LT(WorstError(tags[0], truth), 0.1);  // px; four standard deviations
}

// A fit that took sides for straight would miss the corners by a third of what the lens bends them.
TEST(TagDetector, FollowsTheSidesThatALensBends) {
  camera::Lens lens{250, 250, 129.5, 119.5, {-0.2, 0.05, 0, 0}};  // bends a side by 1 px
  const Corners square = SquareAt({0, 0}, 0.6, 0.3);              // on the plane z = 1
  SyntheticScene scene(260, 240, kGround, kBlur);
  const TagCells tag = DrawTag("tag36h11", 3);
  const Eigen::Rotation2Dd turn(-0.3);
  const double cells = tag.cells.cols - 2 * tag.margin;
  scene.Paint({129.5, 119.5}, 150, [&](const Eigen::Vector2d& p) -> double {
    const Eigen::Vector2d on_plane = turn * camera::Unproject(lens, p).value();
    const Eigen::Vector2d cell =
        (on_plane.array() / 0.6 + 0.5) * cells + static_cast<double>(tag.margin);
    const auto x = static_cast<int>(std::floor(cell.x())),
               y = static_cast<int>(std::floor(cell.y()));
    if (x < 0 || y < 0 || x >= tag.cells.cols || y >= tag.cells.rows) return NAN;
    return tag.cells(y, x) > 0 ? 220 : 30;
  });
  std::mt19937 random(1);

  const auto tags = TagDetector("tag36h11").Detect(scene.TakePicture(2, random), &lens);

  ASSERT_EQ(tags.size(), 1u);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d truth = camera::Project(lens, square[k].homogeneous()).pixel;
    EXPECT_LT((tags[0].corners[k] - truth).norm(), 0.05) << k;  // px; five standard deviations
  }
}

TEST(TagDetector, SeesATagInPerspective) {
  const Corners truth{Eigen::Vector2d(80.4, 70.2), {160.1, 82.6}, {150.7, 160.3}, {90.8, 150.9}};
  const auto tags = TagDetector("tag36h11").Detect(PictureOf(DrawTag("tag36h11", 11), truth));
  ASSERT_EQ(tags.size(), 1u);
  EXPECT_LT(WorstError(tags[0], truth), 0.2);  // px
}

TEST(TagDetector, RefusesATagAtThePicturesEdge) {
  const TagDetector detector("tag36h11");
  for (const double inset : {-3.0, 0.0, 2.0}) {
    const Corners truth = SquareAt({32 + inset, 120.4}, 64);  // left side at x = inset
    EXPECT_TRUE(detector.Detect(PictureOf(DrawTag("tag36h11", 3), truth)).empty()) << inset;
  }
}

TEST(TagDetector, GivesNoWrongCornersWhereAnEdgeIsCovered) {
  const TagDetector detector("tag36h11");
  const Corners truth = SquareAt({120.3, 110.7}, 64);
  SyntheticScene bare(260, 240, kGround, kBlur);
  PaintTag(DrawTag("tag36h11", 3), truth, &bare);
  for (const double covered :
       {2.0, 4.0, 6.0, 10.0, 20.0}) {  // px of the left side, from the top down
    for (const double height : {8.0, 20.0, 40.0, 70.0}) {
      SyntheticScene scene = bare;
      PaintBox({80, 76}, {88.3 + covered, 76 + height}, 150, &scene);
      std::mt19937 random(1);
      for (const Tag& tag : detector.Detect(scene.TakePicture(2, random))) {
        EXPECT_LT(WorstError(tag, truth), 0.5) << covered << " x " << height;  // px
      }
    }
  }
}

TEST(TagDetector, FindsNothingInNoise) {
  std::mt19937 random(4);
  const cv::Mat noise = SyntheticScene(640, 512, 128).TakePicture(60, random);
  for (const char* family : {"tag36h11", "tag25h9", "tag16h5", "tagStandard41h12"}) {
    EXPECT_TRUE(TagDetector(family).Detect(noise).empty()) << family;
  }
}

TEST(TagDetector, RefusesAFamilyThatItDoesNotKnow) {
  try {
    TagDetector detector("tag99h9");
    FAIL() << "accepted";
  } catch (const base::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"tag99h9\""));
    EXPECT_THAT(error.what(), HasSubstr("tag36h11, tag25h9, tag16h5, tagStandard41h12"));
  }
}

TEST(TagOptions, RefusesValuesOutOfRange) {
  const auto refuses = [](auto change) {
    TagOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  EXPECT_NO_THROW(TagOptions().Check());
  refuses([](TagOptions& o) { o.decimate = 0.5; });
  refuses([](TagOptions& o) { o.decimate = 9; });
  refuses([](TagOptions& o) { o.max_corrected_bits = -1; });
  refuses([](TagOptions& o) { o.max_corrected_bits = 4; });
  refuses([](TagOptions& o) { o.min_decision_margin = -1; });
  refuses([](TagOptions& o) { o.black_border = 0; });
  refuses([](TagOptions& o) { o.black_border = 3; });
  refuses([](TagOptions& o) { o.border = -1; });
}

}  // namespace
}  // namespace softforce::vision
