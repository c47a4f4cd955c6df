#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "scene/sections.h"
#include "softforce/mesh/read_mesh.h"
#include "softforce/mesh/spread_points.h"
#include "softforce/mesh/surface_groups.h"
#include "softforce/scene/fixed_nodes.h"

namespace softforce::scene {
namespace {

using base::Dimension;

// Of one item of the list: no number of markers tells more apart.
constexpr int kMostSpread = 500;

// An item of the list of candidates: one place, or places to be spread over a surface group.
struct CandidateItem {
  Candidate candidate;   // without id and position if spread
  std::string group;     // empty: one place
  double spacing = NAN;  // m
};

void ReadDirection(const YamlValue& value, Candidate& candidate) {
  if (!value.IsList()) {
    candidate.direction = value.Choice<ForceDirection>(
        {{"free", ForceDirection::kFree}, {"normal", ForceDirection::kNormal}});
    return;
  }
  const Eigen::Vector3d direction(value.Numbers({3}).data());
  if (direction.isZero(0)) value.Fail("got [0, 0, 0], expected a direction, e.g. [0, 0, -1]");
  candidate.direction = ForceDirection::kFixed;
  candidate.fixed_direction = direction.stableNormalized();
}

CandidateItem ReadItem(YamlMap& map) {
  CandidateItem item;
  const auto group = map.Optional("group");
  if (group) {
    item.group = group->Text();
    item.spacing =
        map.Required("spacing", "How far the candidates on it are apart, for example 30 mm.")
            .PositiveQuantity(Dimension::kLength);
  } else {
    item.candidate.id =
        map.Required("id",
                     "A place has an id and a position; places that are spread over a "
                     "surface have a group and a spacing.")
            .Integer(0);
    item.candidate.position = map.Required("position").Vector(Dimension::kLength);
  }
  ReadDirection(map.Required("direction", "Write free, normal, or for example [0, 0, -1]."),
                item.candidate);
  return item;
}

// Spreads candidates over surface groups of the scene's mesh.
class Spreader {
 public:
  explicit Spreader(const Scene& scene)
      : mesh_(mesh::ReadMesh(scene.mesh.file, scene.mesh.metres_per_unit)) {
    mesh::CheckMesh(mesh_, scene.mesh.file.string());
    surface_ = mesh::ExtractSurface(mesh_);
    const std::vector<int> fixed = FixedNodes(scene, mesh_, surface_);
    fixed_.insert(fixed.begin(), fixed.end());
  }

  std::vector<Eigen::Vector3d> Places(const CandidateItem& item, const YamlValue& at) const {
    const std::vector<int> free = FreeTriangles(item.group, at);
    // Each place keeps a disc of at most 1.25 spacings for itself, see SpreadPoints.
    const double fewest = Area(free) / (M_PI * std::pow(1.25 * item.spacing, 2));
    if (fewest > kMostSpread) RefuseSoMany(fmt::format("{:.3g} or more", fewest), at);
    std::vector<Eigen::Vector3d> places;
    for (const mesh::SurfacePoint& point :
         mesh::SpreadPoints(surface_, mesh_.nodes, free, item.spacing,
                            [](const mesh::SurfacePoint&) { return true; })) {
      places.push_back(mesh::Position(surface_, mesh_.nodes, point));
    }
    if (static_cast<int>(places.size()) > kMostSpread)
      RefuseSoMany(std::to_string(places.size()), at);
    return places;
  }

 private:
  // Those of the group without held nodes: a force on what is held moves nothing.
  std::vector<int> FreeTriangles(const std::string& group, const YamlValue& at) const {
    std::vector<int> free;
    for (const int t : mesh::GroupTriangles(group, mesh_, surface_, at.where())) {
      const Eigen::Vector3i corners = surface_.triangles.col(t).head<3>();
      if (std::none_of(corners.begin(), corners.end(),
                       [&](int node) { return fixed_.count(node) > 0; })) {
        free.push_back(t);
      }
    }
    if (free.empty()) {
      at.Fail(fmt::format("every part of the surface group \"{}\" touches what is held", group),
              "Name one on which a force moves the body.");
    }
    return free;
  }

  double Area(const std::vector<int>& triangles) const {
    double area = 0;
    for (const int t : triangles) {
      const Eigen::Vector3d a = mesh_.nodes.col(surface_.triangles(0, t));
      const Eigen::Vector3d ab = mesh_.nodes.col(surface_.triangles(1, t)) - a;
      const Eigen::Vector3d ac = mesh_.nodes.col(surface_.triangles(2, t)) - a;
      area += ab.cross(ac).norm() / 2;
    }
    return area;
  }

  [[noreturn]] static void RefuseSoMany(const std::string& count, const YamlValue& at) {
    at.Fail(fmt::format("makes {} candidates, expected {} at most", count, kMostSpread),
            "Spread them further apart, by a wider \"spacing\".");
  }

  mesh::TetMesh mesh_;
  mesh::Surface surface_;
  std::set<int> fixed_;
};

// Those that are spread have the ids after the largest that is given.
std::vector<Candidate> ReadCandidates(const YamlValue& list, const Scene& scene) {
  const std::vector<CandidateItem> items = list.ReadMaps(ReadItem);
  RefuseRepeated(list, items, [&](const CandidateItem& item) {
    return item.group.empty() ? fmt::format("id {}", item.candidate.id)
                              : fmt::format("group \"{}\"", item.group);
  });
  int next_id = 0;
  for (const CandidateItem& item : items) next_id = std::max(next_id, item.candidate.id + 1);
  std::optional<Spreader> spreader;
  std::vector<Candidate> candidates;
  for (size_t i = 0; i < items.size(); ++i) {
    if (items[i].group.empty()) {
      candidates.push_back(items[i].candidate);
      continue;
    }
    if (!spreader) spreader.emplace(scene);
    for (const Eigen::Vector3d& place : spreader->Places(items[i], list.Items()[i])) {
      candidates.push_back(items[i].candidate);
      candidates.back().id = next_id++;
      candidates.back().position = place;
    }
  }
  return candidates;
}

}  // namespace

Forces ReadForces(YamlMap& map, const Scene& scene) {
  Forces forces;
  forces.known_locations =
      map.Required("known", "Write true if the forces act at the candidates, false if near them.")
          .Choice<bool>({{"true", true}, {"false", false}});
  if (const auto patch = map.Optional("patch")) {
    forces.patch = patch->PositiveQuantity(Dimension::kLength);
  }
  const YamlValue candidates = map.Required("candidates");
  candidates.RefuseEmptyList("List the places where a force may act.");
  forces.candidates = ReadCandidates(candidates, scene);
  return forces;
}

}  // namespace softforce::scene
