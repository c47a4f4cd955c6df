#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "mesh/closest_triangle.h"
#include "mesh/triangle_shapes.h"
#include "softforce/mesh/patches.h"

namespace softforce::mesh {
namespace {

constexpr double kPi = 3.14159265358979323846;

// The mean over a disc of radius R is ∫∫ f dθ/2π d(r²)/R². Gauss–Legendre points in r²/R² and
// evenly spaced angles integrate polynomials of degree below kAngles exactly; the many points are
// for the kinks of the shape functions at the triangles' edges.
constexpr int kAngles = 32;
constexpr int kRadii = 8;
struct GaussPoint {
  double at;  // −1 … 1
  double weight;
};
constexpr std::array<GaussPoint, kRadii / 2> kGauss{{{0.1834346424956498, 0.3626837833783620},
                                                     {0.5255324099163290, 0.3137066458778873},
                                                     {0.7966664774136267, 0.2223810344533745},
                                                     {0.9602898564975363, 0.1012285362903763}}};

struct DiscPoint {
  double share;
  Eigen::Vector2d at;  // of the unit disc
};

const std::vector<DiscPoint>& DiscPoints() {
  static const std::vector<DiscPoint> points = [] {
    std::vector<DiscPoint> made;
    for (int ring = 0; ring < kRadii; ++ring) {
      const GaussPoint& gauss = kGauss[ring / 2];
      const double r = std::sqrt((1 + (ring % 2 ? -gauss.at : gauss.at)) / 2);
      for (int i = 0; i < kAngles; ++i) {
        const double angle = 2 * kPi * (i + 0.5 * (ring % 2)) / kAngles;
        made.push_back({gauss.weight / 2 / kAngles, {r * std::cos(angle), r * std::sin(angle)}});
      }
    }
    return made;
  }();
  return points;
}

// The sheet, prepared for many points: its nodes counted from 0, its triangles with what gives
// their barycentric coordinates.
class Sheet {
 public:
  Sheet(const Surface& surface, const Eigen::Matrix3Xd& X, std::vector<int> triangles,
        const Eigen::Matrix3Xd& directions)
      : surface_(surface), X_(X), triangles_(std::move(triangles)) {
    for (const int t : triangles_) {
      for (const int node : surface.triangles.col(t)) number_.emplace(node, 0);
    }
    int next = 0;
    for (auto& [node, number] : number_) number = next++;
    for (const int t : triangles_) facets_.push_back(FacetOf(t, directions));
    sum_ = Eigen::MatrixXd::Zero(next, 1 + directions.cols());
  }

  // Adds a share of the shape functions at the place of the sheet that is closest to p.
  void Add(double share, const Eigen::Vector3d& p) {
    Eigen::Vector3d L;
    const Facet* facet = Containing(p, &L);
    if (facet == nullptr) {
      const SurfacePoint at = ClosestAmong(triangles_, surface_, X_, p).at;
      facet = &facets_[static_cast<std::size_t>(
          std::find(triangles_.begin(), triangles_.end(), at.triangle) - triangles_.begin())];
      L = at.barycentric;
    }
    const TriangleValues N = TriangleShapes(surface_.order(), L);
    const TriangleSlopes dN = TriangleShapeSlopes(surface_.order(), L);
    for (int i = 0; i < N.size(); ++i) {
      auto row = sum_.row(facet->nodes[i]);
      row(0) += share * N(i);
      for (int d = 0; d < facet->dL.cols(); ++d) {
        row(1 + d) += share * (dN(i, 0) * facet->dL(0, d) + dN(i, 1) * facet->dL(1, d));
      }
    }
  }

  // The nodes that have a share.
  MovingPatch Sum() const {
    MovingPatch result;
    std::vector<int> rows;
    for (const auto& [node, number] : number_) {
      if (sum_.row(number).isZero(0)) continue;
      rows.push_back(number);
      result.weights.nodes.push_back(node);
      result.weights.weights.push_back(sum_(number, 0));
    }
    result.slopes = sum_(rows, Eigen::seqN(1, sum_.cols() - 1));
    return result;
  }

 private:
  struct Facet {
    Eigen::Vector3d corner;            // 0
    Eigen::Vector3d normal;            // unit
    Eigen::Matrix<double, 2, 3> to_L;  // of L(1), L(2) by the place, 1/m
    Eigen::Matrix2Xd dL;               // of them along the directions
    std::array<int, 6> nodes;          // numbers in the sheet
  };

  Facet FacetOf(int t, const Eigen::Matrix3Xd& directions) const {
    const auto corner = [&](int i) { return X_.col(surface_.triangles(i, t)); };
    const Eigen::Vector3d edge1 = corner(1) - corner(0), edge2 = corner(2) - corner(0);
    Facet facet{
        corner(0), edge1.cross(edge2).normalized(), BarycentricSlopes(edge1, edge2), {}, {}};
    facet.dL = facet.to_L * directions;
    for (int i = 0; i < surface_.triangles.rows(); ++i) {
      facet.nodes[i] = number_.at(surface_.triangles(i, t));
    }
    return facet;
  }

  // The triangle in which p lies, with its coordinates there; none can be closer.
  const Facet* Containing(const Eigen::Vector3d& p, Eigen::Vector3d* L) {
    constexpr double kInPlane = 1e-12;  // m
    const std::size_t n = facets_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t f = (last_ + i) % n;
      const Facet& facet = facets_[f];
      const Eigen::Vector3d from_corner = p - facet.corner;
      if (std::abs(facet.normal.dot(from_corner)) > kInPlane) continue;
      const Eigen::Vector2d L12 = facet.to_L * from_corner;
      *L = {1 - L12.sum(), L12(0), L12(1)};
      if (L->minCoeff() < 0) continue;
      last_ = f;
      return &facet;
    }
    return nullptr;
  }

  const Surface& surface_;
  const Eigen::Matrix3Xd& X_;
  std::vector<int> triangles_;
  std::map<int, int> number_;  // of each node
  std::vector<Facet> facets_;
  std::size_t last_ = 0;  // facet in which a place was found: the next one is near it
  Eigen::MatrixXd sum_;   // per node: weight, slopes
};

}  // namespace

Patches::Patches(const Surface& surface, const Eigen::Matrix3Xd& X, double diameter)
    : surface_(surface), X_(X), diameter_(diameter), at_node_(X.cols()) {
  assert(diameter >= 0);
  for (int t = 0; t < surface_.num_triangles(); ++t) {
    for (int i = 0; i < 3; ++i) at_node_[surface_.triangles(i, t)].push_back(t);
  }
}

// A point of the disc is at most one radius from the surface, hence what is closest to it is at
// most two radii, which is a diameter, from the centre.
std::vector<int> Patches::SheetAround(const SurfacePoint& centre) const {
  const Eigen::Vector3d middle = Position(surface_, X_, centre);
  const Eigen::Vector3d normal = Normal(surface_, X_, centre);
  std::vector<int> sheet{centre.triangle};
  std::set<int> known{centre.triangle};
  for (std::size_t i = 0; i < sheet.size(); ++i) {
    const std::size_t joining = sheet.size();
    for (const int node : surface_.triangles.col(sheet[i]).head<3>()) {
      for (const int t : at_node_[node]) {
        if (!known.insert(t).second) continue;
        if (SquaredDistanceToBox(surface_, X_, t, middle) > diameter_ * diameter_) continue;
        const SurfacePoint there{t, Eigen::Vector3d::Constant(1.0 / 3)};
        if (Normal(surface_, X_, there).dot(normal) > 0) sheet.push_back(t);
      }
    }
    std::sort(sheet.begin() + static_cast<std::ptrdiff_t>(joining), sheet.end());
  }
  return sheet;
}

MovingPatch Patches::At(const SurfacePoint& centre, const Eigen::Matrix3Xd& directions) const {
  if (diameter_ == 0) {
    return {ShapeFunctions(surface_, centre),
            ShapeFunctionSlopes(surface_, X_, centre, directions)};
  }
  const double radius = diameter_ / 2;
  const Eigen::Vector3d middle = Position(surface_, X_, centre);
  const Eigen::Vector3d normal = Normal(surface_, X_, centre);
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = normal.unitOrthogonal();
  across.col(1) = normal.cross(across.col(0));
  Sheet disc(surface_, X_, SheetAround(centre), directions);
  for (const DiscPoint& point : DiscPoints()) {
    disc.Add(point.share, middle + radius * (across * point.at));
  }
  return disc.Sum();
}

MovingPatch MovingPatchWeights(const Surface& surface, const Eigen::Matrix3Xd& X,
                               const SurfacePoint& centre, double diameter,
                               const Eigen::Matrix3Xd& directions) {
  return Patches(surface, X, diameter).At(centre, directions);
}

NodalWeights PatchWeights(const Surface& surface, const Eigen::Matrix3Xd& X,
                          const SurfacePoint& centre, double diameter) {
  return MovingPatchWeights(surface, X, centre, diameter, Eigen::Matrix3Xd(3, 0)).weights;
}

}  // namespace softforce::mesh
