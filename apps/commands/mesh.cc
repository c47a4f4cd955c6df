#include <fmt/format.h>

#include <memory>
#include <string>

#include "commands/commands.h"
#include "softforce/base/quantity.h"
#include "softforce/mesh/prepare_mesh.h"
#include "softforce/mesh/surface_groups.h"

namespace softforce::apps {
namespace {

using base::Dimension;

struct MeshArguments {
  std::string in, out;
  std::string unit = "mm", out_unit, size, feature_angle = "40 deg";
  mesh::PrepareOptions options;
};

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
  const mesh::MeshReport report = mesh::PrepareMesh(arguments->in, arguments->out, options);
  fmt::print("{}", report.FullReport());
  if (!arguments->out.empty()) fmt::print("\nWritten: {}\n", arguments->out);
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
  app->footer(mesh::kSelectorHelp);
  return {app, [arguments] { return Mesh(arguments.get()); }};
}

}  // namespace softforce::apps
