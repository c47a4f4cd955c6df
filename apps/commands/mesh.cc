#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands/commands.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/base/quantity.h"
#include "softforce/mesh/prepare_mesh.h"
#include "softforce/mesh/surface_groups.h"
#include "softforce/mesh/write_mesh.h"
#include "softforce/pipeline/mesh_convergence.h"
#include "softforce/pipeline/world.h"
#include "softforce/scene/scene.h"

namespace softforce::apps {
namespace {

using base::Dimension;

struct MeshArguments {
  std::string in, out;
  std::string unit = "mm", out_unit, size, feature_angle = "40 deg";
  std::string scene, load, bias_field;
  mesh::PrepareOptions options;
};

// What an output file must not replace: the inputs, and the other output.
void RefuseToReplace(const std::string& option, const std::filesystem::path& file,
                     const std::vector<std::filesystem::path>& others) {
  std::error_code ignored;  // a path that cannot be resolved is compared as it is
  for (const std::filesystem::path& other : others) {
    if (other.empty() || std::filesystem::weakly_canonical(file, ignored) !=
                             std::filesystem::weakly_canonical(other, ignored)) {
      continue;
    }
    throw base::InputError(option, fmt::format("{} is a file of this job already", file.string()),
                           "Choose another name.");
  }
}

std::vector<std::filesystem::path> FilesOf(const scene::Scene& scene) {
  std::vector<std::filesystem::path> files{scene.file, scene.mesh.file, scene.cameras.rig};
  if (scene.actuation_file) files.push_back(*scene.actuation_file);
  for (const auto& [camera, source] : scene.cameras.sources) files.emplace_back(source);
  if (scene.measured) files.insert(files.end(), {scene.measured->file, scene.measured->rig});
  return files;
}

// A scene to judge a mesh in.
struct Assessment {
  scene::Scene scene;
  pipeline::MeshConvergenceOptions options;
};

void CheckBiasField(const MeshArguments& arguments, const scene::Scene& scene) {
  const std::filesystem::path file = arguments.bias_field;
  if (file.empty()) return;
  if (file.extension() != ".vtu") {
    throw base::InputError("--bias-field",
                           fmt::format("got \"{}\", must end in .vtu", file.string()),
                           "It is a file for ParaView.");
  }
  std::vector<std::filesystem::path> others = FilesOf(scene);
  others.insert(others.end(), {arguments.in, arguments.out});
  RefuseToReplace("--bias-field", file, others);
  base::CheckCanWrite(file);
}

// Throws InputError for what cannot be done, before anything is.
std::optional<Assessment> AssessmentOf(const MeshArguments& arguments) {
  if (arguments.scene.empty()) {
    if (arguments.load.empty() && arguments.bias_field.empty()) return std::nullopt;
    throw base::InputError("mesh", "--load and --bias-field need --scene",
                           "Convergence is judged at a scene's markers and forces.");
  }
  Assessment assessment{scene::LoadScene(arguments.scene, scene::SceneFiles::kNone), {}};
  if (!arguments.load.empty()) {
    const double load = base::ParseQuantity(arguments.load, Dimension::kForce, 1, "--load")[0];
    if (!(load > 0)) {
      throw base::InputError("--load", fmt::format("got {}, must be > 0 N", arguments.load),
                             "It acts along the candidates' own directions.");
    }
    assessment.options.working_load = load;
  }
  CheckBiasField(arguments, assessment.scene);
  return assessment;
}

struct Assessed {
  pipeline::World world;
  pipeline::MeshConvergence found;
};

Assessed Assess(const Assessment& assessment, const mesh::TetMesh& mesh) {
  const scene::Scene& scene = assessment.scene;
  pipeline::World world = pipeline::BuildWorld(scene, mesh::WithOrder(mesh, scene.mesh.order));
  pipeline::MeshConvergence found = pipeline::AssessMesh(scene, world, assessment.options);
  return {std::move(world), std::move(found)};
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
  const std::optional<Assessment> assessment = AssessmentOf(*arguments);
  const mesh::PreparedMesh prepared = mesh::PrepareMesh(arguments->in, arguments->out, options);
  fmt::print("{}", prepared.report.FullReport());
  std::fflush(stdout);  // what follows may take a minute

  std::optional<Assessed> assessed;
  if (assessment) {
    assessed = Assess(*assessment, prepared.mesh);
    fmt::print("\nIn {}:\n{}", arguments->scene, assessed->found.FullReport());
  }
  if (!arguments->out.empty()) {
    mesh::WriteMesh(arguments->out, prepared.mesh, prepared.out_metres_per_unit);
    fmt::print("\nWritten: {}\n", arguments->out);
  }
  if (!arguments->bias_field.empty()) {
    pipeline::WriteCellShares(arguments->bias_field, assessed->world, assessed->found);
    fmt::print("\nWritten: {}\n", arguments->bias_field);
  }
  // The load that was asked about has no answer.
  return !arguments->load.empty() && !assessed->found.working.ok ? 1 : 0;
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
      "Scene file: also tell by how much forces found with this mesh would be too large, and "
      "where to refine it; the scene's videos need not be there yet");
  app->add_option(
      "--load", arguments->load,
      "With --scene: load on every candidate at which large displacements are compared, "
      "as \"0.5 N\"; default: what moves a candidate by 5 % of the body's size");
  app->add_option("--bias-field", arguments->bias_field,
                  "With --scene: .vtu file to write, with every cell's share of that error");
  app->footer(mesh::kSelectorHelp);
  return {app, [arguments] { return Mesh(arguments.get()); }};
}

}  // namespace softforce::apps
