#include "pipeline/body_views.h"

#include <fmt/format.h>

#include <algorithm>

namespace softforce::pipeline {
namespace {

constexpr int kFineNodes = 20000;  // beyond, curved triangles are shown by their corners alone

using Triangles = std::vector<Eigen::Vector3i>;

// Flat triangles over the nodes of the mesh; curved ones are cut in four.
Triangles FlatTriangles(const mesh::Surface& surface) {
  const Eigen::MatrixXi& t = surface.triangles;
  const bool cut = surface.order() == 2 && 2 * t.cols() <= kFineNodes;  // two nodes per triangle
  Triangles flat;
  for (Eigen::Index i = 0; i < t.cols(); ++i) {
    if (!cut) {
      flat.emplace_back(t(0, i), t(1, i), t(2, i));
      continue;
    }
    flat.emplace_back(t(0, i), t(3, i), t(5, i));
    flat.emplace_back(t(3, i), t(1, i), t(4, i));
    flat.emplace_back(t(5, i), t(4, i), t(2, i));
    flat.emplace_back(t(3, i), t(4, i), t(5, i));
  }
  return flat;
}

}  // namespace

BodyViews::BodyViews(const World& world) : world_(world) {
  const Triangles triangles = FlatTriangles(world.surface);
  const Eigen::Matrix3Xd& X = world.mesh().nodes;
  std::vector<int> place(static_cast<size_t>(X.cols()), -1);  // of each node among nodes_
  shape_.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      int& node = place[static_cast<size_t>(triangles[t](k))];
      if (node < 0) {
        node = static_cast<int>(nodes_.size());
        nodes_.push_back(triangles[t](k));
      }
      shape_.triangles(k, static_cast<Eigen::Index>(t)) = node;
    }
  }
  shape_.nodes = X(Eigen::all, nodes_).cast<float>();
}

report::BodyView BodyViews::ViewOf(const FrameInWork& frame) const {
  report::BodyView view;
  const FrameResult& result = frame.result;
  view.frame = result.frame;
  view.time_s = result.time_s;
  view.u = frame.u(Eigen::all, nodes_).cast<float>();
  for (const ForceResult& force : result.forces) {
    view.forces.push_back({ForceName(force), force.position.cast<float>(),
                           force.force.cast<float>(), static_cast<float>(force.NormSd())});
  }
  for (const MarkerResult& marker : result.markers) {
    const Eigen::Vector3d& p = marker.measured.allFinite() ? marker.measured : marker.model;
    if (!p.allFinite()) continue;
    view.markers.push_back({marker.id, static_cast<int>(marker.status), p.cast<float>()});
  }
  const Eigen::Matrix3Xd x = world_.mesh().nodes + frame.u;
  for (const fem::Cable& cable : world_.solver->body().cables) {
    view.cables.emplace_back();
    for (const mesh::NodalWeights& point : cable.points) {
      view.cables.back().push_back(point.Apply(x).cast<float>());
    }
    view.cables.back().push_back(cable.guide.cast<float>());
  }
  return view;
}

std::string ForceName(const ForceResult& force) { return fmt::format("F{}", force.identity); }

std::vector<std::string> MarkerStatusNames() {
  std::vector<std::string> names;
  for (const MarkerStatus status : {MarkerStatus::kSeen, MarkerStatus::kOneCamera,
                                    MarkerStatus::kHidden, MarkerStatus::kRejected}) {
    std::string name = Name(status);
    std::replace(name.begin(), name.end(), '_', ' ');
    names.push_back(name);
  }
  return names;
}

}  // namespace softforce::pipeline
