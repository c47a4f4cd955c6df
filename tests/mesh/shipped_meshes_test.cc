#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "softforce/mesh/read_mesh.h"
#include "softforce/mesh/surface.h"

namespace softforce::mesh {
namespace {

namespace fs = std::filesystem;

struct Expected {
  const char* file;
  int num_nodes, num_elements;
  const char* region;
  Eigen::Vector3d size;  // m
};

// Meshes of our own, and those of the recordings, which stand beside the project's folder.
class ShippedMesh : public ::testing::TestWithParam<Expected> {};

TEST_P(ShippedMesh, IsReadCompletelyAndIsSound) {
  const Expected& expected = GetParam();
  const fs::path path = fs::path(SOFTFORCE_SOURCE_DIR) / expected.file;
  if (!fs::exists(path)) GTEST_SKIP() << "no mesh at " << path;

  const TetMesh mesh = ReadMesh(path, 1e-3);

  EXPECT_EQ(mesh.num_nodes(), expected.num_nodes);
  EXPECT_EQ(mesh.num_elements(), expected.num_elements);
  EXPECT_EQ(mesh.region_names, std::vector<std::string>{expected.region});
  const Eigen::Vector3d size = mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff();
  EXPECT_LT((size - expected.size).norm(), 1e-9);
  EXPECT_NO_THROW(CheckMesh(mesh, path.string()));
  EXPECT_NO_THROW(CheckMesh(RaiseOrder(mesh), path.string()));
}

INSTANTIATE_TEST_SUITE_P(
    Ours, ShippedMesh,
    ::testing::Values(Expected{"meshes/sheet.msh", 1699, 4971, "sheet", {0.2, 0.2, 0.01}},
                      Expected{"meshes/robot.msh", 1436, 4165, "robot", {0.129, 0.129, 0.1}}));

INSTANTIATE_TEST_SUITE_P(
    Recordings, ShippedMesh,
    ::testing::Values(Expected{"../shared/recordings/robot_tip_weight/robot.msh",
                               1490,
                               4338,
                               "robot",
                               {0.1264889158915635, 0.1264889158915635, 0.11}},
                      Expected{"../shared/recordings/sheet_two_weights/sheet.msh",
                               1619,
                               4722,
                               "sheet",
                               {0.2, 0.2, 0.01}}));

TEST(ShippedMeshes, NameTheSurfacesThatTheirReadmeLists) {
  const auto groups = [](const char* file) {
    std::vector<std::string> names;
    const TetMesh mesh = ReadMesh(fs::path(SOFTFORCE_SOURCE_DIR) / "meshes" / file, 1e-3);
    for (const auto& group : mesh.surface_groups) names.push_back(group.first);
    return names;
  };

  EXPECT_EQ(groups("sheet.msh"), (std::vector<std::string>{"bottom", "clamps", "top"}));
  EXPECT_EQ(groups("robot.msh"), (std::vector<std::string>{"feet", "platform_top"}));
}

}  // namespace
}  // namespace softforce::mesh
