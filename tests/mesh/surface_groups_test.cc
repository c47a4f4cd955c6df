#include "softforce/mesh/surface_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>

#include "softforce/base/input_error.h"
#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

using softforce::testing::MakeBox;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// 60 × 40 × 20 mm in bricks of 10 mm: two triangles per square of the surface.
TetMesh Block() {
  TetMesh block = MakeBox(6, 4, 2, {0.06, 0.04, 0.02});
  block.surface_groups.clear();
  return block;
}

// The block without its elements around some places (m), which leaves hollows.
TetMesh BlockWithHollows(const std::vector<Eigen::Vector3d>& places) {
  TetMesh block = MakeBox(9, 5, 5, {0.09, 0.05, 0.05});
  block.surface_groups.clear();
  std::vector<int> kept;
  for (int e = 0; e < block.num_elements(); ++e) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int i = 0; i < 4; ++i) centre += block.nodes.col(block.elements(i, e)) / 4;
    bool hollow = false;
    for (const auto& place : places) {
      hollow |= (centre - place).lpNorm<Eigen::Infinity>() < 0.005;
    }
    if (!hollow) kept.push_back(e);
  }
  const Eigen::MatrixXi elements = block.elements(Eigen::all, kept);
  block.elements = elements;
  block.region.assign(kept.size(), 0);
  return block;
}

double AreaOf(const TetMesh& mesh, const std::string& group) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.surface_groups.at(group)) {
    const Eigen::Vector3d p = mesh.nodes.col(a), q = mesh.nodes.col(b), r = mesh.nodes.col(c);
    area += (q - p).cross(r - p).norm() / 2;
  }
  return area;
}

TetMesh WithGroup(const TetMesh& mesh, const std::string& selector) {
  return WithSurfaceGroups(mesh, {"part=" + selector}, "block.msh");
}

struct Selection {
  const char* selector;
  double area_mm2;  // by hand
};

class Selector : public ::testing::TestWithParam<Selection> {};

TEST_P(Selector, SelectsThePartThatItDescribes) {
  const TetMesh block = WithGroup(Block(), GetParam().selector);

  EXPECT_NEAR(1e6 * AreaOf(block, "part"), GetParam().area_mm2, 1e-6);  // mm²; rounding
}

INSTANTIATE_TEST_SUITE_P(
    OnABlock, Selector,
    ::testing::Values(
        Selection{"z-max", 2400}, Selection{"x-min", 800}, Selection{"y-max", 1200},
        Selection{"plane(0 0 20 mm, 0 0 3)", 2400}, Selection{"plane(1 1 2 cm, 0 0 -1)", 2400},
        Selection{"box(0 0 0, 20 20 20 mm)", 2 * 400 + 2 * 400},
        Selection{"box(20 20 20 mm, 0 0 0 mm)", 2 * 400 + 2 * 400},
        Selection{"normal(0 0 2, 10 deg)", 2400}, Selection{"normal(1 1 0, 46 deg)", 800 + 1200},
        Selection{"near(30 20 21 mm, 30 deg)", 2400}, Selection{"near(30 20 21 mm, 91 deg)", 8800},
        Selection{"outer", 8800}, Selection{"z-max & box(0 0 0, 30 40 20 mm)", 1200}));

TEST(SurfaceGroups, OfTheSameNameAddUp) {
  const TetMesh block =
      WithSurfaceGroups(Block(), {"ends=x-min", "ends=x-max", "ends=x-max"}, "block.msh");

  EXPECT_NEAR(1e6 * AreaOf(block, "ends"), 1600, 1e-6);  // mm²; rounding
}

TEST(SurfaceGroups, ListTrianglesSeenFromOutside) {
  const TetMesh block = WithGroup(Block(), "z-max");
  const auto [a, b, c] = block.surface_groups.at("part")[0];
  const Eigen::Vector3d p = block.nodes.col(a), q = block.nodes.col(b), r = block.nodes.col(c);

  EXPECT_GT((q - p).cross(r - p).z(), 0);
}

TEST(SurfaceGroups, OfACavityAreTheWholeWallOfAHollow) {
  const TetMesh block = WithGroup(BlockWithHollows({{0.045, 0.025, 0.025}}), "cavity");

  EXPECT_NEAR(1e6 * AreaOf(block, "part"), 600, 1e-6);  // mm², a cube of 10 mm; rounding
}

TEST(SurfaceGroups, OfSeveralCavitiesAreNumberedByTheirPlace) {
  const TetMesh block = WithGroup(
      BlockWithHollows({{0.065, 0.025, 0.025}, {0.025, 0.035, 0.025}, {0.025, 0.015, 0.025}}),
      "cavity");

  ASSERT_EQ(block.surface_groups.size(), 3u);
  const auto first_node = [&](const char* name) -> Eigen::Vector3d {
    return block.nodes.col(block.surface_groups.at(name)[0][0]);
  };
  EXPECT_LT(first_node("part-1").y(), 0.021);
  EXPECT_GT(first_node("part-2").y(), 0.029);
  EXPECT_GT(first_node("part-3").x(), 0.059);
}

TEST(SurfaceGroups, OfAnOpenHollowAreNotACavity) {
  EXPECT_THAT(
      [] {
        WithGroup(BlockWithHollows({{0.005, 0.025, 0.025}}), "cavity");
      },
      ThrowsMessage<base::InputError>(HasSubstr("closed all around")));
}

struct Refusal {
  const char* request;
  const char* text;
};

class BadRequest : public ::testing::TestWithParam<Refusal> {};

TEST_P(BadRequest, IsRefusedByName) {
  EXPECT_THAT(
      [] { WithSurfaceGroups(Block(), {GetParam().request}, "block.msh"); },
      ThrowsMessage<base::InputError>(AllOf(HasSubstr("--group"), HasSubstr(GetParam().text))));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadRequest,
    ::testing::Values(Refusal{"top", "NAME=SELECTOR"}, Refusal{"=z-max", "NAME=SELECTOR"},
                      Refusal{"to\"p=z-max", "NAME=SELECTOR"},
                      Refusal{"a=up", "no selector \"up\""}, Refusal{"a=", "no selector \"\""},
                      Refusal{"a=box(0 0 0 mm)", "1 arguments"},
                      Refusal{"a=box(0 0 0, 1 1 1)", "no unit"},
                      Refusal{"a=box(0 0 0, 1 1 1 mm", "parenthesis"},
                      Refusal{"a=box(0 0, 1 1 1 mm)", "expected 3"},
                      Refusal{"a=normal(0 0 0, 5 deg)", "must have a length"},
                      Refusal{"a=normal(0 0 1, 5 mm)", "mm"},
                      Refusal{"a=normal(0 0 1, -10 deg)", "the angle is -10 deg"},
                      Refusal{"a=near(0 0 0 mm, 181 deg)", "the angle is 181 deg"},
                      Refusal{"a=near(0 0 90 mm, 5 deg)", "off the surface"},
                      Refusal{"a=box(70 0 0, 90 40 20 mm)", "selects no triangle"},
                      Refusal{"a=z-min & z-max", "selects no triangle"}));

TEST(SurfaceGroups, RefuseANameThatTheMeshHas) {
  const TetMesh block = WithGroup(Block(), "z-max");

  EXPECT_THAT([&] { WithGroup(block, "z-min"); },
              ThrowsMessage<base::InputError>(HasSubstr("already")));
}

}  // namespace
}  // namespace softforce::mesh
