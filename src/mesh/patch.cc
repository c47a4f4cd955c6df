#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <set>

#include "mesh/closest_triangle.h"
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

}  // namespace

NodalWeights PatchWeights(const Surface& surface, const Eigen::Matrix3Xd& X,
                          const SurfacePoint& centre, double diameter) {
  assert(diameter >= 0);
  if (diameter == 0) return ShapeFunctions(surface, centre);

  const double radius = diameter / 2;
  const Eigen::Vector3d middle = Position(surface, X, centre);
  const Eigen::Vector3d normal = Normal(surface, X, centre);
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  // A point of the disc is at most one radius from the surface, hence what is closest to it is at
  // most two radii from the centre.
  const auto sheet = SheetAround(surface, X, centre.triangle, middle, normal, 2 * radius);

  std::map<int, double> sum;
  for (int ring = 0; ring < kRadii; ++ring) {
    const GaussPoint& gauss = kGauss[ring / 2];
    const double r = radius * std::sqrt((1 + (ring % 2 ? -gauss.at : gauss.at)) / 2);
    for (int i = 0; i < kAngles; ++i) {
      const double angle = 2 * kPi * (i + 0.5 * (ring % 2)) / kAngles;
      const Eigen::Vector3d p = middle + r * (std::cos(angle) * u + std::sin(angle) * v);
      const NodalWeights there = ShapeFunctions(surface, ClosestAmong(sheet, surface, X, p).at);
      for (std::size_t k = 0; k < there.nodes.size(); ++k) {
        sum[there.nodes[k]] += gauss.weight / 2 / kAngles * there.weights[k];
      }
    }
  }

  NodalWeights result;
  for (const auto& [node, weight] : sum) {
    result.nodes.push_back(node);
    result.weights.push_back(weight);
  }
  return result;
}

}  // namespace softforce::mesh
