#include "softforce/pipeline/mesh_convergence.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numeric>

#include "pipeline/mesh_answer.h"
#include "softforce/base/input_error.h"
#include "softforce/mesh/refine.h"
#include "support/box_mesh.h"

namespace softforce::pipeline {
namespace {

const Eigen::Vector3d kBar(0.1, 0.01, 0.01);  // m

// A bar clamped at x = 0 with two markers on top and a force down at the far end.
scene::Scene BarScene() {
  scene::Scene scene;
  scene.file = "bar.yaml";
  scene.materials[""] = {fem::MaterialModel::kNeoHookean, 200e3, 0.45};
  scene::FixedRegion clamp;
  clamp.box_min = {-1, -1, -1};
  clamp.box_max = {0, 1, 1};
  scene.fixed = {clamp};
  scene.markers.points = {{7, {0.06, 0.005, 0.01}}, {8, {0.1, 0.005, 0.01}}};
  scene.forces.patch = 4e-3;
  scene::Candidate tip;
  tip.id = 3;
  tip.position = {0.1, 0.005, 0.01};
  tip.direction = scene::ForceDirection::kFixed;
  tip.fixed_direction = {0, 0, -1};
  scene.forces.candidates = {tip};
  return scene;
}

mesh::TetMesh Bar(int order, int along, int across) {
  const mesh::TetMesh box = testing::MakeBox(along, across, across, kBar);
  return order == 2 ? mesh::RaiseOrder(box) : box;
}

MeshConvergence Assess(const scene::Scene& scene, const mesh::TetMesh& mesh,
                       MeshConvergenceOptions options = {}) {
  options.show_progress = false;
  return AssessMesh(scene, BuildWorld(scene, mesh), options);
}

MeshConvergenceOptions SmallLoadsOnly() {
  MeshConvergenceOptions options;
  options.working_deflection = -1;
  return options;
}

// The truth is another, structured mesh with 64 times as many cells, which shares no node inside
// with the refined ones.
TEST(AssessMesh, FindsTheLimitOfACoarseBar) {
  const scene::Scene scene = BarScene();
  const MeshAnswer given = AnswerOf(BuildWorld(scene, Bar(2, 6, 1)));
  const MeshAnswer fine = AnswerOf(BuildWorld(scene, Bar(2, 60, 6)));
  const double truth = BiasOf(given.markers, fine.markers);
  ASSERT_GT(truth, 0.03);  // worth finding

  const MeshConvergence found = Assess(scene, Bar(2, 6, 1), SmallLoadsOnly());

  EXPECT_GT(found.overall.refined, 0);
  EXPECT_LT(found.overall.refined, truth);
  EXPECT_NEAR(found.overall.converged, truth, 5e-3);  // the half per cent that is promised
  EXPECT_GT(found.overall.uncertain, 0);
  EXPECT_NE(found.FullReport().find(" ± "), std::string::npos);
}

TEST(AssessMesh, SaysThatFourNodeCellsLock) {
  const MeshConvergence found = Assess(BarScene(), Bar(1, 20, 2), SmallLoadsOnly());
  EXPECT_GT(found.overall.refined, 0.5);
  EXPECT_TRUE(std::isnan(found.overall.converged));
  EXPECT_TRUE(std::isnan(found.candidates[0].own.converged));
  EXPECT_EQ(found.FullReport().find("±"), std::string::npos) << found.FullReport();
  EXPECT_NE(found.FullReport().find("order: 2"), std::string::npos);
}

TEST(AssessMesh, FindsLittleWhereTheMeshIsFine) {
  const MeshConvergence found = Assess(BarScene(), Bar(2, 30, 3), SmallLoadsOnly());
  // A marker's displacement, unlike a force's own, may come nearer from either side.
  EXPECT_LT(std::abs(found.overall.refined), 0.005);
  EXPECT_LT(std::abs(found.overall.converged), 0.01);
}

TEST(AssessMesh, PointsToTheClamp) {
  MeshConvergenceOptions options = SmallLoadsOnly();
  options.max_levels = 1;
  const MeshConvergence found = Assess(BarScene(), Bar(2, 20, 2), options);

  ASSERT_FALSE(found.places.empty());
  EXPECT_LT(found.places[0].centre.x(), 0.01);  // m; a bar's thickness from the clamp
  EXPECT_GT(found.places[0].share, 0.5);
  EXPECT_LT(found.places[0].wanted_size, 0.5 * found.places[0].size);
  EXPECT_NEAR(found.cell_share.sum(), 1, 1e-12);
}

TEST(AssessMesh, ComparesAtALargeLoadToo) {
  MeshConvergenceOptions options;
  options.max_levels = 2;
  const MeshConvergence found = Assess(BarScene(), Bar(2, 8, 1), options);

  ASSERT_TRUE(found.working.ok);
  EXPECT_NEAR(found.working.deflection, 0.05 * kBar.x(), 0.03 * 0.05 * kBar.x());
  // A bar that bends by a twentieth of its length is still nearly linear.
  EXPECT_NEAR(found.working.displacement.refined, found.overall.refined,
              0.1 * found.overall.refined);
  EXPECT_NEAR(found.working.force.refined, found.overall.refined, 0.1 * found.overall.refined);
}

TEST(AssessMesh, ReportsEachCandidateAndMarker) {
  MeshConvergenceOptions options = SmallLoadsOnly();
  options.max_levels = 1;
  const MeshConvergence found = Assess(BarScene(), Bar(2, 6, 1), options);

  ASSERT_EQ(found.candidates.size(), 1u);
  EXPECT_EQ(found.candidates[0].id, 3);
  EXPECT_GT(found.candidates[0].own.refined, 0);
  ASSERT_EQ(found.markers.size(), 2u);
  EXPECT_EQ(found.markers[1].id, 8);
  EXPECT_EQ(found.refined_cells, 8 * found.cells);
  const std::string report = found.FullReport();
  EXPECT_NE(report.find("candidate 3"), std::string::npos);
  EXPECT_NE(report.find("Where to refine"), std::string::npos);
}

TEST(AssessMesh, GivesAPointForceNoLimitOfItsOwn) {
  scene::Scene scene = BarScene();
  scene.forces.patch = 0;
  MeshConvergenceOptions options = SmallLoadsOnly();
  options.max_levels = 2;

  const MeshConvergence found = Assess(scene, Bar(2, 6, 1), options);

  EXPECT_TRUE(std::isnan(found.candidates[0].own.converged));
  EXPECT_TRUE(std::isfinite(found.overall.converged));
  EXPECT_NE(found.FullReport().find("Without a patch"), std::string::npos);
}

TEST(AssessMesh, SaysWhyThereIsNoComparisonAtTooLargeALoad) {
  scene::Scene scene = BarScene();
  scene.materials[""].model = fem::MaterialModel::kStVenantKirchhoff;  // fails when it is crushed
  scene.forces.candidates[0].fixed_direction = {-1, 0, 0};             // against the clamp
  scene.forces.candidates[0].position = {0.1, 0.005, 0.005};
  MeshConvergenceOptions options;
  options.max_levels = 1;
  options.working_load = 1000;  // N, on 1 cm² of 200 kPa

  const MeshConvergence found = Assess(scene, Bar(2, 6, 1), options);

  EXPECT_FALSE(found.working.ok);
  EXPECT_NE(found.FullReport().find("no equilibrium was found with 1e+03 N"), std::string::npos)
      << found.FullReport();
}

TEST(AssessMesh, RefusesWhatCannotMove) {
  scene::Scene scene = BarScene();
  scene.fixed[0].box_max.x() = 0.07;  // m; the first marker is held, the second is not
  EXPECT_NO_THROW(Assess(scene, Bar(2, 10, 1), SmallLoadsOnly()));
  scene.markers.points.pop_back();
  EXPECT_THROW(Assess(scene, Bar(2, 10, 1), SmallLoadsOnly()), base::InputError);

  scene::Scene held = BarScene();
  held.forces.candidates.push_back(held.forces.candidates[0]);
  held.forces.candidates[1].id = 4;
  held.forces.candidates[1].position = {0, 0.005, 0.005};  // on the clamp
  try {
    Assess(held, Bar(2, 10, 1), SmallLoadsOnly());
    ADD_FAILURE() << "was accepted";
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("bar.yaml: forces: candidates: id 4"),
              std::string::npos)
        << error.what();
  }
}

TEST(WriteCellShares, ColoursTheCellsInAFile) {
  MeshConvergenceOptions options = SmallLoadsOnly();
  options.max_levels = 1;
  options.show_progress = false;
  const World given = BuildWorld(BarScene(), Bar(2, 6, 1));
  const MeshConvergence found = AssessMesh(BarScene(), given, options);
  const auto path = std::filesystem::path(::testing::TempDir()) / "bias_share.vtu";

  WriteCellShares(path, given, found);

  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("bias_share"), std::string::npos);
  EXPECT_NE(text.find(fmt::format("NumberOfCells=\"{}\"", found.cells)), std::string::npos);
}

TEST(AssessMesh, RefusesAMeshTooLargeForTheMemory) {
  MeshConvergenceOptions options = SmallLoadsOnly();
  options.max_memory_gb = 1e-4;
  EXPECT_THROW(Assess(BarScene(), Bar(2, 6, 1), options), base::InputError);
}

TEST(AssessMesh, NeedsMarkersAndCandidates) {
  scene::Scene scene = BarScene();
  scene.markers.points.clear();
  EXPECT_THROW(Assess(scene, Bar(2, 6, 1)), base::InputError);
}

TEST(ChangeOfCells, AddsUpToTheChangeOfTheBias) {
  const scene::Scene scene = BarScene();
  const World coarse = BuildWorld(scene, Bar(2, 6, 1));
  const MeshAnswer given = AnswerOf(coarse);
  const mesh::Refinement refinement = mesh::Refine(coarse.mesh());
  const World fine = BuildWorld(scene, refinement.mesh);
  const MeshAnswer refined = AnswerOf(fine, given.markers);

  const std::vector<double> changes =
      ChangeOfCells(coarse.mesh(), given, fine.solver->body(), refined, refinement);

  const double sum = std::accumulate(changes.begin(), changes.end(), 0.0);
  // Exact but for the disc of the force, whose mean is taken over other triangles.
  EXPECT_NEAR(sum, BiasOf(given.markers, refined.markers), 1e-3 * sum);
}

// Every line of Check has its refusal.
class BadConvergenceOption : public ::testing::TestWithParam<MeshConvergenceOptions> {};

TEST_P(BadConvergenceOption, IsRefused) { EXPECT_THROW(GetParam().Check(), base::InputError); }

MeshConvergenceOptions With(double MeshConvergenceOptions::*option, double value) {
  MeshConvergenceOptions options;
  options.*option = value;
  return options;
}

MeshConvergenceOptions WithLevels(int levels) {
  MeshConvergenceOptions options;
  options.max_levels = levels;
  return options;
}

INSTANTIATE_TEST_SUITE_P(All, BadConvergenceOption,
                         ::testing::Values(With(&MeshConvergenceOptions::settled, 0), WithLevels(0),
                                           With(&MeshConvergenceOptions::max_local_growth, 1),
                                           With(&MeshConvergenceOptions::max_memory_gb, NAN),
                                           With(&MeshConvergenceOptions::working_load, -1),
                                           With(&MeshConvergenceOptions::working_deflection, 1)));

}  // namespace
}  // namespace softforce::pipeline
