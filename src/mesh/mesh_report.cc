#include "softforce/mesh/mesh_report.h"

#include <fmt/format.h>

#include "mesh/millimetres.h"

namespace softforce::mesh {
namespace {

constexpr double kDegrees = 57.29577951308232;  // per rad

std::string Line(const std::string& label, const std::string& text) {
  return fmt::format("  {:<22}{}\n", label, text);
}

std::string Body(const MeshReport& report) {
  const Eigen::Vector3d size = 1e3 * (report.high - report.low);
  std::string text = fmt::format("{}\n", report.BriefReport());
  text += Line("bounding box",
               fmt::format("{} to {}: {:.2f} x {:.2f} x {:.2f} mm", InMillimetres(report.low, 2),
                           InMillimetres(report.high, 2), size.x(), size.y(), size.z()));
  std::string volume = fmt::format("{:.4g} cm^3", 1e6 * report.volume);
  if (std::isfinite(report.solid_volume)) {
    volume +=
        fmt::format(", {:.2f} % of the geometry's", 100 * report.volume / report.solid_volume);
  }
  text += Line("volume", volume);
  text += Line("connected parts", fmt::format("{}", report.parts));
  text += Line("closed cavities", fmt::format("{}", report.cavities));
  return text;
}

std::string Quality(const MeshReport& report) {
  std::string text = "\nQuality (1: regular tetrahedron, 0: flat)\n";
  text += Line("least", fmt::format("{:.3f} at {}", report.least_quality.value,
                                    InMillimetres(report.least_quality.at, 2)));
  text += Line("1 % below, median",
               fmt::format("{:.3f}, {:.3f}", report.quality_1_percent, report.median_quality));
  text +=
      Line(fmt::format("cells below {}", kPoorQuality), fmt::format("{}", report.poor_elements));
  text += Line("angles between faces",
               fmt::format("{:.1f} to {:.1f} deg", kDegrees * report.least_dihedral,
                           kDegrees * report.greatest_dihedral));
  text +=
      Line("edges", fmt::format("{:.3g} to {:.3g} mm, median {:.3g} mm", 1e3 * report.least_edge,
                                1e3 * report.greatest_edge, 1e3 * report.median_edge));
  if (report.order == 2) {
    text +=
        Line("Jacobian, least/most", fmt::format("{:.3f} at {}", report.least_jacobian_ratio.value,
                                                 InMillimetres(report.least_jacobian_ratio.at, 2)));
  }
  if (std::isfinite(report.thinnest.value)) {
    text += Line("cells across walls",
                 fmt::format("1 on {:.0f} %, 2 on {:.0f} %, more on {:.0f} % of the surface",
                             100 * report.one_cell_thick, 100 * report.two_cells_thick,
                             100 * report.more_cells_thick));
    text += Line("thinnest wall", fmt::format("{:.2f} mm at {}", 1e3 * report.thinnest.value,
                                              InMillimetres(report.thinnest.at, 2)));
  }
  return text;
}

std::string Regions(const MeshReport& report) {
  std::string text = fmt::format("\n{:<20}  {:>8}  {:>13}\n", "Region", "cells", "volume, cm^3");
  for (const RegionReport& region : report.regions) {
    text +=
        fmt::format("  {:<18}  {:>8}  {:>13.4f}\n", region.name.empty() ? "(unnamed)" : region.name,
                    region.elements, 1e6 * region.volume);
  }
  return text;
}

std::string Groups(const MeshReport& report) {
  if (report.groups.empty()) return "\nNo surface groups\n";
  std::string text = fmt::format("\n{:<20}  {:>8}  {:>13}  {:<26}  {}\n", "Surface group", "faces",
                                 "area, mm^2", "centre", "closed");
  for (const SurfaceGroupReport& group : report.groups) {
    text += fmt::format(
        "  {:<18}  {:>8}  {:>13.2f}  {:<26}  {}\n", group.name, group.triangles, 1e6 * group.area,
        InMillimetres(group.centre, 2),
        group.closed ? fmt::format("around {:.4g} cm^3", 1e6 * group.enclosed_volume) : "no");
  }
  return text;
}

}  // namespace

std::string MeshReport::BriefReport() const {
  return fmt::format("{} cells of {} nodes each, {} nodes", elements, order == 2 ? 10 : 4, nodes);
}

std::string MeshReport::FullReport() const {
  std::string text = Body(*this) + Quality(*this) + Regions(*this) + Groups(*this);
  if (!warnings.empty()) text += "\n";
  for (const std::string& warning : warnings) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace softforce::mesh
