#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "softforce/mesh/write_vtu.h"
#include "softforce/pipeline/mesh_convergence.h"

namespace softforce::pipeline {
namespace {

constexpr size_t kPlaces = 12;  // listed at most
// Forces wrong by less than this are not worth a finer mesh: cameras and material are worse.
constexpr double kGoodEnough = 0.01;

std::string Percent(double share) {
  return std::isfinite(share) ? fmt::format("{:+.2f} %", 100 * share) : "-";
}

// "+2.8 ± 0.5 %"
std::string Limit(const MeshBias& bias) {
  if (!std::isfinite(bias.converged)) return "-";
  return fmt::format("{:+.1f} ± {:.1f} %", 100 * bias.converged, 100 * bias.uncertain);
}

// fmt counts "±" as one column.
std::string Row(const std::string& what, const MeshBias& bias) {
  return fmt::format("  {:<48}  {:>12}  {:>14}\n", what, Percent(bias.refined), Limit(bias));
}

std::string TooLarge(double share) {
  return fmt::format("{:.1f} % too {}", 100 * std::abs(share), share >= 0 ? "large" : "small");
}

std::string Conditions(const MeshConvergence& found) {
  if (!found.working.ok) return "small loads";
  return fmt::format("{:.3g} N on every candidate, which moves it by up to {:.3g} mm",
                     found.working.load, 1e3 * found.working.deflection);
}

// The figures that are decided by: at the working load where there are any.
const MeshBias& ForceBias(const MeshConvergence& found) {
  return found.working.ok ? found.working.force : found.overall;
}

const MeshBias& DisplacementBias(const MeshConvergence& found) {
  return found.working.ok ? found.working.displacement : found.overall;
}

std::string WhatToDo(const MeshConvergence& found) {
  if (found.locks) {
    return "What to do: 4-node cells lock, and no refinement tells how far they are from the "
           "limit. Set 'order: 2' for the mesh in the scene.\n";
  }
  const MeshBias& bias = ForceBias(found);
  if (std::max(std::abs(bias.refined), std::abs(bias.converged)) < kGoodEnough) {
    return fmt::format("What to do: nothing; less than {:.0f} % is fine enough.\n",
                       100 * kGoodEnough);
  }
  return "What to do: refine at the places listed below, or let softforce run --correct-mesh "
         "refined\nmake up for it, unless the modulus was identified with this same mesh.\n";
}

std::string Table(const MeshConvergence& found) {
  std::string text =
      fmt::format("  {:<48}  {:>12}  {:>14}\n", "this mesh against", "once refined", "limit");
  if (found.working.ok) {
    const WorkingMeshBias& working = found.working;
    text += fmt::format("At work: {}\n", Conditions(found));
    text += Row("forces found are too large by", working.force);
    text += Row("displacements of the markers are too small by", working.displacement);
  }
  text += "Small loads: displacements are too small by\n";
  text += Row("all markers, under all candidates", found.overall);
  for (const MarkerMeshBias& marker : found.markers) {
    text += Row(fmt::format("marker {}", marker.id), marker.bias);
  }
  for (const CandidateMeshBias& candidate : found.candidates) {
    text += Row(fmt::format("candidate {} under its own force ({:.4g} mm/N)", candidate.id,
                            1e3 * candidate.compliance),
                candidate.own);
  }
  if (found.point_forces) {
    text +=
        "  Without a patch, a force dents finer meshes ever deeper at its own place: no limit.\n";
  }
  return text;
}

std::string WhereToRefine(const std::vector<CoarsePlace>& places) {
  if (places.empty()) return "";
  std::string text = "\nWhere to refine\n";
  text += fmt::format("  {:>12}  {:>23}  {:>10}  {:>13}\n", "part of error", "around, mm",
                      "radius, mm", "cell edge, mm");
  for (size_t i = 0; i < std::min(kPlaces, places.size()); ++i) {
    const CoarsePlace& place = places[i];
    const Eigen::Vector3d p = 1e3 * place.centre;
    text +=
        fmt::format("  {:>10.1f} %  {:7.1f} {:7.1f} {:7.1f}  {:>10.1f}  {:>13.1f}\n",
                    100 * place.share, p.x(), p.y(), p.z(), 1e3 * place.radius, 1e3 * place.size);
  }
  text += fmt::format(
      "  Edges of {:.2g} of these leave a tenth of the error, if that falls as at the "
      "edge of a clamp.\n",
      places[0].wanted_size / places[0].size);
  return text;
}

}  // namespace

std::string MeshConvergence::BriefReport() const {
  const MeshBias& force = ForceBias(*this);
  const MeshBias& moved = DisplacementBias(*this);
  return fmt::format("forces found with this mesh are {} against the once refined one{}, at {}",
                     TooLarge(force.refined),
                     std::isfinite(force.converged) ? fmt::format(" (limit {})", Limit(force)) : "",
                     Conditions(*this)) +
         fmt::format("; displacements change by {:+.1f} % on the once refined mesh",
                     100 * moved.refined);
}

std::string MeshConvergence::FullReport() const {
  const MeshBias& force = ForceBias(*this);
  const MeshBias& moved = DisplacementBias(*this);
  std::string text =
      fmt::format("Forces found with this mesh are {}, judged by the once refined mesh{}\n",
                  TooLarge(force.refined),
                  std::isfinite(force.converged) ? fmt::format("; limit {}", Limit(force)) : "");
  text += fmt::format(
      "Displacements change by {:+.1f} % on the once refined mesh{}\n", 100 * moved.refined,
      std::isfinite(moved.converged) ? fmt::format("; limit {}", Limit(moved)) : "");
  text += fmt::format("  ({})\n", Conditions(*this));
  if (!working.problem.empty()) text += "warning: large loads: " + working.problem + "\n";
  text += WhatToDo(*this) + "\n" + Table(*this);
  text += fmt::format("\n  this mesh {} cells, {} degrees of freedom; once refined {}, {}\n", cells,
                      dofs, refined_cells, refined_dofs);
  return text + WhereToRefine(places);
}

void WriteCellShares(const std::filesystem::path& path, const World& given,
                     const MeshConvergence& convergence) {
  mesh::WriteVtu(path, given.mesh(), {}, {{"bias_share", convergence.cell_share}});
}

}  // namespace softforce::pipeline
