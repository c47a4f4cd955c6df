#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "softforce/estimation/location_estimator.h"
#include "support/soft_bodies.h"

namespace softforce::testing {

struct Press {
  Eigen::Vector3d place;  // m, of the body at rest
  Eigen::Vector3d force;  // N
};

// A silicone sheet of 100 × 100 × 8 mm, held along two of its sides, pressed from below (z = 0) and
// seen by sixteen markers on top. Forces are looked for near nine candidates on a grid. Two meshes
// of other proportions: truths are made on the one, estimates on the other.
class PressedSheet {
 public:
  explicit PressedSheet(int cells)
      : body_(MakeSheet(cells)),
        surface_(mesh::ExtractSurface(body_.mesh)),
        solver_(body_, "sheet") {}

  static constexpr double kPatch = 6e-3;  // m
  static constexpr int kCandidates = 9;

  static Eigen::Vector3d CandidatePlace(int c) {
    return {0.025 + 0.025 * (c % 3), 0.025 + 0.025 * (c / 3), 0};
  }

  std::vector<estimation::LocationCandidate> Candidates(
      estimation::ForceDirection direction = estimation::ForceDirection::kFree) const {
    std::vector<estimation::LocationCandidate> candidates;
    for (int c = 0; c < kCandidates; ++c) {
      candidates.push_back({std::to_string(c), At(CandidatePlace(c)), direction});
    }
    return candidates;
  }

  estimation::LocationEstimator Estimator(
      const estimation::LocationOptions& options,
      estimation::ForceDirection direction = estimation::ForceDirection::kFree) {
    return Estimator(options, Candidates(direction));
  }

  estimation::LocationEstimator Estimator(
      const estimation::LocationOptions& options,
      const std::vector<estimation::LocationCandidate>& candidates) {
    return {&solver_, surface_, candidates, options};
  }

  static estimation::LocationOptions Options(
      estimation::LocationMethod method = estimation::LocationMethod::kContinuous) {
    estimation::LocationOptions options;
    options.method = method;
    options.patch = kPatch;
    return options;
  }

  // Where the markers are under given forces, m.
  std::vector<Eigen::Vector3d> Seen(const std::vector<Press>& presses) {
    fem::LoadCase load = fem::OwnWeight(body_);
    for (const Press& press : presses) {
      const mesh::NodalWeights at =
          mesh::PatchWeights(surface_, body_.mesh.nodes, At(press.place), kPatch);
      load.forces += LoadAt(body_, at, press.force).forces;
    }
    fem::Equilibrium state = solver_.AtRest();
    solver_.Solve(load, &state);
    std::vector<Eigen::Vector3d> seen;
    for (const mesh::NodalWeights& marker : Markers()) {
      seen.push_back(marker.Apply(body_.mesh.nodes) + marker.Apply(state.u));
    }
    return seen;
  }

  // Markers seen there with noise of the given standard deviation (m) in each coordinate.
  std::vector<estimation::Observation> Observe(const std::vector<Eigen::Vector3d>& seen,
                                               double sigma, std::mt19937* random) const {
    std::normal_distribution<double> noise(0, sigma);
    std::vector<estimation::Observation> observations;
    const std::vector<mesh::NodalWeights> markers = Markers();
    for (size_t i = 0; i < markers.size(); ++i) {
      estimation::Observation observation;
      observation.at = markers[i];
      observation.position = seen[i];
      for (int axis = 0; axis < 3; ++axis) observation.position(axis) += noise(*random);
      observation.whitening = Eigen::Matrix3d::Identity() / sigma;
      observations.push_back(observation);
    }
    return observations;
  }

  const fem::Body& body() const { return body_; }

  mesh::SurfacePoint At(const Eigen::Vector3d& place) const {
    return mesh::ClosestSurfacePoint(surface_, body_.mesh.nodes, place).at;
  }

 private:
  static fem::Body MakeSheet(int cells) {
    fem::Body sheet;
    sheet.mesh = mesh::RaiseOrder(MakeBox(cells, cells, 2, {0.1, 0.1, 0.008}));
    sheet.materials = {Silicone()};
    for (int node = 0; node < sheet.mesh.num_nodes(); ++node) {
      const double x = sheet.mesh.nodes(0, node);
      if (x < 1e-9 || x > 0.1 - 1e-9) sheet.fixed_nodes.push_back(node);
    }
    return sheet;
  }

  std::vector<mesh::NodalWeights> Markers() const {
    std::vector<mesh::NodalWeights> markers;
    for (int i = 0; i < 16; ++i) {
      const Eigen::Vector3d place(0.02 + 0.02 * (i % 4), 0.02 + 0.02 * (i / 4), 0.008);
      markers.push_back(mesh::ShapeFunctions(surface_, At(place)));
    }
    return markers;
  }

  fem::Body body_;
  mesh::Surface surface_;
  fem::StaticSolver solver_;
};

}  // namespace softforce::testing
