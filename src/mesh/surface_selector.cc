#include "mesh/surface_selector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "mesh/connectivity.h"
#include "softforce/base/input_error.h"
#include "softforce/base/quantity.h"
#include "softforce/mesh/surface_groups.h"

namespace softforce::mesh {
namespace {

using base::Dimension;
using base::InputError;
using Predicate = std::function<bool(int triangle)>;

// Numbers of binary STL files have 1.2e-7 of their size, and planes of CAD files lie as exactly.
constexpr double kTolerance = 1e-5;  // share of the body's diagonal

std::string Trimmed(const std::string& text) {
  const std::size_t start = text.find_first_not_of(" \t");
  if (start == std::string::npos) return "";
  return text.substr(start, text.find_last_not_of(" \t") + 1 - start);
}

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> pieces(1);
  for (const char c : text) {
    if (c == separator) {
      pieces.emplace_back();
    } else {
      pieces.back() += c;
    }
  }
  for (std::string& piece : pieces) piece = Trimmed(piece);
  return pieces;
}

// A selector and what stands in its parentheses.
struct Term {
  std::string name;
  std::vector<std::string> arguments;
  std::string where;  // with the term itself, for messages

  Eigen::Vector3d Vector(int argument, Dimension dimension) const {
    const auto numbers = base::ParseQuantity(arguments[argument], dimension, 3, where);
    return Eigen::Vector3d::Map(numbers.data());
  }
  double Angle(int argument) const {
    const double angle = base::ParseQuantity(arguments[argument], Dimension::kAngle, 1, where)[0];
    if (angle >= 0 && angle <= EIGEN_PI) return angle;
    throw InputError(
        where, fmt::format("the angle is {}, must be within 0 and 180 deg", arguments[argument]),
        "For example: 30 deg");
  }
  Eigen::Vector3d Direction(int argument) const {
    const Eigen::Vector3d direction = Vector(argument, Dimension::kNumber);
    if (direction.norm() > 0) return direction.normalized();
    throw InputError(where, "the direction is 0 0 0, must have a length", "For example: 0 0 1");
  }
};

Term ParseTerm(const std::string& text, const std::string& where) {
  Term term{text, {}, fmt::format("{}: {}", where, text)};
  const std::size_t open = text.find('(');
  if (open == std::string::npos) return term;
  if (text.back() != ')') {
    throw InputError(term.where, "the parenthesis is not closed", kSelectorHelp);
  }
  term.name = Trimmed(text.substr(0, open));
  term.arguments = Split(text.substr(open + 1, text.size() - open - 2), ',');
  return term;
}

Predicate AllCorners(const SelectableSurface& body,
                     std::function<bool(const Eigen::Vector3d&)> holds) {
  return [&body, holds](int t) {
    for (int i = 0; i < 3; ++i) {
      if (!holds(body.x.col(body.surface.triangles(i, t)))) return false;
    }
    return true;
  };
}

Predicate InPlane(const SelectableSurface& body, const Eigen::Vector3d& point,
                  const Eigen::Vector3d& normal) {
  return AllCorners(body, [=, tolerance = body.tolerance](const Eigen::Vector3d& p) {
    return std::abs(normal.dot(p - point)) <= tolerance;
  });
}

Predicate InBox(const SelectableSurface& body, Term term) {
  constexpr char kNumber[] = "0123456789.";
  const std::string& last = term.arguments[1];  // one unit at the end will do for both corners
  if (term.arguments[0].find_last_of(kNumber) + 1 == term.arguments[0].size()) {
    term.arguments[0] += " " + last.substr(last.find_last_of(kNumber) + 1);
  }
  const Eigen::Vector3d a = term.Vector(0, Dimension::kLength);
  const Eigen::Vector3d b = term.Vector(1, Dimension::kLength);
  const Eigen::Array3d low = a.cwiseMin(b).array() - body.tolerance;
  const Eigen::Array3d high = a.cwiseMax(b).array() + body.tolerance;
  return AllCorners(body, [=](const Eigen::Vector3d& p) {
    return (p.array() >= low).all() && (p.array() <= high).all();
  });
}

Predicate FacingAlong(const SelectableSurface& body, const Eigen::Vector3d& direction,
                      double angle) {
  return [&body, direction, least = std::cos(angle) - 1e-9](int t) {
    return body.normals.col(t).dot(direction) >= least;
  };
}

Predicate SmoothPartNear(const SelectableSurface& body, const Term& term) {
  const Eigen::Vector3d point = term.Vector(0, Dimension::kLength);
  const double least = std::cos(term.Angle(1)) - 1e-9;
  const SurfaceProjection nearest = ClosestSurfacePoint(body.surface, body.x, point);
  const double reach = 0.1 * (body.high - body.low).norm();
  if (nearest.distance > reach) {
    throw InputError(term.where,
                     fmt::format("the point is {:.3g} mm off the surface, must be within {:.3g} mm",
                                 1e3 * nearest.distance, 1e3 * reach),
                     "Check its unit, and the bounding box of the mesh.");
  }
  DisjointSets smooth(body.surface.num_triangles());
  for (const auto& [a, b] : Neighbours(body.surface)) {
    if (body.normals.col(a).dot(body.normals.col(b)) >= least) smooth.Join(a, b);
  }
  return [part = smooth.Numbers(), start = nearest.at.triangle](int t) {
    return part[t] == part[start];
  };
}

Predicate Parse(const SelectableSurface& body, const Term& term) {
  const std::map<std::string, std::size_t> num_arguments{
      {"x-min", 0}, {"x-max", 0}, {"y-min", 0},  {"y-max", 0}, {"z-min", 0},  {"z-max", 0},
      {"plane", 2}, {"box", 2},   {"normal", 2}, {"near", 2},  {"cavity", 0}, {"outer", 0}};
  const auto known = num_arguments.find(term.name);
  if (known == num_arguments.end()) {
    throw InputError(term.where, fmt::format("there is no selector \"{}\"", term.name),
                     kSelectorHelp);
  }
  if (term.arguments.size() != known->second) {
    throw InputError(term.where,
                     fmt::format("got {} arguments separated by commas, expected {}",
                                 term.arguments.size(), known->second),
                     kSelectorHelp);
  }
  if (term.name == "plane") {
    return InPlane(body, term.Vector(0, Dimension::kLength), term.Direction(1));
  }
  if (term.name == "box") return InBox(body, term);
  if (term.name == "normal") return FacingAlong(body, term.Direction(0), term.Angle(1));
  if (term.name == "near") return SmoothPartNear(body, term);
  if (term.name == "cavity" || term.name == "outer") {
    return [&body, cavity = term.name == "cavity"](int t) {
      return bool(body.part_is_cavity[body.part[t]]) == cavity;
    };
  }
  const bool least = term.name.substr(2) == "min";
  return InPlane(body, least ? body.low : body.high, Eigen::Vector3d::Unit(term.name[0] - 'x'));
}

}  // namespace

SelectableSurface::SelectableSurface(const TetMesh& mesh)
    : surface(ExtractSurface(mesh)),
      x(mesh.nodes),
      normals(FlatNormals(surface, x)),
      part(SurfaceParts(surface)),
      low(x.rowwise().minCoeff()),
      high(x.rowwise().maxCoeff()),
      tolerance(kTolerance * (high - low).norm()) {
  for (const double volume : EnclosedVolumes(surface, x, part)) {
    part_is_cavity.push_back(volume < 0);
  }
}

std::vector<char> Select(const SelectableSurface& body, const std::string& selector,
                         const std::string& where) {
  std::vector<char> selected(body.surface.num_triangles(), true);
  for (const std::string& text : Split(selector, '&')) {
    const Predicate predicate = Parse(body, ParseTerm(text, where));
    for (int t = 0; t < body.surface.num_triangles(); ++t) {
      selected[t] = selected[t] && predicate(t);
    }
  }
  return selected;
}

}  // namespace softforce::mesh
