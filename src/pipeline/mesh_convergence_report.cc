#include <fmt/format.h>

#include <cmath>

#include "softforce/mesh/write_vtu.h"
#include "softforce/pipeline/mesh_convergence.h"

namespace softforce::pipeline {
namespace {

constexpr size_t kPlaces = 12;  // listed at most

std::string Percent(double share) {
  return std::isfinite(share) ? fmt::format("{:+.2f} %", 100 * share) : "-";
}

std::string Row(const std::string& what, const MeshBias& bias) {
  return fmt::format("  {:<46}  {:>12}  {:>12}\n", what, Percent(bias.refined),
                     Percent(bias.converged));
}

}  // namespace

std::string MeshConvergence::BriefReport() const {
  const MeshBias& bias = working.ok ? working.displacement : overall;
  return fmt::format(
      "{} cells are too {}: displacements grow by {:.1f} % on the once refined mesh, by some "
      "{:.1f} "
      "% in the limit ({})",
      cells, bias.refined >= 0 ? "stiff" : "soft", 100 * bias.refined, 100 * bias.converged,
      working.ok ? fmt::format("deflected by {:.3g} mm", 1e3 * working.deflection) : "small loads");
}

std::string MeshConvergence::FullReport() const {
  std::string text = BriefReport() + "\n\n";
  text += fmt::format("  {:<46}  {:>12}  {:>12}\n", "displacements, more than on this mesh",
                      "once refined", "converged");
  text += Row("markers, small loads", overall);
  for (const CandidateMeshBias& candidate : candidates) {
    text += Row(
        fmt::format("  candidate {}, own ({:.4g} mm/N)", candidate.id, 1e3 * candidate.compliance),
        candidate.own);
  }
  for (const MarkerMeshBias& marker : markers) {
    text += Row(fmt::format("  marker {}", marker.id), marker.bias);
  }
  if (working.ok) {
    text += Row(fmt::format("markers, {:.3g} N on every candidate ({:.3g} mm)", working.load,
                            1e3 * working.deflection),
                working.displacement);
    text += Row("  forces found with this mesh, too large by", working.force);
  }
  text += fmt::format("\n  this mesh {} cells, {} degrees of freedom; once refined {}, {}\n", cells,
                      dofs, refined_cells, refined_dofs);
  if (!places.empty()) {
    text += "\nWhere to refine\n";
    text += fmt::format("  {:>8}  {:>23}  {:>10}  {:>8}  {:>8}\n", "share", "around, mm",
                        "radius, mm", "size, mm", "use, mm");
    for (size_t i = 0; i < std::min(kPlaces, places.size()); ++i) {
      const CoarsePlace& place = places[i];
      const Eigen::Vector3d p = 1e3 * place.centre;
      text += fmt::format("  {:>6.1f} %  {:7.1f} {:7.1f} {:7.1f}  {:>10.1f}  {:>8.1f}  {:>8.1f}\n",
                          100 * place.share, p.x(), p.y(), p.z(), 1e3 * place.radius,
                          1e3 * place.size, 1e3 * place.wanted_size);
    }
  }
  return text;
}

void WriteCellShares(const std::filesystem::path& path, const World& given,
                     const MeshConvergence& convergence) {
  mesh::WriteVtu(path, given.mesh(), {}, {{"bias_share", convergence.cell_share}});
}

}  // namespace softforce::pipeline
