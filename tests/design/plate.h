#pragma once

#include <memory>
#include <vector>

#include "softforce/design/expected_errors.h"
#include "softforce/design/influence.h"
#include "support/box_mesh.h"

namespace softforce::testing {

// A plate of 100 × 60 × 8 mm, held at its face x = 0, markers on its top and loads under it.
class Plate {
 public:
  static constexpr double kPatch = 6e-3;  // m
  static constexpr double kNoise = 1e-4;  // m

  Plate() {
    body.mesh = mesh::RaiseOrder(MakeBox(10, 6, 1, {0.1, 0.06, 0.008}));
    body.materials = {{fem::MaterialModel::kNeoHookean, 300e3, 0.45}};
    for (int n = 0; n < body.mesh.num_nodes(); ++n) {
      if (body.mesh.nodes(0, n) < 1e-9) body.fixed_nodes.push_back(n);
    }
    surface = mesh::ExtractSurface(body.mesh);
    solver = std::make_unique<fem::StaticSolver>(body, "plate");
    for (const double x : {12e-3, 37e-3, 62e-3, 87e-3}) {
      for (const double y : {11e-3, 29e-3, 48e-3}) loads.push_back(LoadAt({x, y, 0}));
    }
    for (const double x : {5e-3, 20e-3, 35e-3, 50e-3, 65e-3, 80e-3, 95e-3}) {
      for (const double y : {5e-3, 17e-3, 30e-3, 43e-3, 55e-3}) AddPlace({x, y, 8e-3});
    }
    model.location_sd = 0.03;
  }

  void AddPlace(const Eigen::Vector3d& place) {
    points.push_back(mesh::ShapeFunctions(surface, At(place)));
    sights.push_back({place, Eigen::Matrix3d::Identity() / (kNoise * kNoise)});
  }

  design::PlacedLoad LoadAt(const Eigen::Vector3d& place) const {
    const design::SampledLoad load{At(place), Eigen::Matrix3d::Identity(), {0, 0, 0.4}};
    return {surface, body.mesh.nodes, load, kPatch};
  }

  mesh::SurfacePoint At(const Eigen::Vector3d& place) const {
    return mesh::ClosestSurfacePoint(surface, body.mesh.nodes, place).at;
  }

  design::ExpectedErrors Errors() {
    return {design::ComputeInfluence(solver.get(), solver->AtRest(), points, loads), loads, sights,
            model};
  }

  fem::Body body;
  mesh::Surface surface;
  std::unique_ptr<fem::StaticSolver> solver;
  std::vector<design::PlacedLoad> loads;
  std::vector<mesh::NodalWeights> points;
  std::vector<design::MarkerSight> sights;
  design::ErrorModel model;
};

}  // namespace softforce::testing
