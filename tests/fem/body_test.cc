#include "softforce/fem/body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "softforce/base/input_error.h"
#include "support/soft_bodies.h"

namespace softforce::fem {
namespace {

std::string Refusal(const Body& body) {
  try {
    body.Check("scene.yaml: body");
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Body, ThatIsHeldIsAccepted) { EXPECT_EQ(Refusal(testing::MakeBar()), ""); }

TEST(Body, ThatFloatsIsRefused) {
  Body body = testing::MakeBar();
  body.fixed_nodes.clear();
  EXPECT_THAT(Refusal(body), ::testing::HasSubstr("scene.yaml: body: fixed"));
}

TEST(Body, ThatCanTurnAboutALineIsRefused) {
  Body body = testing::MakeBar(1);
  body.fixed_nodes.clear();
  for (int n = 0; n < body.mesh.num_nodes(); ++n) {
    if (body.mesh.nodes.col(n).tail<2>().norm() < 1e-9) body.fixed_nodes.push_back(n);  // an edge
  }
  ASSERT_GE(body.fixed_nodes.size(), 3u);
  EXPECT_THAT(Refusal(body), ::testing::HasSubstr("not in line"));
}

TEST(Body, OfWhichAPartFloatsIsRefused) {
  Body body = testing::MakeBar(1);
  const mesh::TetMesh other = testing::MakeBox(1, 1, 1, {0.01, 0.01, 0.01});
  const int first = body.mesh.num_nodes();
  mesh::TetMesh& mesh = body.mesh;
  mesh.nodes.conservativeResize(3, first + other.num_nodes());
  mesh.nodes.rightCols(other.num_nodes()) = other.nodes.colwise() + Eigen::Vector3d(0.5, 0, 0);
  const int cells = mesh.num_elements();
  mesh.elements.conservativeResize(4, cells + other.num_elements());
  mesh.elements.rightCols(other.num_elements()) = other.elements.array() + first;
  mesh.region.resize(mesh.num_elements(), 0);
  EXPECT_THAT(Refusal(body), ::testing::HasSubstr("falls into 2 parts that share no node"));
  EXPECT_THAT(Refusal(body), ::testing::HasSubstr("(500.0 0.0 0.0) mm"));
}

// x held on x = 0, y on y = 0, z on z = 0: an eighth of a body that is symmetric to three planes.
Body HeldBySymmetry(int planes) {
  Body body = testing::MakeBar(1);
  body.fixed_nodes.clear();
  for (int n = 0; n < body.mesh.num_nodes(); ++n) {
    for (int axis = 0; axis < planes; ++axis) {
      if (body.mesh.nodes(axis, n) < 1e-9) body.fixed_components.push_back({n, axis});
    }
  }
  return body;
}

TEST(Body, HeldByThreePlanesOfSymmetryIsAccepted) { EXPECT_EQ(Refusal(HeldBySymmetry(3)), ""); }

TEST(Body, HeldByTwoPlanesOfSymmetryCanDriftAndIsRefused) {
  EXPECT_THAT(Refusal(HeldBySymmetry(2)), ::testing::HasSubstr("drifting"));
}

TEST(Body, ThatIsHeldEverywhereIsRefused) {
  Body body = testing::MakeBar(1);
  body.fixed_nodes.clear();
  for (int n = 0; n < body.mesh.num_nodes(); ++n) body.fixed_nodes.push_back(n);
  EXPECT_THAT(Refusal(body), ::testing::HasSubstr("nothing can move"));
}

TEST(Body, WithACableThatPullsAtAFixedPlaceIsRefused) {
  Body body = testing::MakeBar();
  body.cables.push_back({"left", {testing::PointOf(body, {0, 0.005, 0.01})}, {0, 0, 0.1}});
  EXPECT_THAT(Refusal(body), ::testing::HasSubstr("cable \"left\""));
}

TEST(Body, WithACableWithoutDirectionIsRefused) {
  Body body = testing::MakeBar();
  body.cables.push_back({"left", {testing::PointOf(body, {0.1, 0.005, 0.01})}, {0.1, 0.005, 0.01}});
  EXPECT_THAT(Refusal(body), ::testing::HasSubstr("guide"));
}

TEST(Body, OfImpossibleMaterialIsRefused) {
  Body body = testing::MakeBar();
  body.materials[0].poissons_ratio = 0.5;
  EXPECT_THAT(Refusal(body), ::testing::HasSubstr("poissons_ratio"));
}

}  // namespace
}  // namespace softforce::fem
