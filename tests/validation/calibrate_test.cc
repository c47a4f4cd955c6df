#include "softforce/validation/calibrate.h"

#include <gtest/gtest.h>

#include "softforce/mesh/generate_mesh.h"
#include "softforce/validation/direct_model.h"

namespace softforce::validation {
namespace {

// The robot on a coarse mesh, its direct model, and markers on it. The truth is made by the same
// discretisation: these tests check the calibration, not the model.
struct RobotExperiment {
  Model model;
  DirectModel direct;
  Layout layout = RobotLayouts()[1];
  std::vector<mesh::NodalWeights> markers;

  RobotExperiment() {
    mesh::GenerateOptions coarse;
    coarse.size = 9e-3;
    const auto script = std::filesystem::path(SOFTFORCE_SOURCE_DIR) / "meshes" / "robot.geo";
    const mesh::TetMesh mesh = mesh::RaiseOrder(mesh::GenerateMesh(script, 1e-3, coarse).mesh);
    model = MakeModel(BodyKind::kRobot, mesh, kYoungsModulus);
    direct = SolveDirectModel(BodyKind::kRobot, model, 1, 1e-10);
    for (const Eigen::Vector3d& place : layout.markers) markers.push_back(PointAt(model, place));
  }

  CalibrationFrame Frame(const std::vector<AppliedForce>& forces, const fem::Equilibrium& state,
                         double excess) const {
    return {LoadOf(model, forces, Tensioned(model.body, excess)),
            Seen(model, state, layout.markers)};
  }
};

TEST(Calibrate, FindsYoungsModulusWhereverItStarts) {
  const RobotExperiment robot;
  const std::vector<CalibrationFrame> frames{
      robot.Frame({KnownWeight(BodyKind::kRobot)}, robot.direct.weighed, 0),
      robot.Frame({}, robot.direct.unloaded, 0)};
  for (const double believed : {240e3, 280e3, 340e3}) {
    fem::StaticSolver solver(MakeModel(BodyKind::kRobot, robot.model.body.mesh, believed).body,
                             "robot");

    const Calibration found =
        Calibrate(&solver, robot.markers, frames, Uncertain::kYoungsModulus, solver.AtRest());

    ASSERT_TRUE(found.ok);
    EXPECT_NEAR(found.youngs_modulus, 300e3, 3);  // Pa; 1e-5, what the equilibria are solved to
    EXPECT_EQ(solver.body().materials.front().youngs_modulus, found.youngs_modulus);
  }
}

TEST(Calibrate, FindsTheCablesTensions) {
  const RobotExperiment robot;
  fem::StaticSolver solver(robot.model.body, "robot");

  const Calibration found =
      Calibrate(&solver, robot.markers, {robot.Frame({}, robot.direct.unloaded, 0.2)},
                Uncertain::kTensions, robot.direct.unloaded);

  ASSERT_TRUE(found.ok);
  EXPECT_NEAR(found.tension_change(0), -0.2, 2e-5);  // N; 1e-5 of the tension, as above
  EXPECT_NEAR(found.tension_change(1), -0.2, 2e-5);
}

}  // namespace
}  // namespace softforce::validation
