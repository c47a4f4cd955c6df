#include "softforce/mesh/spread_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace softforce::mesh {
namespace {

constexpr double kFiner = 4;    // samples to a spacing
constexpr int kMostParts = 40;  // into which the edge of a triangle is cut

struct Sample {
  SurfacePoint at;
  Eigen::Vector3d position;  // m
  // m, to the nearest point taken, or −∞ if it will not do.
  double apart = std::numeric_limits<double>::infinity();
};

// Cuts a triangle into k² that are alike, and adds their middles.
void AddSamples(const Surface& surface, const Eigen::Matrix3Xd& X, int triangle, int k,
                std::vector<Sample>* samples) {
  const auto add = [&](double a, double b) {
    Sample sample;
    sample.at = {triangle, Eigen::Vector3d(a, b, k - a - b) / k};
    sample.position = Position(surface, X, sample.at);
    samples->push_back(sample);
  };
  for (int a = 0; a < k; ++a) {
    for (int b = 0; a + b < k; ++b) {
      add(a + 1.0 / 3, b + 1.0 / 3);
      if (a + b + 1 < k) add(a + 2.0 / 3, b + 2.0 / 3);
    }
  }
}

double LongestEdge(const Surface& surface, const Eigen::Matrix3Xd& X, int triangle) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    const int a = surface.triangles(i, triangle), b = surface.triangles((i + 1) % 3, triangle);
    longest = std::max(longest, (X.col(a) - X.col(b)).norm());
  }
  return longest;
}

// The nearest to the middle of all: where to begin.
size_t Innermost(const std::vector<Sample>& samples) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Sample& sample : samples) middle += sample.position;
  middle /= static_cast<double>(samples.size());
  size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < samples.size(); ++i) {
    const double distance = (samples[i].position - middle).norm();
    if (samples[i].apart < 0 || distance >= least) continue;
    least = distance;
    best = i;
  }
  return best;
}

}  // namespace

// Farthest-point sampling: the next point is the one furthest from those before it.
std::vector<SurfacePoint> SpreadPoints(const Surface& surface, const Eigen::Matrix3Xd& X,
                                       const std::vector<int>& triangles, double spacing,
                                       const std::function<bool(const SurfacePoint&)>& suitable) {
  assert(spacing > 0);
  std::vector<Sample> samples;
  for (const int t : triangles) {
    const double parts = std::ceil(LongestEdge(surface, X, t) / (spacing / kFiner));
    AddSamples(surface, X, t, static_cast<int>(std::clamp<double>(parts, 1, kMostParts)), &samples);
  }
  std::vector<SurfacePoint> points;
  const auto nearer = [](const Sample& a, const Sample& b) { return a.apart < b.apart; };
  while (!samples.empty()) {
    Sample& next = points.empty() ? samples[Innermost(samples)]
                                  : *std::max_element(samples.begin(), samples.end(), nearer);
    if (next.apart < spacing) break;
    if (!suitable(next.at)) {
      next.apart = -std::numeric_limits<double>::infinity();
      continue;
    }
    points.push_back(next.at);
    const Eigen::Vector3d taken = next.position;
    for (Sample& sample : samples) {
      sample.apart = std::min(sample.apart, (sample.position - taken).norm());
    }
  }
  return points;
}

}  // namespace softforce::mesh
