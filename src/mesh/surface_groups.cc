#include "softforce/mesh/surface_groups.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "mesh/surface_selector.h"
#include "softforce/base/input_error.h"

namespace softforce::mesh {

const char kSelectorHelp[] =
    "A selector is one of\n"
    "    x-min x-max y-min y-max z-min z-max   what lies in the outermost plane on that side\n"
    "    plane(0 0 5 mm, 0 0 1)                what lies in the plane: a point, its normal\n"
    "    box(0 0 0, 10 10 10 mm)               triangles within a box: two opposite corners\n"
    "    normal(0 0 1, 10 deg)                 triangles that face a direction, up to an angle\n"
    "    near(10 0 20 mm, 30 deg)              smooth part closest to a point: up to edges\n"
    "                                          sharper than the angle\n"
    "    cavity                                surfaces around hollows, a group for each\n"
    "    outer                                 all but those\n"
    "  or several joined by \" & \"; for example --group \"base=z-min & box(0 0 0, 10 10 1 mm)\"";

namespace {

using base::InputError;
using Corners = std::array<int, 3>;

struct Request {
  std::string name, selector, where;
};

Request ParseRequest(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string where = fmt::format("--group \"{}\"", text);
  if (equals == std::string::npos || equals == 0 || text.find('"') != std::string::npos) {
    throw InputError(where, "expected NAME=SELECTOR", kSelectorHelp);
  }
  return {text.substr(0, equals), text.substr(equals + 1), where};
}

Corners CornersOf(const Surface& surface, int t) {
  return {surface.triangles(0, t), surface.triangles(1, t), surface.triangles(2, t)};
}

// Where the triangles of a part are, in hundredths of the body's size: equal if they are about the
// same, so that hollows side by side are ordered by the next coordinate.
std::array<long, 3> PlaceOf(const SelectableSurface& body, const std::vector<int>& triangles) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0;
  for (const int t : triangles) {
    Eigen::Matrix3d p;
    for (int i = 0; i < 3; ++i) p.col(i) = body.x.col(body.surface.triangles(i, t));
    const double twice = (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).norm();
    sum += twice * p.rowwise().mean();
    area += twice;
  }
  const Eigen::Vector3d share = (sum / area - body.low) / (body.high - body.low).norm();
  return {std::lround(100 * share.x()), std::lround(100 * share.y()), std::lround(100 * share.z())};
}

// The selected triangles: hollow by hollow if there are several, otherwise all together.
std::vector<std::vector<int>> SplitByHollow(const SelectableSurface& body,
                                            const std::vector<char>& selected) {
  std::map<int, std::vector<int>> by_part;
  for (int t = 0; t < body.surface.num_triangles(); ++t) {
    if (selected[t]) by_part[body.part[t]].push_back(t);
  }
  std::vector<std::vector<int>> hollows;
  for (const auto& entry : by_part) hollows.push_back(entry.second);
  std::stable_sort(hollows.begin(), hollows.end(), [&](const auto& a, const auto& b) {
    return PlaceOf(body, a) < PlaceOf(body, b);
  });
  return hollows;
}

}  // namespace

TetMesh WithSurfaceGroups(TetMesh mesh, const std::vector<std::string>& requests,
                          const std::string& where) {
  if (requests.empty()) return mesh;
  const SelectableSurface body(mesh);
  std::map<std::string, std::set<int>> added;
  for (const std::string& text : requests) {
    const Request request = ParseRequest(text);
    const std::vector<char> selected = Select(body, request.selector, request.where);
    if (std::find(selected.begin(), selected.end(), true) == selected.end()) {
      const bool cavity = request.selector.find("cavity") != std::string::npos;
      throw InputError(
          fmt::format("{}: {}", where, request.where), "selects no triangle of the surface",
          cavity ? "A cavity is closed all around. For a chamber with an opening take near(…)."
                 : fmt::format("The body reaches from {:.4g} {:.4g} {:.4g} to {:.4g} {:.4g} {:.4g} "
                               "mm; check the unit of IN (--unit) as well.",
                               1e3 * body.low.x(), 1e3 * body.low.y(), 1e3 * body.low.z(),
                               1e3 * body.high.x(), 1e3 * body.high.y(), 1e3 * body.high.z()));
    }
    std::vector<std::vector<int>> groups(1);
    if (request.selector.find("cavity") != std::string::npos) {
      groups = SplitByHollow(body, selected);
    } else {
      for (int t = 0; t < body.surface.num_triangles(); ++t) {
        if (selected[t]) groups[0].push_back(t);
      }
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const std::string name =
          groups.size() == 1 ? request.name : fmt::format("{}-{}", request.name, g + 1);
      if (mesh.surface_groups.count(name) > 0) {
        throw InputError(fmt::format("{}: {}", where, request.where),
                         fmt::format("it has a surface group \"{}\" already", name),
                         "Take another name.");
      }
      added[name].insert(groups[g].begin(), groups[g].end());
    }
  }
  for (const auto& [name, triangles] : added) {
    for (const int t : triangles) mesh.surface_groups[name].push_back(CornersOf(body.surface, t));
  }
  return mesh;
}

}  // namespace softforce::mesh
