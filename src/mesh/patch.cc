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
#include "softforce/mesh/surface.h"

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

// The sheet of surface on which the disc lies: triangles within `reach` of its centre that do not
// face backwards and hang together with the centre's triangle. A thin body's other side and parts
// that merely come close are not among them.
std::vector<int> SheetAround(const Surface& surface, const Eigen::Matrix3Xd& X, int centre_triangle,
                             const Eigen::Vector3d& centre, const Eigen::Vector3d& normal,
                             double reach) {
  std::vector<int> waiting;
  for (int t = 0; t < surface.num_triangles(); ++t) {
    if (t == centre_triangle) continue;
    if (SquaredDistanceToBox(surface, X, t, centre) > reach * reach) continue;
    const SurfacePoint middle{t, Eigen::Vector3d::Constant(1.0 / 3)};
    if (Normal(surface, X, middle).dot(normal) > 0) waiting.push_back(t);
  }

  std::vector<int> sheet{centre_triangle};
  std::set<int> sheet_nodes;
  const auto corners = [&](int t) { return surface.triangles.col(t).head<3>(); };
  for (std::size_t i = 0; i < sheet.size(); ++i) {
    for (const int node : corners(sheet[i])) sheet_nodes.insert(node);
    const auto touches = [&](int t) {
      const auto nodes = corners(t);
      return std::any_of(nodes.begin(), nodes.end(),
                         [&](int node) { return sheet_nodes.count(node) > 0; });
    };
    const auto joined =
        std::stable_partition(waiting.begin(), waiting.end(), [&](int t) { return !touches(t); });
    sheet.insert(sheet.end(), joined, waiting.end());
    waiting.erase(joined, waiting.end());
  }
  return sheet;
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
  const Facet* Containing(const Eigen::Vector3d& p, Eigen::Vector3d* L) const {
    constexpr double kInPlane = 1e-12;  // m
    for (const Facet& facet : facets_) {
      const Eigen::Vector3d from_corner = p - facet.corner;
      if (std::abs(facet.normal.dot(from_corner)) > kInPlane) continue;
      const Eigen::Vector2d L12 = facet.to_L * from_corner;
      *L = {1 - L12.sum(), L12(0), L12(1)};
      if (L->minCoeff() >= 0) return &facet;
    }
    return nullptr;
  }

  const Surface& surface_;
  const Eigen::Matrix3Xd& X_;
  std::vector<int> triangles_;
  std::map<int, int> number_;  // of each node
  std::vector<Facet> facets_;
  Eigen::MatrixXd sum_;  // per node: weight, slopes
};

}  // namespace

MovingPatch MovingPatchWeights(const Surface& surface, const Eigen::Matrix3Xd& X,
                               const SurfacePoint& centre, double diameter,
                               const Eigen::Matrix3Xd& directions) {
  assert(diameter >= 0);
  if (diameter == 0) {
    return {ShapeFunctions(surface, centre), ShapeFunctionSlopes(surface, X, centre, directions)};
  }
  const double radius = diameter / 2;
  const Eigen::Vector3d middle = Position(surface, X, centre);
  const Eigen::Vector3d normal = Normal(surface, X, centre);
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  // A point of the disc is at most one radius from the surface, hence what is closest to it is at
  // most two radii from the centre.
  const auto sheet = SheetAround(surface, X, centre.triangle, middle, normal, 2 * radius);

  Sheet disc(surface, X, sheet, directions);
  for (int ring = 0; ring < kRadii; ++ring) {
    const GaussPoint& gauss = kGauss[ring / 2];
    const double r = radius * std::sqrt((1 + (ring % 2 ? -gauss.at : gauss.at)) / 2);
    for (int i = 0; i < kAngles; ++i) {
      const double angle = 2 * kPi * (i + 0.5 * (ring % 2)) / kAngles;
      disc.Add(gauss.weight / 2 / kAngles,
               middle + r * (std::cos(angle) * u + std::sin(angle) * v));
    }
  }
  return disc.Sum();
}

NodalWeights PatchWeights(const Surface& surface, const Eigen::Matrix3Xd& X,
                          const SurfacePoint& centre, double diameter) {
  return MovingPatchWeights(surface, X, centre, diameter, Eigen::Matrix3Xd(3, 0)).weights;
}

}  // namespace softforce::mesh
