#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "softforce/base/input_error.h"
#include "softforce/mesh/tet_mesh.h"
#include "support/box_mesh.h"

namespace softforce::mesh {
namespace {

using base::InputError;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TetMesh Box() { return testing::MakeBox(2, 2, 2, {0.02, 0.02, 0.02}); }

TEST(CheckMesh, AcceptsASoundMeshOfEitherOrder) {
  EXPECT_NO_THROW(CheckMesh(Box(), "box.msh"));
  EXPECT_NO_THROW(CheckMesh(RaiseOrder(Box()), "box.msh"));
}

TEST(CheckMesh, RefusesAMeshWithoutElements) {
  TetMesh mesh = Box();
  mesh.elements.resize(4, 0);
  EXPECT_THAT([&] { CheckMesh(mesh, "box.msh"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("box.msh"), HasSubstr("no tetrahedra"))));
}

TEST(CheckMesh, RefusesCoordinatesThatAreNotFinite) {
  TetMesh mesh = Box();
  mesh.nodes(1, 13) = NAN;
  mesh.nodes(0, 20) = INFINITY;
  EXPECT_THAT(
      [&] { CheckMesh(mesh, "box.msh"); },
      ThrowsMessage<InputError>(AllOf(HasSubstr("box.msh"), HasSubstr("node 13"),
                                      HasSubstr("(10.000, nan, 10.000) mm"), HasSubstr("1 more"))));
}

TEST(CheckMesh, RefusesANodeThatNoElementUses) {
  TetMesh mesh = Box();
  mesh.nodes.conservativeResize(3, mesh.num_nodes() + 1);
  mesh.nodes.rightCols<1>() << 0.005, 0, 0.1;
  EXPECT_THAT([&] { CheckMesh(mesh, "box.msh"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("node 27"), HasSubstr("no tetrahedron"),
                                              HasSubstr("(5.000, 0.000, 100.000) mm"))));
}

TEST(CheckMesh, RefusesAnElementThatNamesANodeTwice) {
  TetMesh mesh = Box();
  mesh.elements(3, 6) = mesh.elements(1, 6);
  EXPECT_THAT([&] { CheckMesh(mesh, "box.msh"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("element 6 "), HasSubstr("twice"))));
}

TEST(CheckMesh, RefusesAnInvertedElement) {
  TetMesh mesh = Box();
  std::swap(mesh.elements(1, 4), mesh.elements(2, 4));
  EXPECT_THAT([&] { CheckMesh(mesh, "box.msh"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("element 4 "), HasSubstr("inverted"),
                                              HasSubstr("-167 mm^3"))));  // 1/6 of (10 mm)³
}

TEST(CheckMesh, RefusesAFlatElement) {
  TetMesh mesh = testing::MakeBox(1, 1, 1, {0.01, 0.01, 0.01});
  mesh.nodes.row(2).setZero();
  EXPECT_THAT([&] { CheckMesh(mesh, "box.msh"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("element 0 "), HasSubstr("5 more"))));
}

TEST(CheckMesh, RefusesATenNodeElementWhoseCurvedEdgeFoldsIt) {
  TetMesh mesh = RaiseOrder(testing::MakeBox(1, 1, 1, {0.01, 0.01, 0.01}));
  mesh.nodes.col(mesh.elements(4, 0)) = mesh.nodes.col(mesh.elements(1, 0));
  mesh.nodes(0, mesh.elements(4, 0)) += 0.002;  // beyond the end of its edge
  EXPECT_THAT([&] { CheckMesh(mesh, "box.msh"); },
              ThrowsMessage<InputError>(HasSubstr("inverted")));
}

}  // namespace
}  // namespace softforce::mesh
