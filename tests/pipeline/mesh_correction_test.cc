#include "pipeline/mesh_correction.h"

#include <gtest/gtest.h>

#include "pipeline/mesh_answer.h"
#include "softforce/base/input_error.h"
#include "softforce/mesh/refine.h"

namespace softforce::pipeline {
namespace {

// The shipped recording's sheet.
scene::Scene Sheet() {
  return scene::LoadScene(std::string(SOFTFORCE_SOURCE_DIR) +
                          "/datasets/sheet_two_weights/scene.yaml");
}

TEST(CorrectMesh, MovesTheMarkersLikeTheOnceRefinedMesh) {
  const scene::Scene scene = Sheet();
  const World given = BuildWorld(scene);
  const Eigen::MatrixXd refined =
      AnswerOf(BuildWorld(scene, mesh::Refine(given.mesh()).mesh)).markers;

  const auto correction = CorrectMesh(scene, MeshAim::kRefined, false);
  ASSERT_TRUE(correction.has_value());
  const Eigen::MatrixXd corrected = AnswerOf(BuildWorld(scene, correction)).markers;

  ASSERT_GT(BiasOf(AnswerOf(given).markers, refined), 0.03);
  EXPECT_NEAR(BiasOf(corrected, refined), 0, 1e-6);  // solver's rounding
  EXPECT_LT(correction->modulus_factor, 1);
  EXPECT_GT(correction->modulus_factor, 0.98);  // most of it is the mesh's doing
  EXPECT_LT(correction->mesh.num_elements(), 4 * correction->given_cells);
  EXPECT_GE(correction->model_error_factor, 0.1);
  EXPECT_LE(correction->model_error_factor, 1);
}

TEST(CorrectMesh, LeavesTheGivenMeshAloneUnlessAsked) {
  EXPECT_FALSE(CorrectMesh(Sheet(), MeshAim::kGiven, false).has_value());
}

TEST(CorrectMesh, RefusesTheLimitOfCellsThatLock) {
  scene::Scene scene = Sheet();
  scene.mesh.order = 1;
  EXPECT_THROW(CorrectMesh(scene, MeshAim::kConverged, false), base::InputError);
}

}  // namespace
}  // namespace softforce::pipeline
