#include "softforce/validation/study.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "softforce/base/input_error.h"
#include "softforce/mesh/generate_mesh.h"
#include "support/figures.h"

namespace softforce::validation {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::filesystem::path kMeshes = std::filesystem::path(SOFTFORCE_SOURCE_DIR) / "meshes";

StudyOptions Quiet() {
  StudyOptions options;
  options.meshes = kMeshes;
  options.show_progress = false;
  options.frames = 16;
  return options;
}

mesh::TetMesh Sheet(double size) {
  mesh::GenerateOptions options;
  options.size = size;
  return mesh::RaiseOrder(mesh::GenerateMesh(kMeshes / "sheet.geo", 1e-3, options).mesh);
}

std::vector<Layout> Named(std::vector<Layout> layouts, const std::vector<std::string>& names) {
  const auto others = [&](const Layout& layout) {
    return std::find(names.begin(), names.end(), layout.name) == names.end();
  };
  layouts.erase(std::remove_if(layouts.begin(), layouts.end(), others), layouts.end());
  return layouts;
}

TEST(RunExact, ErrsByLessThanAHundredthOfAMillinewtonEvenWhereForcesAreHardToTellApart) {
  const auto layouts = Named(SheetLayouts(), {"s1", "s4", "s8"});

  for (const ExactCase& found : RunExact(BodyKind::kSheet, Sheet(12e-3), layouts, Quiet())) {
    testing::Record(found.layout.name + " I_e, mN", 1e3 * found.converged);
    EXPECT_LT(found.converged, 1e-5) << found.layout.name;  // N; the promise of Table I
  }
}

TEST(RunExact, FindsForcesOnTheRobotUnderItsCables) {
  const auto layouts = Named(RobotLayouts(), {"r2"});
  mesh::GenerateOptions coarse;
  coarse.size = 9e-3;
  const mesh::TetMesh mesh =
      mesh::RaiseOrder(mesh::GenerateMesh(kMeshes / "robot.geo", 1e-3, coarse).mesh);

  for (const ExactCase& found : RunExact(BodyKind::kRobot, mesh, layouts, Quiet())) {
    EXPECT_LT(found.converged, 1e-5);  // N
  }
}

TEST(RunExact, MakesTheLinearMethodBetterByShorterSteps) {
  const auto layouts = Named(SheetLayouts(), {"s2"});
  const mesh::TetMesh mesh = Sheet(14e-3);
  StudyOptions few = Quiet(), many = Quiet();
  few.frames = 4;
  many.frames = 16;

  const double coarse = RunExact(BodyKind::kSheet, mesh, layouts, few).front().linear;
  const double fine = RunExact(BodyKind::kSheet, mesh, layouts, many).front().linear;

  EXPECT_GT(coarse, 1e-5);        // N: one step per frame leaves an error
  EXPECT_LT(fine, 0.5 * coarse);  // first order would give a quarter
}

TEST(RunInexact, RemediesTakeAwayWrongModuliAndWrongPlacesOfMarkers) {
  const Discretisations meshes{
      Sheet(14e-3),
      mesh::RaiseOrder(RefineAtEdges(BodyKind::kSheet, mesh::LowerOrder(Sheet(9e-3)))),
      mesh::RaiseOrder(RefineAtEdges(BodyKind::kSheet, mesh::LowerOrder(Sheet(8e-3))))};
  const auto layouts = Named(SheetLayouts(), {"s2"});

  const InexactCase found = RunInexact(BodyKind::kSheet, meshes, layouts, Quiet()).front();

  testing::Record("A, plain, mN", 1e3 * found.modulus[2]);
  testing::Record("A, remedied, mN", 1e3 * found.modulus_remedied.all);
  testing::Record("A, remedied, selected, mN", 1e3 * found.modulus_remedied.selected);
  testing::Record("B, plain, mN", 1e3 * found.markers[2]);
  testing::Record("B, remedied, mN", 1e3 * found.markers_remedied[2].all);
  EXPECT_NEAR(found.youngs_modulus, 300e3, 3e3);  // Pa; 1 %, what the discretisations differ by
  EXPECT_LT(found.modulus_remedied.all, 0.2 * found.modulus[2]);
  EXPECT_LT(found.markers_remedied[2].all, 0.2 * found.markers[2]);  // the promise of Table II
}

TEST(RunInexact, GivesUpCandidatesThatCarryNoForceAndKeepsThoseThatDo) {
  const mesh::TetMesh truth = Sheet(9e-3), coarse = Sheet(12e-3);
  const auto layouts = Named(SheetLayouts(), {"s4"});

  const InexactCase found =
      RunInexact(BodyKind::kSheet, {coarse, coarse, truth}, layouts, Quiet()).front();

  testing::Record("all, mN", 1e3 * found.remedied_alone.all);
  testing::Record("selected, mN", 1e3 * found.remedied_alone.selected);
  // A loaded candidate given up would cost 400 mN, an idle one kept most of what it costs now.
  EXPECT_LT(found.remedied_alone.selected, 0.3 * found.remedied_alone.all);
  EXPECT_LT(found.remedied_alone.selected, 0.1);  // N
}

TEST(RefineAtEdges, CutsOnlySomeCells) {
  const mesh::TetMesh mesh = mesh::LowerOrder(Sheet(14e-3));
  const mesh::TetMesh finer = RefineAtEdges(BodyKind::kSheet, mesh);
  EXPECT_GT(finer.num_elements(), mesh.num_elements());
  EXPECT_LT(finer.num_elements(), 8 * mesh.num_elements());
}

TEST(RunStudy, RefusesAFolderWithoutTheMeshes) {
  StudyOptions options = Quiet();
  options.meshes = kMeshes / "nowhere";
  EXPECT_THAT([&] { RunStudy(options); },
              ThrowsMessage<base::InputError>(HasSubstr("sheet.msh does not exist")));
}

TEST(StudyOptions, RefuseWhatCannotBeComputed) {
  StudyOptions options = Quiet();
  options.layouts = {"s9"};
  EXPECT_THAT([&] { options.Check(); }, ThrowsMessage<base::InputError>(HasSubstr("\"s9\"")));
  options = Quiet();
  options.frames = 0;
  EXPECT_THAT([&] { options.Check(); }, ThrowsMessage<base::InputError>(HasSubstr("--frames")));
  options = Quiet();
  options.threads = 0;
  EXPECT_THAT([&] { options.Check(); }, ThrowsMessage<base::InputError>(HasSubstr("--threads")));
}

}  // namespace
}  // namespace softforce::validation
