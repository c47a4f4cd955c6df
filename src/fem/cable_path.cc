#include "fem/cable_path.h"

#include <algorithm>

namespace softforce::fem {
namespace {

// A straight piece of cable from one point of the body to the next, or to the guide.
struct Segment {
  const mesh::NodalWeights* from;
  const mesh::NodalWeights* to;  // null: the guide
  Eigen::Vector3d along;         // m, from start to end
};

std::vector<Segment> Segments(const Cable& cable, const Eigen::Matrix3Xd& x) {
  std::vector<Segment> segments;
  for (size_t p = 0; p < cable.points.size(); ++p) {
    const bool last = p + 1 == cable.points.size();
    const Eigen::Vector3d end = last ? cable.guide : cable.points[p + 1].Apply(x);
    segments.push_back(
        {&cable.points[p], last ? nullptr : &cable.points[p + 1], end - cable.points[p].Apply(x)});
  }
  return segments;
}

}  // namespace

std::vector<int> CableNodes(const Cable& cable) {
  std::vector<int> nodes;
  for (const mesh::NodalWeights& point : cable.points) {
    nodes.insert(nodes.end(), point.nodes.begin(), point.nodes.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

double CableLength(const Cable& cable, const Eigen::Matrix3Xd& x) {
  double length = 0;
  for (const Segment& segment : Segments(cable, x)) length += segment.along.norm();
  return length;
}

void AddCableGradient(const Cable& cable, const Eigen::Matrix3Xd& x, double scale,
                      Eigen::Matrix3Xd* field) {
  for (const Segment& segment : Segments(cable, x)) {
    const Eigen::Vector3d direction = scale * segment.along.normalized();
    for (size_t i = 0; i < segment.from->nodes.size(); ++i) {
      field->col(segment.from->nodes[i]) -= segment.from->weights[i] * direction;
    }
    if (segment.to == nullptr) continue;
    for (size_t i = 0; i < segment.to->nodes.size(); ++i) {
      field->col(segment.to->nodes[i]) += segment.to->weights[i] * direction;
    }
  }
}

void ForEachCableStiffness(const Cable& cable, const Eigen::Matrix3Xd& x, double tension,
                           const std::function<void(int, int, const Eigen::Matrix3d&)>& add) {
  for (const Segment& segment : Segments(cable, x)) {
    // A segment resists being turned: tension / length across its direction.
    const double length = segment.along.norm();
    const Eigen::Vector3d d = segment.along / length;
    const Eigen::Matrix3d across =
        tension / length * (Eigen::Matrix3d::Identity() - d * d.transpose());
    const auto add_pairs = [&](const mesh::NodalWeights& a, const mesh::NodalWeights& b,
                               double sign) {
      for (size_t i = 0; i < a.nodes.size(); ++i) {
        for (size_t j = 0; j < b.nodes.size(); ++j) {
          add(a.nodes[i], b.nodes[j], sign * a.weights[i] * b.weights[j] * across);
        }
      }
    };
    add_pairs(*segment.from, *segment.from, 1);
    if (segment.to == nullptr) continue;
    add_pairs(*segment.to, *segment.to, 1);
    add_pairs(*segment.from, *segment.to, -1);
    add_pairs(*segment.to, *segment.from, -1);
  }
}

}  // namespace softforce::fem
