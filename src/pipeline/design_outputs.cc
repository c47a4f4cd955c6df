// The files of a design.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/design_task.h"
#include "pipeline/result_tables.h"
#include "softforce/base/input_error.h"
#include "softforce/base/version.h"
#include "softforce/mesh/write_vtu.h"
#include "softforce/render/surface_map.h"

namespace softforce::pipeline {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillimetre = 1e-3;

std::string Place(const Eigen::Vector3d& p) {
  return fmt::format("{:.3f} {:.3f} {:.3f} mm", p.x() / kMillimetre, p.y() / kMillimetre,
                     p.z() / kMillimetre);
}

void WriteFragment(const scene::Scene& scene, const DesignReport& report) {
  PendingTable file(report.out / "markers.yaml",
                    "# Chosen by softforce design. Put it in the place of the section \"markers\" "
                    "of the scene.");
  std::ostream& out = file.stream();
  const scene::Markers& markers = scene.markers;
  const bool tags = markers.type == scene::MarkerType::kAprilTag;
  out << "markers:\n  type: " << (tags ? "apriltag" : "dot") << "\n";
  if (tags) out << "  family: " << markers.family << "\n";
  if (std::isfinite(markers.size)) {
    out << fmt::format("  size: {:.6g} mm\n", markers.size / kMillimetre);
  }
  out << "  points:\n";
  for (size_t i = 0; i < report.markers.size(); ++i) {
    out << fmt::format("    - {{id: {}, position: {}}}\n", i, Place(report.markers[i].position));
  }
  file.Commit();
}

void WriteTable(const DesignReport& report) {
  PendingTable table(report.out / "markers.csv", "marker,x_mm,y_mm,z_mm,cameras,sd_mm");
  for (size_t i = 0; i < report.markers.size(); ++i) {
    const DesignedMarker& marker = report.markers[i];
    const Eigen::Vector3d mm = marker.position / kMillimetre;
    table.stream() << fmt::format("{},{:.3f},{:.3f},{:.3f},{},{:.4f}\n", i, mm.x(), mm.y(), mm.z(),
                                  marker.cameras, marker.sd / kMillimetre);
  }
  table.Commit();
}

// NaN becomes null.
Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json Of(const LayoutErrors& errors) {
  return {{"location_error_mm", Number(errors.location / kMillimetre)},
          {"location_error_90_percent_mm", Number(errors.location_most / kMillimetre)},
          {"force_error_N", Number(errors.force)},
          {"I_w_N_per_mm", Number(errors.I_w * kMillimetre)}};
}

void WriteSummary(const scene::Scene& scene, const DesignEyes& eyes, const DesignReport& report) {
  Json json{{"softforce", base::kVersion},
            {"scene", scene.name},
            {"markers", report.markers.size()},
            {"places", report.places},
            {"spacing_of_places_mm", report.spacing / kMillimetre},
            {"loads", report.loads},
            {"load_N", report.load},
            {"rig_place_from", eyes.any() ? Json(eyes.from) : Json()},
            {"noise_mm", eyes.any() ? Json() : Json(eyes.noise / kMillimetre)},
            {"location_error_without_markers_mm", report.best.location_of_unknown / kMillimetre},
            {"best", Of(report.best)},
            {"own", Of(report.own)},
            {"random",
             {{"layouts", report.random_layouts},
              {"median_location_error_mm", report.random_location / kMillimetre},
              {"median_location_error_90_percent_mm", report.random_location_most / kMillimetre},
              {"best_location_error_mm", report.random_best / kMillimetre}}},
            {"exchanges", report.exchanges},
            {"settled", report.settled}};
  for (const design::CandidateGrid& grid : report.grids) {
    json["candidate_spacings"].push_back({{"spacing_mm", grid.spacing / kMillimetre},
                                          {"candidates", grid.candidates},
                                          {"components", grid.components},
                                          {"enough_markers", grid.enough_markers},
                                          {"I_w_N_per_mm", Number(grid.I_w * kMillimetre)},
                                          {"force_sd_N", Number(grid.force_sd)},
                                          {"worst_force_sd_N", Number(grid.worst_force_sd)},
                                          {"told_apart_share", grid.told_apart}});
  }
  const int supported = report.SupportedGrid();
  json["supported_spacing_mm"] =
      supported < 0 ? Json() : Json(report.grids[supported].spacing / kMillimetre);
  json["spacing_of_one_force_mm"] = {
      {"median", Number(report.spacing_of_one.median / kMillimetre)},
      {"90_percent", Number(report.spacing_of_one.most / kMillimetre)}};
  json["warnings"] = report.warnings;
  PendingTable file(report.out / "summary.json", json.dump(2));
  file.Commit();
}

Eigen::Vector3d MeanNormal(const World& world, const Eigen::Matrix3Xd& x,
                           const std::vector<int>& triangles) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int t : triangles) {
    const Eigen::Vector3d a = x.col(world.surface.triangles(0, t));
    const Eigen::Vector3d ab = x.col(world.surface.triangles(1, t)) - a;
    const Eigen::Vector3d ac = x.col(world.surface.triangles(2, t)) - a;
    sum += ab.cross(ac) / 2;
  }
  return sum / AreaOf(world, triangles);
}

// The first camera's view, or a plain one from obliquely above; and one of the side on which the
// forces act, where that is turned away, or else of the body's other side.
std::vector<render::MapView> ViewsOf(const World& world, const Eigen::Matrix3Xd& x,
                                     const DesignEyes& eyes, const LoadSurface& loads) {
  std::vector<render::MapView> views;
  const Eigen::Vector3d middle = x.rowwise().mean();
  Eigen::Vector3d towards = Eigen::Vector3d(0.5, -0.6, 0.6).normalized();
  if (eyes.any()) {
    const camera::Camera& camera = eyes.rig.cameras[0];
    const Eigen::Isometry3d T_camera_robot = camera.T_camera_rig * eyes.T_rig_robot;
    views.push_back({"camera " + camera.name, camera, T_camera_robot});
    towards = (T_camera_robot.inverse().translation() - middle).normalized();
  } else {
    views.push_back(render::PlainView("from above", x, towards));
  }
  const Eigen::Vector3d normal = MeanNormal(world, x, loads.triangles);
  const bool has_side = normal.norm() > 0.5;
  if (has_side && normal.normalized().dot(towards) < 0.3) {
    views.push_back(render::PlainView("side on which the forces act", x, normal.normalized()));
  } else {
    const Eigen::Vector3d other =
        Eigen::Vector3d(-towards.x(), -towards.y(), towards.z()).normalized();
    const bool same = other.dot(towards) > 0.9;
    views.push_back(render::PlainView("other side", x, same ? Eigen::Vector3d(-towards) : other));
  }
  return views;
}

// Of the values where forces may act.
double Quantile(const Eigen::VectorXd& values, const LoadSurface& loads, double share) {
  std::vector<double> finite;
  for (const int t : loads.triangles) {
    if (std::isfinite(values(t))) finite.push_back(values(t));
  }
  const auto at = static_cast<size_t>(share * static_cast<double>(finite.size() - 1));
  std::nth_element(finite.begin(), finite.begin() + static_cast<std::ptrdiff_t>(at), finite.end());
  return finite[at];
}

std::vector<std::string> Numbers(size_t count) {
  std::vector<std::string> numbers;
  for (size_t i = 0; i < count; ++i) numbers.push_back(std::to_string(i));
  return numbers;
}

void WritePicture(const scene::Scene& scene, const World& world, const Eigen::Matrix3Xd& x,
                  const DesignEyes& eyes, const LoadSurface& loads, const DesignMaps& maps,
                  const std::vector<Eigen::Vector3d>& shown_best,
                  const std::vector<Eigen::Vector3d>& shown_own, const DesignReport& report) {
  render::MapScale scale;
  scale.title = fmt::format("expected error\nof the place of\n{:.3g} N, mm", report.load);
  scale.low = Quantile(maps.best, loads, 0.02) / kMillimetre;
  scale.high = std::max(
      1.5 * scale.low,
      std::max(Quantile(maps.best, loads, 0.98), Quantile(maps.own, loads, 0.98)) / kMillimetre);
  std::vector<std::string> own_ids;
  for (const scene::MarkerPoint& point : scene.markers.points) {
    own_ids.push_back(std::to_string(point.id));
  }
  const std::vector<render::MapRow> rows{
      {fmt::format("chosen: {} markers, median {:.2f} mm where forces may act", shown_best.size(),
                   report.best.location / kMillimetre),
       maps.best / kMillimetre, shown_best, Numbers(shown_best.size())},
      {fmt::format("the scene's own: {} markers, median {:.2f} mm", shown_own.size(),
                   report.own.location / kMillimetre),
       maps.own / kMillimetre, shown_own, own_ids}};
  const cv::Mat picture =
      render::DrawSurfaceMaps(world.surface, x, ViewsOf(world, x, eyes, loads), rows, scale);
  base::PendingFile file(report.out / "design.png");
  if (!cv::imwrite(file.temporary().string(), picture)) {
    throw base::InputError(file.path().string(), "cannot be written",
                           "Check the folder's permissions and the disk's space.");
  }
  file.Commit();
}

}  // namespace

std::vector<std::string> DesignFiles() {
  return {"markers.yaml", "markers.csv", "summary.json", "design.png", "location_error.vtu"};
}

void WriteDesign(const scene::Scene& scene, const World& world, const Eigen::Matrix3Xd& x,
                 const DesignEyes& eyes, const LoadSurface& loads, const DesignMaps& maps,
                 const std::vector<Eigen::Vector3d>& shown_best,
                 const std::vector<Eigen::Vector3d>& shown_own, const DesignReport& report) {
  WriteFragment(scene, report);
  WriteTable(report);
  WritePicture(scene, world, x, eyes, loads, maps, shown_best, shown_own, report);
  Eigen::VectorXd on_loads = Eigen::VectorXd::Zero(world.surface.num_triangles());
  for (const int t : loads.triangles) on_loads(t) = 1;
  mesh::WriteSurfaceVtu(report.out / "location_error.vtu", world.surface, world.mesh().nodes,
                        {{"location_error_chosen_mm", maps.best / kMillimetre},
                         {"location_error_scene_mm", maps.own / kMillimetre},
                         {"forces_may_act", on_loads}});
  WriteSummary(scene, eyes, report);
}

}  // namespace softforce::pipeline
