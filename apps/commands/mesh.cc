#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include "commands/commands.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"
#include "softforce/mesh/prepare_mesh.h"
#include "softforce/mesh/surface_groups.h"
#include "softforce/pipeline/mesh_convergence.h"
#include "softforce/pipeline/world.h"
#include "softforce/scene/scene.h"

namespace softforce::apps {
namespace {

using base::Dimension;

struct MeshArguments {
  std::string in, out;
  std::string unit = "mm", out_unit, size, feature_angle = "40 deg";
  std::string scene, scene_load, bias_field;
  mesh::PrepareOptions options;
};

std::optional<scene::Scene> SceneToAssessWith(const MeshArguments& arguments) {
  if (!arguments.scene.empty()) return scene::LoadScene(arguments.scene);
  if (!arguments.scene_load.empty() || !arguments.bias_field.empty()) {
    throw base::InputError("mesh", "--load and --bias-field need --scene",
                           "Convergence is judged at a scene's markers and forces.");
  }
  return std::nullopt;
}

// Prints how far the mesh is from converged in a scene.
void Assess(const MeshArguments& arguments, const scene::Scene& scene, const mesh::TetMesh& mesh) {
  pipeline::MeshConvergenceOptions options;
  if (!arguments.scene_load.empty()) {
    options.working_load =
        base::ParseQuantity(arguments.scene_load, Dimension::kForce, 1, "--load")[0];
  }
  const pipeline::World world = pipeline::BuildWorld(
      scene, scene.mesh.order == 2 ? mesh::RaiseOrder(mesh) : mesh::LowerOrder(mesh));
  const pipeline::MeshConvergence found = pipeline::AssessMesh(scene, world, options);
  fmt::print("\nIn {}:\n{}", arguments.scene, found.FullReport());
  if (arguments.bias_field.empty()) return;
  pipeline::WriteCellShares(arguments.bias_field, world, found);
  fmt::print("\nWritten: {}\n", arguments.bias_field);
}

int Mesh(MeshArguments* arguments) {
  mesh::PrepareOptions& options = arguments->options;
  options.metres_per_unit = base::UnitInSi(arguments->unit, Dimension::kLength, "--unit");
  if (!arguments->out_unit.empty()) {
    options.out_metres_per_unit =
        base::UnitInSi(arguments->out_unit, Dimension::kLength, "--out-unit");
  }
  if (!arguments->size.empty()) {
    options.generate.size =
        base::ParseQuantity(arguments->size, Dimension::kLength, 1, "--size")[0];
  }
  options.generate.feature_angle =
      base::ParseQuantity(arguments->feature_angle, Dimension::kAngle, 1, "--feature-angle")[0];
  const auto scene = SceneToAssessWith(*arguments);  // refused before the mesh is made
  const mesh::PreparedMesh prepared = mesh::PrepareMesh(arguments->in, arguments->out, options);
  fmt::print("{}", prepared.report.FullReport());
  if (!arguments->out.empty()) fmt::print("\nWritten: {}\n", arguments->out);
  if (scene) Assess(*arguments, *scene, prepared.mesh);
  return 0;
}

}  // namespace

Command AddMesh(CLI::App* program) {
  auto arguments = std::make_shared<MeshArguments>();
  mesh::PrepareOptions& options = arguments->options;
  CLI::App* app =
      program->add_subcommand("mesh", "Convert, generate, name parts of and check a mesh");
  app->add_option("in", arguments->in,
                  "Mesh (.msh, .vtu, .vtk), or geometry to fill with tetrahedra (.stl, .step, "
                  ".stp, .brep, .geo)")
      ->required();
  app->add_option("out", arguments->out,
                  "Mesh to write (.msh, .vtu, .vtk); if left out, only the table is printed");
  app->add_option("--unit", arguments->unit,
                  "Unit of IN's coordinates; a STEP file carries its own")
      ->capture_default_str();
  app->add_option("--out-unit", arguments->out_unit,
                  "Unit of OUT's coordinates; default: that of IN, mm for STEP");
  app->add_option(
      "--size", arguments->size,
      "Wanted edge length of the tetrahedra, as \"5 mm\"; may be left out for .geo (its "
      "own sizes) and .stl (its own triangles)");
  app->add_option("--feature-angle", arguments->feature_angle,
                  "For .stl with --size: facets that meet more sharply keep their edge")
      ->capture_default_str();
  app->add_option("--per-circle", options.generate.per_circle,
                  "For CAD and .geo: at least so many edges around a full circle, where --size is "
                  "too coarse for round holes; 0: --size alone")
      ->capture_default_str();
  app->add_option("--optimise", options.generate.optimise,
                  "Passes that improve the shapes of generated tetrahedra, 0 to 2")
      ->capture_default_str();
  app->add_option("--order", options.order,
                  "1 or 2: write tetrahedra of 4 or 10 nodes; default: as they are in IN");
  app->add_option("--group", options.groups,
                  "NAME=SELECTOR: name a part of the surface; may be repeated, see below")
      ->allow_extra_args(false);
  app->add_option(
      "--scene", arguments->scene,
      "Scene file: also tell how far its markers and forces are from where a finer mesh "
      "would have them, in per cent, and where to refine");
  app->add_option(
      "--load", arguments->scene_load,
      "With --scene: load on every candidate at which large displacements are compared, "
      "as \"0.5 N\"; default: what moves a candidate by 5 % of the body's size");
  app->add_option("--bias-field", arguments->bias_field,
                  "With --scene: .vtu file to write with every cell's share of that error");
  app->footer(mesh::kSelectorHelp);
  return {app, [arguments] { return Mesh(arguments.get()); }};
}

}  // namespace softforce::apps
