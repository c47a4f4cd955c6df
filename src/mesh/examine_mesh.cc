#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "mesh/connectivity.h"
#include "mesh/jacobian.h"
#include "mesh/mesh_warnings.h"
#include "mesh/overlap.h"
#include "mesh/point_grid.h"
#include "mesh/tetrahedron.h"
#include "mesh/thickness.h"
#include "softforce/mesh/mesh_report.h"
#include "softforce/mesh/surface.h"

namespace softforce::mesh {
namespace {

Eigen::Matrix<double, 3, 4> CornersOf(const TetMesh& mesh, int e) {
  Eigen::Matrix<double, 3, 4> corners;
  for (int i = 0; i < 4; ++i) corners.col(i) = mesh.nodes.col(mesh.elements(i, e));
  return corners;
}

// The value that a share of all values is below.
double Quantile(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void ExamineRegions(const TetMesh& mesh, MeshReport& report) {
  for (const std::string& name : mesh.region_names) report.regions.push_back({name, 0, 0});
  for (int e = 0; e < mesh.num_elements(); ++e) {
    RegionReport& region = report.regions[mesh.region[e]];
    const double volume = VolumeOf(CornersOf(mesh, e));
    ++region.elements;
    region.volume += volume;
    report.volume += volume;
  }
}

void ExamineShapes(const TetMesh& mesh, MeshReport& report) {
  std::vector<double> qualities;
  report.least_dihedral = INFINITY;
  report.least_quality.value = INFINITY;
  if (mesh.order() == 2) report.least_jacobian_ratio.value = INFINITY;
  for (int e = 0; e < mesh.num_elements(); ++e) {
    const auto corners = CornersOf(mesh, e);
    const TetrahedronShape shape = ShapeOf(corners);
    qualities.push_back(shape.quality);
    report.poor_elements += shape.quality < kPoorQuality;
    report.least_dihedral = std::min(report.least_dihedral, shape.least_dihedral);
    report.greatest_dihedral = std::max(report.greatest_dihedral, shape.greatest_dihedral);
    const Eigen::Vector3d centre = corners.rowwise().mean();
    if (shape.quality < report.least_quality.value) report.least_quality = {shape.quality, centre};
    if (mesh.order() == 1) continue;
    const JacobianRange range = JacobianRangeOf(mesh, e);
    const double ratio = range.least / range.greatest;
    if (ratio < report.least_jacobian_ratio.value) report.least_jacobian_ratio = {ratio, centre};
  }
  report.quality_1_percent = Quantile(qualities, 0.01);
  report.median_quality = Quantile(qualities, 0.5);
}

void ExamineEdges(const TetMesh& mesh, MeshReport& report) {
  std::vector<std::pair<int, int>> edges;
  for (int e = 0; e < mesh.num_elements(); ++e) {
    for (const auto& [a, b] : kEdges) {
      edges.push_back(std::minmax({mesh.elements(a, e), mesh.elements(b, e)}));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<double> lengths;
  for (const auto& [a, b] : edges) {
    lengths.push_back((mesh.nodes.col(a) - mesh.nodes.col(b)).norm());
  }
  report.least_edge = *std::min_element(lengths.begin(), lengths.end());
  report.greatest_edge = *std::max_element(lengths.begin(), lengths.end());
  report.median_edge = Quantile(lengths, 0.5);
}

int CountOf(DisjointSets& sets, const std::vector<char>& counts) {
  const std::vector<int> numbers = sets.Numbers();
  std::set<int> distinct;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (counts[i]) distinct.insert(numbers[i]);
  }
  return static_cast<int>(distinct.size());
}

void ExamineParts(const TetMesh& mesh, MeshReport& report) {
  DisjointSets by_nodes(mesh.num_nodes()), by_faces(mesh.num_elements());
  std::map<std::array<int, 3>, int> element_at;  // of each face, while it is the only one
  for (int e = 0; e < mesh.num_elements(); ++e) {
    for (int i = 1; i < mesh.elements.rows(); ++i) {
      by_nodes.Join(mesh.elements(0, e), mesh.elements(i, e));
    }
    for (int opposite = 0; opposite < 4; ++opposite) {
      std::array<int, 3> face{};
      for (int i = 0; i < 3; ++i) face[i] = mesh.elements(i + (i >= opposite), e);
      std::sort(face.begin(), face.end());
      const auto [other, is_new] = element_at.try_emplace(face, e);
      if (is_new) continue;
      by_faces.Join(e, other->second);
      element_at.erase(other);
    }
  }
  report.parts = CountOf(by_nodes, std::vector<char>(mesh.num_nodes(), true));
  report.parts_by_faces = CountOf(by_faces, std::vector<char>(mesh.num_elements(), true));
}

void FindCoincidentNodes(const TetMesh& mesh, MeshReport& report) {
  std::set<int> corners;
  for (const int node : mesh.elements.topRows(4).reshaped()) corners.insert(node);
  PointGrid grid(1e-6 * (report.high - report.low).norm());
  for (const int node : corners) {
    const Eigen::Vector3d p = mesh.nodes.col(node);
    if (grid.Find(p) < 0) {
      grid.Add(p);
    } else if (report.coincident_nodes++ == 0) {
      report.coincident_at = p;
    }
  }
}

using Corners = std::array<int, 3>;

// Triangles of the surface by their corners, with those corners turned to face outward.
std::map<Corners, Corners> OutwardTriangles(const Surface& surface) {
  std::map<Corners, Corners> outward;
  for (int t = 0; t < surface.num_triangles(); ++t) {
    const Corners corners{surface.triangles(0, t), surface.triangles(1, t),
                          surface.triangles(2, t)};
    outward[Sorted(corners)] = corners;
  }
  return outward;
}

SurfaceGroupReport ExamineGroup(const TetMesh& mesh, const std::map<Corners, Corners>& outward,
                                const std::string& name, const std::vector<Corners>& triangles) {
  SurfaceGroupReport group;
  group.name = name;
  group.triangles = static_cast<int>(triangles.size());
  std::map<std::pair<int, int>, int> edges;
  double volume = 0;
  for (const Corners& triangle : triangles) {
    const auto found = outward.find(Sorted(triangle));
    group.off_surface += found == outward.end();
    const Corners& corners = found == outward.end() ? triangle : found->second;
    Eigen::Matrix3d p;
    for (int i = 0; i < 3; ++i) {
      p.col(i) = mesh.nodes.col(corners[i]);
      ++edges[std::minmax({corners[i], corners[(i + 1) % 3]})];
    }
    const double area = (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).norm() / 2;
    group.area += area;
    group.centre += area * p.rowwise().mean();
    volume += p.determinant() / 6;
  }
  group.centre /= group.area;
  group.closed = group.off_surface == 0 && !edges.empty() &&
                 std::all_of(edges.begin(), edges.end(),
                             [](const auto& edge) { return edge.second % 2 == 0; });
  group.enclosed_volume = group.closed ? std::abs(volume) : 0;
  return group;
}

void ExamineSurface(const TetMesh& mesh, MeshReport& report) {
  const Surface surface = ExtractSurface(mesh);
  for (const double volume : EnclosedVolumes(surface, mesh.nodes, SurfaceParts(surface))) {
    report.cavities += volume < 0;
  }
  const auto outward = OutwardTriangles(surface);
  for (const auto& [name, triangles] : mesh.surface_groups) {
    report.groups.push_back(ExamineGroup(mesh, outward, name, triangles));
  }
  const Thickness thickness = MeasureThickness(mesh, surface);
  report.one_cell_thick = thickness.one_cell;
  report.two_cells_thick = thickness.two_cells;
  report.more_cells_thick = thickness.more_cells;
  report.thinnest = {thickness.thinnest, thickness.thinnest_at};
}

}  // namespace

MeshReport ExamineMesh(const TetMesh& mesh, double solid_volume) {
  MeshReport report;
  report.solid_volume = solid_volume;
  report.order = mesh.order();
  report.nodes = mesh.num_nodes();
  report.elements = mesh.num_elements();
  report.low = mesh.nodes.rowwise().minCoeff();
  report.high = mesh.nodes.rowwise().maxCoeff();
  ExamineRegions(mesh, report);
  ExamineShapes(mesh, report);
  ExamineEdges(mesh, report);
  ExamineParts(mesh, report);
  FindCoincidentNodes(mesh, report);
  ExamineSurface(mesh, report);
  const Overlap overlap = FindOverlap(mesh);
  report.overlapping_cells = overlap.cells;
  report.overlapping_at = overlap.at;
  report.warnings = WarningsOf(report);
  return report;
}

}  // namespace softforce::mesh
