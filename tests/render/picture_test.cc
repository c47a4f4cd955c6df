#include "softforce/render/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "softforce/base/input_error.h"
#include "softforce/mesh/tet_mesh.h"
#include "softforce/vision/dots.h"
#include "softforce/vision/tag_cells.h"
#include "softforce/vision/tags.h"
#include "support/box_mesh.h"
#include "support/stereo_rig.h"

namespace softforce::render {
namespace {

// A plate of 160 × 160 × 8 mm of 10-node cells that is bent to a saddle, some 0.45 m before the
// right camera of a stereo rig, and askew.
class BentPlate : public ::testing::Test {
 protected:
  BentPlate() {
    camera_ = testing::MakeStereoRig().cameras[1];
    mesh_ = mesh::RaiseOrder(testing::MakeBox(8, 8, 1, {0.16, 0.16, 0.008}));
    surface_ = mesh::ExtractSurface(mesh_);
    x_ = mesh_.nodes;
    for (int i = 0; i < x_.cols(); ++i) {
      const double s = x_(0, i) / 0.08 - 1, t = x_(1, i) / 0.08 - 1;
      x_.col(i) += Eigen::Vector3d(0.001 * t * t, 0.002 * s, 0.012 * s * s - 0.008 * t * t);
    }
    Eigen::Matrix3d R;  // the plate's z towards the camera
    R << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    T_camera_robot_.linear() = Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.6, 0.8, 0)) *
                               Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) * R;
    T_camera_robot_.translation() = Eigen::Vector3d(0.01, -0.02, 0.45) -
                                    T_camera_robot_.linear() * Eigen::Vector3d(0.08, 0.08, 0);
    options_.light = T_camera_robot_.linear().transpose() * Eigen::Vector3d(0.2, -0.3, -1);
    options_.noise = 0;
  }

  static Sticker StickerAt(double x, double y, double size) {
    return {{x, y, 0.008}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), size, {}, 0};
  }
  static Sticker TagAt(double x, double y, double size, int id) {
    const vision::TagCells tag = vision::DrawTag("tag36h11", id);
    Sticker sticker = StickerAt(x, y, size);
    const Eigen::AngleAxisd turn(0.3 * id, Eigen::Vector3d::UnitZ());
    sticker.right = turn * sticker.right;
    sticker.up = turn * sticker.up;
    sticker.cells = tag.cells;
    sticker.margin = tag.margin;
    return sticker;
  }

  Picture Take(const std::vector<Sticker>& stickers, const std::vector<Sticker>& cards = {},
               const std::vector<Rod>& rods = {}, std::uint32_t seed = 1) const {
    const PictureWorld world{&surface_, &mesh_.nodes, stickers, cards};
    return PictureMaker(camera_, T_camera_robot_, world, options_).Take(x_, rods, seed);
  }

  // Where a place of the surface at rest is now, camera frame.
  Eigen::Vector3d Now(const Eigen::Vector3d& X) const {
    return T_camera_robot_ *
           mesh::Position(surface_, x_, mesh::ClosestSurfacePoint(surface_, mesh_.nodes, X).at);
  }
  Eigen::Vector2d PixelOf(const Eigen::Vector3d& X) const {
    return camera::Project(camera_.lens, Now(X)).pixel;
  }

  // The centroid of the picture of a disc that was painted at rest: places all over the disc, each
  // weighted by how much of the picture its surroundings cover.
  Eigen::Vector2d CentroidOf(const Sticker& disc) const {
    constexpr int kRings = 6, kSpokes = 16;
    constexpr double kStep = 1e-5;  // m
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weights = 0;
    for (int r = 0; r < kRings; ++r) {
      for (int s = 0; s < kSpokes; ++s) {
        const double radius = disc.size / 2 * std::sqrt((r + 0.5) / kRings);
        const double angle = 2 * M_PI * (s + 0.5 * (r % 2)) / kSpokes;
        const Eigen::Vector3d X =
            disc.centre + radius * (std::cos(angle) * disc.right + std::sin(angle) * disc.up);
        const Eigen::Vector2d p = PixelOf(X);
        const Eigen::Vector2d by_right = PixelOf(X + kStep * disc.right) - p;
        const Eigen::Vector2d by_up = PixelOf(X + kStep * disc.up) - p;
        const double weight = std::abs(by_right.x() * by_up.y() - by_right.y() * by_up.x());
        sum += weight * p;
        weights += weight;
      }
    }
    return sum / weights;
  }

  camera::Camera camera_;
  mesh::TetMesh mesh_;
  mesh::Surface surface_;
  Eigen::Matrix3Xd x_;
  Eigen::Isometry3d T_camera_robot_ = Eigen::Isometry3d::Identity();
  PictureOptions options_;
};

std::vector<std::pair<double, double>> Places() {
  std::vector<std::pair<double, double>> places;
  for (int i = 0; i < 16; ++i) {
    places.emplace_back(0.025 + 0.036 * (i % 4) + 0.0013 * (i % 3), 0.025 + 0.036 * (i / 4));
  }
  return places;
}

TEST_F(BentPlate, HasItsDotsWhereTheDetectorFindsThem) {
  options_.noise = 1.7;
  std::vector<Sticker> dots;
  for (const auto& [x, y] : Places()) dots.push_back(StickerAt(x, y, 0.006));

  const Picture picture = Take(dots);
  const std::vector<vision::Dot> found = vision::DetectDots(picture.grey);

  ASSERT_EQ(found.size(), dots.size());
  double squares = 0;
  for (const Sticker& dot : dots) {
    double nearest = 1e9;
    for (const vision::Dot& candidate : found) {
      nearest = std::min(nearest, (candidate.centroid - CentroidOf(dot)).norm());
    }
    squares += nearest * nearest;
  }
  // px, of the 2-D distance: the noise of 1.7 grey levels alone gives 0.01.
  EXPECT_LT(std::sqrt(squares / static_cast<double>(dots.size())), 0.025);
  for (const double share : picture.visible_share) EXPECT_NEAR(share, 1, 0.01);
}

TEST_F(BentPlate, HasItsTagsWhereTheDetectorFindsThem) {
  options_.noise = 1.7;
  std::vector<Sticker> tags;
  for (const auto& [x, y] : Places()) {
    tags.push_back(TagAt(x, y, 0.014, static_cast<int>(tags.size())));
  }

  const Picture picture = Take(tags);
  const std::vector<vision::Tag> found = vision::TagDetector("tag36h11").Detect(picture.grey);

  ASSERT_EQ(found.size(), tags.size());
  double squares = 0;
  for (const vision::Tag& tag : found) {
    const Sticker& sticker = tags[tag.id];
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d corner =
          sticker.centre +
          sticker.size / 2 *
              ((i == 1 || i == 2 ? 1 : -1) * sticker.right + (i < 2 ? 1 : -1) * sticker.up);
      squares += (tag.corners[i] - PixelOf(corner)).squaredNorm();
    }
  }
  // px, of the 2-D distance: noise, and edges that are curved on the bent plate but fitted
  // straight.
  EXPECT_LT(std::sqrt(squares / (4.0 * static_cast<double>(found.size()))), 0.1);
  for (const double share : picture.visible_share) EXPECT_NEAR(share, 1, 0.01);
}

TEST_F(BentPlate, ShowsCardsThatAreDetectedAsTags) {
  Sticker card = TagAt(-0.06, 0.08, 0.02, 0);  // beside the plate and below it
  card.centre.z() = -0.03;

  const std::vector<vision::Tag> found =
      vision::TagDetector("tag36h11").Detect(Take({}, {card}).grey);

  ASSERT_EQ(found.size(), 1u);
  const Eigen::Vector3d top_left = card.centre + card.size / 2 * (card.up - card.right);
  const Eigen::Vector2d expected = camera::Project(camera_.lens, T_camera_robot_ * top_left).pixel;
  EXPECT_LT((found[0].corners[0] - expected).norm(), 0.05);  // px; 1/32 px between rays
}

TEST_F(BentPlate, HidesWhatIsBehindARod) {
  const std::vector<Sticker> dots{StickerAt(0.05, 0.05, 0.006), StickerAt(0.11, 0.11, 0.006)};
  const Eigen::Vector3d before = dots[0].centre + Eigen::Vector3d(0, 0, 0.03);
  const Eigen::Vector3d behind = dots[1].centre - Eigen::Vector3d(0, 0, 0.1);
  const auto rod = [](const Eigen::Vector3d& at) {
    return Rod{at - Eigen::Vector3d(0.01, 0, 0), at + Eigen::Vector3d(0.01, 0, 0), 0.03, 100};
  };

  const Picture picture = Take(dots, {}, {rod(before), rod(behind)});

  EXPECT_EQ(picture.visible_share[0], 0);
  EXPECT_NEAR(picture.visible_share[1], 1, 0.01);
  EXPECT_EQ(vision::DetectDots(picture.grey).size(), 1u);
}

TEST_F(BentPlate, DoesNotShowWhatIsOnItsOtherSide) {
  Sticker under = StickerAt(0.08, 0.08, 0.006);
  under.centre.z() = 0;
  under.right = -under.right;

  const Picture picture = Take({under});

  EXPECT_EQ(picture.visible_share[0], 0);
  EXPECT_TRUE(vision::DetectDots(picture.grey).empty());
}

TEST_F(BentPlate, LooksTheSameForOneSeedAndElseOnlyNoisesDiffer) {
  options_.noise = 2;
  const std::vector<Sticker> dots{StickerAt(0.05, 0.05, 0.006)};
  const cv::Mat first = Take(dots, {}, {}, 5).grey, again = Take(dots, {}, {}, 5).grey;
  const cv::Mat other = Take(dots, {}, {}, 6).grey;

  EXPECT_EQ(cv::norm(first, again, cv::NORM_INF), 0);
  // Two independent noises of 2 grey levels, rounded to whole ones: √(2 · (4 + 1/12)).
  const double rms = cv::norm(first, other, cv::NORM_L2) / std::sqrt(first.total());
  EXPECT_NEAR(rms, std::sqrt(2 * (4 + 1 / 12.0)), 0.02);
}

TEST_F(BentPlate, FollowsContrastBrightnessAndGradient) {
  const auto ground_at = [](const Picture& picture, int x) {
    return static_cast<double>(picture.grey.at<uchar>(10, x));
  };
  const int right = camera_.width - 1;
  options_.ground = 80;
  options_.contrast = 1.5;
  options_.brightness = -20;
  options_.light_gradient.x() = 0.2;

  const Picture picture = Take({});

  EXPECT_NEAR(ground_at(picture, 0), 80 * 0.9 * 1.5 - 20, 1);  // grey levels; rounded
  EXPECT_NEAR(ground_at(picture, right), 80 * 1.1 * 1.5 - 20, 1);
}

TEST(PictureOptions, RefusesEachOptionOutOfRange) {
  const auto refused = [](auto set, const char* name) {
    PictureOptions options;
    set(options);
    try {
      options.Check();
    } catch (const base::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused([](auto& o) { o.blur = -1; }, "blur"));
  EXPECT_TRUE(refused([](auto& o) { o.noise = NAN; }, "noise"));
  EXPECT_TRUE(refused([](auto& o) { o.contrast = 0; }, "contrast"));
  EXPECT_TRUE(refused([](auto& o) { o.brightness = 300; }, "brightness"));
  EXPECT_TRUE(refused([](auto& o) { o.light_gradient = {1.5, 1.5}; }, "light_gradient"));
  EXPECT_TRUE(refused([](auto& o) { o.ambient = 2; }, "ambient"));
  EXPECT_TRUE(refused([](auto& o) { o.light.setZero(); }, "light"));
}

}  // namespace
}  // namespace softforce::render
