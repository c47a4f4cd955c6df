#include "softforce/vision/tag_follower.h"

#include <gtest/gtest.h>

#include <random>

#include "softforce/base/input_error.h"
#include "vision/tag_pictures.h"

namespace softforce::vision {
namespace {

using softforce::testing::Corners;
using softforce::testing::PaintTag;
using softforce::testing::SquareAt;
using softforce::testing::SyntheticScene;

constexpr double kSide = 44;  // px

struct Put {
  int id;
  Eigen::Vector2d middle;  // px
};
cv::Mat PictureOf(const std::vector<Put>& tags) {
  SyntheticScene scene(420, 300, 120, 0.7);
  for (const Put& tag : tags) {
    PaintTag(DrawTag("tag36h11", tag.id), SquareAt(tag.middle, kSide, 0.2), &scene);
  }
  std::mt19937 random(3);
  return scene.TakePicture(2, random);
}

std::vector<int> IdsOf(const std::vector<Tag>& tags) {
  std::vector<int> ids;
  for (const Tag& tag : tags) ids.push_back(tag.id);
  return ids;
}

TEST(TagFollower, FindsTheSameNearATagAsInTheWholePicture) {
  const TagDetector detector("tag36h11");
  TagFollower follower;
  for (int i = 0; i < 6; ++i) {  // at 7 px per picture
    const cv::Mat picture = PictureOf({{3, {80.0 + 7 * i, 90}}, {8, {300, 200.0 - 7 * i}}});
    const std::vector<Tag> near = follower.Detect(detector, picture);
    const std::vector<Tag> all = detector.Detect(picture);
    ASSERT_EQ(IdsOf(near), (std::vector<int>{3, 8})) << i;
    ASSERT_EQ(all.size(), 2u);
    for (size_t t = 0; t < 2; ++t) {
      for (int k = 0; k < 4; ++k) {
        // px; the fit of the sides starts from corners that AprilTag finds in other parts
        EXPECT_LT((near[t].corners[k] - all[t].corners[k]).norm(), 0.01);
      }
    }
  }
  EXPECT_EQ(follower.whole_searches(), 1);
}

TEST(TagFollower, SearchesTheWholePictureSeldomWhileATagStaysAway) {
  const TagDetector detector("tag36h11");
  TagFollower follower;
  const cv::Mat both = PictureOf({{3, {90, 90}}, {8, {300, 200}}});
  const cv::Mat one = PictureOf({{3, {90, 90}}});
  follower.Detect(detector, both);

  constexpr int kPictures = 60;
  for (int i = 0; i < kPictures; ++i) {
    EXPECT_EQ(IdsOf(follower.Detect(detector, one)), std::vector<int>{3}) << i;
  }

  // At once, after 2, 4, 8, and then every 15 pictures.
  EXPECT_LE(follower.whole_searches(), 1 + 4 + kPictures / 15);
  EXPECT_GE(follower.whole_searches(), 1 + kPictures / 15);
}

TEST(TagFollower, FindsATagAgainAtOnceWhereItWasHidden) {
  const TagDetector detector("tag36h11");
  TagFollower follower;
  const cv::Mat both = PictureOf({{3, {90, 90}}, {8, {300, 200}}});
  const cv::Mat one = PictureOf({{3, {90, 90}}});
  follower.Detect(detector, both);
  for (int i = 0; i < 20; ++i) follower.Detect(detector, one);

  EXPECT_EQ(IdsOf(follower.Detect(detector, both)), (std::vector<int>{3, 8}));
}

TEST(TagFollower, FindsAtOnceWhereATagHasJumpedTo) {
  const TagDetector detector("tag36h11");
  TagFollower follower;
  follower.Detect(detector, PictureOf({{3, {90, 90}}}));
  follower.Detect(detector, PictureOf({{3, {90, 90}}}));

  const std::vector<Tag> tags = follower.Detect(detector, PictureOf({{3, {330, 220}}}));

  ASSERT_EQ(IdsOf(tags), std::vector<int>{3});
  EXPECT_NEAR(tags[0].corners[0].x(), SquareAt({330, 220}, kSide, 0.2)[0].x(), 0.1);  // px
}

TEST(TagFollower, NoticesANewTagWithinTheInterval) {
  const TagDetector detector("tag36h11");
  TagFollowerOptions options;
  options.whole_interval = 5;
  TagFollower follower(options);
  for (int i = 0; i < 3; ++i) follower.Detect(detector, PictureOf({{3, {90, 90}}}));
  const cv::Mat both = PictureOf({{3, {90, 90}}, {8, {300, 200}}});
  std::vector<Tag> tags;
  for (int i = 0; i < options.whole_interval; ++i) tags = follower.Detect(detector, both);
  EXPECT_EQ(IdsOf(tags), (std::vector<int>{3, 8}));
}

TEST(TagFollower, ReturnsBothPrintsOfOneId) {
  const TagDetector detector("tag36h11");
  TagFollower follower;
  const cv::Mat twice = PictureOf({{3, {90, 90}}, {3, {300, 200}}});
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(IdsOf(follower.Detect(detector, twice)), (std::vector<int>{3, 3})) << i;
  }
}

TEST(TagFollower, HasNothingToSayOfAPictureThatIsMissing) {
  const TagDetector detector("tag36h11");
  EXPECT_TRUE(TagFollower().Detect(detector, cv::Mat()).empty());
}

TEST(TagFollowerOptions, RefusesValuesOutOfRange) {
  const auto refuses = [](auto change) {
    TagFollowerOptions options;
    change(options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  EXPECT_NO_THROW(TagFollowerOptions().Check());
  refuses([](TagFollowerOptions& o) { o.margin_share = -1; });
  refuses([](TagFollowerOptions& o) { o.min_margin = 3; });
  refuses([](TagFollowerOptions& o) { o.whole_interval = 0; });
  refuses([](TagFollowerOptions& o) { o.forget = 0; });
  refuses([](TagFollowerOptions& o) { o.small_side = -1; });
}

}  // namespace
}  // namespace softforce::vision
