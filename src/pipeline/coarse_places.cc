#include "pipeline/coarse_places.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "softforce/mesh/disjoint_sets.h"

namespace softforce::pipeline {
namespace {

constexpr double kReportedShare = 0.8;  // of the bias lies in the cells that are reported
constexpr double kSmallestPlace = 0.01;
constexpr double kLeft = 0.1;  // of the error, with the wanted size

Eigen::Vector3d Centre(const mesh::TetMesh& mesh, int e) {
  return (mesh.nodes.col(mesh.elements(0, e)) + mesh.nodes.col(mesh.elements(1, e)) +
          mesh.nodes.col(mesh.elements(2, e)) + mesh.nodes.col(mesh.elements(3, e))) /
         4;
}

double MeanEdge(const mesh::TetMesh& mesh, int e) {
  double sum = 0;
  for (const auto& [a, b] : mesh::kEdges) {
    sum += (mesh.nodes.col(mesh.elements(a, e)) - mesh.nodes.col(mesh.elements(b, e))).norm();
  }
  return sum / 6;
}

// Cells with the largest shares, grouped by common corners.
std::vector<std::vector<int>> Groups(const mesh::TetMesh& mesh, const Eigen::VectorXd& share) {
  std::vector<int> order(mesh.num_elements());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return share(a) > share(b); });
  std::vector<int> chosen;
  double sum = 0;
  for (const int e : order) {
    if (sum >= kReportedShare) break;
    chosen.push_back(e);
    sum += share(e);
  }
  mesh::DisjointSets joined(mesh.num_nodes());
  for (const int e : chosen) {
    for (int i = 1; i < 4; ++i) joined.Join(mesh.elements(0, e), mesh.elements(i, e));
  }
  const std::vector<int> set = joined.Numbers();
  std::map<int, std::vector<int>> groups;
  for (const int e : chosen) groups[set[mesh.elements(0, e)]].push_back(e);
  std::vector<std::vector<int>> list;
  list.reserve(groups.size());
  for (auto& [number, cells] : groups) list.push_back(std::move(cells));
  return list;
}

}  // namespace

std::vector<CoarsePlace> CoarsePlaces(const mesh::TetMesh& mesh, const Eigen::VectorXd& share,
                                      double left_after_halving) {
  const double p = -std::log2(left_after_halving);  // the error falls with size^p
  std::vector<CoarsePlace> places;
  for (const std::vector<int>& cells : Groups(mesh, share)) {
    CoarsePlace place{Eigen::Vector3d::Zero(), 0, 0, 0, 0};
    std::vector<double> sizes;
    for (const int e : cells) {
      place.share += share(e);
      place.centre += share(e) * Centre(mesh, e);
      sizes.push_back(MeanEdge(mesh, e));
    }
    if (place.share < kSmallestPlace) continue;
    place.centre /= place.share;
    for (const int e : cells) {
      place.radius += share(e) * (Centre(mesh, e) - place.centre).squaredNorm();
    }
    place.radius = std::sqrt(2 * place.radius / place.share);
    std::nth_element(sizes.begin(), sizes.begin() + sizes.size() / 2, sizes.end());
    place.size = sizes[sizes.size() / 2];
    place.wanted_size = place.size * std::pow(kLeft, 1 / p);
    places.push_back(place);
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const auto& a, const auto& b) { return a.share > b.share; });
  return places;
}

}  // namespace softforce::pipeline
