#include "softforce/simulation/scenery.h"

#include <gtest/gtest.h>

#include "support/box_mesh.h"

namespace softforce::simulation {
namespace {

TEST(Occluder, MovesEvenlyDuringItsTime) {
  Occluder occluder;
  occluder.from_s = 1;
  occluder.until_s = 3;
  occluder.begin = {0, 0, 1};
  occluder.end = {4, 0, 1};
  occluder.reach = {0, 2, 0};
  occluder.diameter = 0.1;

  EXPECT_FALSE(occluder.At(0.9));
  EXPECT_FALSE(occluder.At(3));
  ASSERT_TRUE(occluder.At(1.5));
  EXPECT_TRUE(occluder.At(1.5)->begin.isApprox(Eigen::Vector3d(1, 0, 1)));
  EXPECT_TRUE(occluder.At(1.5)->end.isApprox(Eigen::Vector3d(1, 2, 1)));
}

TEST(Occluder, StandsStillIfItHasNoEnd) {
  Occluder occluder;
  occluder.begin = occluder.end = {1, 2, 3};
  occluder.diameter = 0.1;
  ASSERT_TRUE(occluder.At(1e6));
  EXPECT_EQ(occluder.At(1e6)->begin, occluder.begin);
}

class OnABox : public ::testing::Test {
 protected:
  const mesh::TetMesh mesh_ = testing::MakeBox(4, 4, 1, {0.2, 0.2, 0.02});
  const mesh::Surface surface_ = mesh::ExtractSurface(mesh_);
};

TEST_F(OnABox, AStickerLiesFlatAndUpright) {
  const Eigen::Vector3d up(0.1, 1, 0.5);
  const render::Sticker sticker = StickerAt(surface_, mesh_.nodes, {0.07, 0.11, 0.021}, 0.01, up);

  EXPECT_TRUE(sticker.centre.isApprox(Eigen::Vector3d(0.07, 0.11, 0.02), 1e-12));
  EXPECT_TRUE(sticker.normal().isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
  EXPECT_TRUE(sticker.up.isApprox(Eigen::Vector3d(0.1, 1, 0).normalized(), 1e-12));
}

TEST_F(OnABox, DecoysKeepClearOfMarkersAndOfEachOther) {
  constexpr double kDiameter = 0.006;  // m
  const std::vector<render::Sticker> markers{DiscAt(surface_, mesh_.nodes, {0.1, 0.1, 0.02}, 0.03)};

  const auto decoys =
      StrewDecoys(surface_, mesh_.nodes, 40, kDiameter, Eigen::Vector3d::UnitZ(), markers, 5);

  ASSERT_EQ(decoys.size(), 40u);
  for (size_t i = 0; i < decoys.size(); ++i) {
    EXPECT_NEAR(decoys[i].centre.z(), 0.02, 1e-12);  // m; only the top faces that way
    EXPECT_GT((decoys[i].centre - markers[0].centre).norm(), 0.015 + kDiameter);
    for (size_t j = 0; j < i; ++j) {
      EXPECT_GT((decoys[i].centre - decoys[j].centre).norm(), 1.5 * kDiameter);
    }
  }
  const auto again =
      StrewDecoys(surface_, mesh_.nodes, 40, kDiameter, Eigen::Vector3d::UnitZ(), markers, 5);
  const auto other =
      StrewDecoys(surface_, mesh_.nodes, 40, kDiameter, Eigen::Vector3d::UnitZ(), markers, 6);
  EXPECT_EQ(again[0].centre, decoys[0].centre);
  EXPECT_NE(other[0].centre, decoys[0].centre);
}

TEST_F(OnABox, GivesFewerDecoysWhereThereIsNoRoom) {
  const auto decoys = StrewDecoys(surface_, mesh_.nodes, 100, 0.1, Eigen::Vector3d::UnitZ(), {}, 5);
  EXPECT_GT(decoys.size(), 0u);
  EXPECT_LT(decoys.size(), 20u);
}

}  // namespace
}  // namespace softforce::simulation
