#include "softforce/validation/discretisation.h"

#include <array>
#include <map>
#include <utility>

#include "softforce/base/input_error.h"
#include "softforce/mesh/generate_mesh.h"
#include "softforce/mesh/refine.h"

namespace softforce::validation {
namespace {

// m, edges of the inverse models' cells before the refinement at edges.
constexpr double kSheetSize = 5e-3;
constexpr double kRobotSize = 4.2e-3;
constexpr double kMetresPerUnit = 1e-3;
// Sine of the angle by which a face rises above the plane of its neighbour at a re-entrant edge.
constexpr double kReentrant = 0.3;

// Corners of the surface where what is held ends.
void MarkEndsOfSupport(const Model& model, const std::vector<char>& held, std::vector<char>* hot) {
  const Eigen::MatrixXi& triangles = model.surface.triangles;
  for (int t = 0; t < model.surface.num_triangles(); ++t) {
    int count = 0;
    for (int k = 0; k < 3; ++k) count += held[triangles(k, t)];
    if (count == 0 || count == 3) continue;
    for (int k = 0; k < 3; ++k) {
      if (held[triangles(k, t)]) (*hot)[triangles(k, t)] = 1;
    }
  }
}

void MarkReentrantEdges(const Model& model, std::vector<char>* hot) {
  const Eigen::MatrixXi& triangles = model.surface.triangles;
  const auto X = [&](int node) -> Eigen::Vector3d { return model.body.mesh.nodes.col(node); };
  std::map<std::pair<int, int>, int> triangle_at;  // of each directed edge
  for (int t = 0; t < model.surface.num_triangles(); ++t) {
    for (int k = 0; k < 3; ++k) triangle_at[{triangles(k, t), triangles((k + 1) % 3, t)}] = t;
  }
  for (const auto& [edge, t] : triangle_at) {
    const auto beside = triangle_at.find({edge.second, edge.first});
    if (beside == triangle_at.end()) continue;
    const Eigen::Vector3d normal = (X(triangles(1, t)) - X(triangles(0, t)))
                                       .cross(X(triangles(2, t)) - X(triangles(0, t)))
                                       .normalized();
    for (int k = 0; k < 3; ++k) {
      const int node = triangles(k, beside->second);
      if (node == edge.first || node == edge.second) continue;
      const double rise = normal.dot((X(node) - X(edge.first)).normalized());
      if (rise > kReentrant) (*hot)[edge.first] = (*hot)[edge.second] = 1;
    }
  }
}

// The clamps' upright edges within the sheet.
void MarkInnerEdges(const Model& model, const std::vector<char>& held, std::vector<char>* hot) {
  const Eigen::Matrix3Xd& X = model.body.mesh.nodes;
  const Eigen::Vector3d middle = 0.5 * (X.rowwise().minCoeff() + X.rowwise().maxCoeff());
  std::array<double, 2> nearest{INFINITY, INFINITY};  // m, of held nodes to the middle, x and y
  for (int node = 0; node < X.cols(); ++node) {
    for (int axis = 0; axis < 2 && held[node]; ++axis) {
      nearest[axis] = std::min(nearest[axis], std::abs(X(axis, node) - middle(axis)));
    }
  }
  constexpr double kRounding = 1e-9;  // m
  for (int node = 0; node < X.cols(); ++node) {
    bool both = held[node];
    for (int axis = 0; axis < 2; ++axis) {
      both = both && std::abs(X(axis, node) - middle(axis)) < nearest[axis] + kRounding;
    }
    if (both) (*hot)[node] = 1;
  }
}

}  // namespace

mesh::TetMesh RefineAtEdges(BodyKind body, const mesh::TetMesh& mesh) {
  const Model model = MakeModel(body, mesh, kYoungsModulus);
  std::vector<char> held(mesh.num_nodes(), 0), hot(mesh.num_nodes(), 0);
  for (const int node : model.body.fixed_nodes) held[node] = 1;
  MarkEndsOfSupport(model, held, &hot);
  MarkReentrantEdges(model, &hot);
  if (body == BodyKind::kSheet) MarkInnerEdges(model, held, &hot);

  std::vector<char> marked(mesh.num_elements(), 0);
  for (int e = 0; e < mesh.num_elements(); ++e) {
    bool touches = false, all_held = true;
    for (int k = 0; k < 4; ++k) {
      touches = touches || hot[mesh.elements(k, e)];
      all_held = all_held && held[mesh.elements(k, e)];
    }
    marked[e] = touches && !all_held;
  }
  return mesh::RefineWhere(mesh, marked).mesh;
}

Discretisations MakeDiscretisations(BodyKind body, const std::filesystem::path& meshes) {
  const mesh::TetMesh given = ReadBodyMesh(body, meshes);
  mesh::GenerateOptions options;
  options.size = body == BodyKind::kSheet ? kSheetSize : kRobotSize;
  const std::filesystem::path script = meshes / (std::string(Name(body)) + ".geo");
  const mesh::TetMesh finer = mesh::GenerateMesh(script, kMetresPerUnit, options).mesh;
  const mesh::TetMesh truth = RefineAtEdges(body, mesh::Refine(given).mesh);
  return {mesh::RaiseOrder(given), mesh::RaiseOrder(RefineAtEdges(body, finer)),
          mesh::RaiseOrder(truth)};
}

}  // namespace softforce::validation
