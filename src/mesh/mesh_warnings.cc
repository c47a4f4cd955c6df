#include "mesh/mesh_warnings.h"

#include <fmt/format.h>

#include "mesh/millimetres.h"

namespace softforce::mesh {
namespace {

void WarnOfConnection(const MeshReport& report, std::vector<std::string>& warnings) {
  if (report.coincident_nodes > 0) {
    warnings.push_back(fmt::format(
        "{} nodes stand where another one does, the first at {}: parts that touch there are not "
        "joined. Unite the parts before meshing (in Gmsh: BooleanFragments, or Coherence Mesh on "
        "the finished mesh).",
        report.coincident_nodes, InMillimetres(report.coincident_at, 2)));
  }
  if (report.overlapping_cells > 0) {
    warnings.push_back(fmt::format(
        "parts of the body fill the same space: {} cells lie within those of another part, the "
        "first at {}. Their stiffness and volume count twice. Unite the parts before meshing (in "
        "Gmsh: BooleanUnion or BooleanFragments).",
        report.overlapping_cells, InMillimetres(report.overlapping_at, 2)));
  }
  if (report.parts > 1) {
    warnings.push_back(fmt::format(
        "the body is in {} parts that share no node: each must be held by itself. If they are "
        "meant to be one, unite them before meshing.",
        report.parts));
  }
  if (report.parts_by_faces > report.parts) {
    warnings.push_back(
        "parts of the body hang together by a node or an edge only, which acts as a hinge. Let "
        "them overlap before meshing.");
  }
  for (const SurfaceGroupReport& group : report.groups) {
    if (group.off_surface == 0) continue;
    warnings.push_back(fmt::format(
        "surface group \"{}\": {} of its {} triangles are not on the surface of the body, so "
        "nothing can be fixed or pressed there. Choose faces of the outside.",
        group.name, group.off_surface, group.triangles));
  }
}

void WarnOfShapes(const MeshReport& report, std::vector<std::string>& warnings) {
  if (report.poor_elements > 0) {
    warnings.push_back(fmt::format(
        "{} a quality below {}, the worst {:.3g} at {}: results near it are poor. Generate with a "
        "slightly different --size or with --optimise 2; remove tiny edges and slivers from the "
        "geometry there.",
        report.poor_elements == 1 ? "1 cell has"
                                  : fmt::format("{} cells have", report.poor_elements),
        kPoorQuality, report.least_quality.value, InMillimetres(report.least_quality.at, 2)));
  }
  if (report.least_jacobian_ratio.value < 0.2) {
    warnings.push_back(fmt::format(
        "a curved cell at {} is distorted: its Jacobian varies by a factor of {:.1f}. Take "
        "straight edges (--order 1; softforce adds middle nodes itself), or smaller cells there.",
        InMillimetres(report.least_jacobian_ratio.at, 2), 1 / report.least_jacobian_ratio.value));
  }
  if (report.one_cell_thick > 0.25) {
    warnings.push_back(fmt::format(
        "{:.0f} % of the surface has one cell only to the opposite wall: 4-node cells are far too "
        "stiff in bending there, 10-node cells follow it roughly. Generate with a --size of half "
        "the wall or less; the thinnest wall is {:.2f} mm at {}.",
        100 * report.one_cell_thick, 1e3 * report.thinnest.value,
        InMillimetres(report.thinnest.at, 2)));
  }
}

void WarnOfSize(const MeshReport& report, std::vector<std::string>& warnings) {
  const double diagonal = (report.high - report.low).norm();
  if (diagonal < 1e-3 || diagonal > 10) {
    warnings.push_back(fmt::format(
        "the body is {:.3g} mm across: is the unit right? It is given by --unit (default mm).",
        1e3 * diagonal));
  }
  const double error = report.volume / report.solid_volume - 1;
  if (std::abs(error) > 0.02) {
    warnings.push_back(fmt::format(
        "the mesh holds {:.1f} % of the volume of the geometry: flat faces cut its curves. Take a "
        "smaller --size, or --per-circle 16.",
        100 * (1 + error)));
  }
}

}  // namespace

std::vector<std::string> WarningsOf(const MeshReport& report) {
  std::vector<std::string> warnings;
  WarnOfSize(report, warnings);
  WarnOfConnection(report, warnings);
  WarnOfShapes(report, warnings);
  return warnings;
}

}  // namespace softforce::mesh
