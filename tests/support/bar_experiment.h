#pragma once

#include <random>
#include <vector>

#include "softforce/estimation/force_estimator.h"
#include "support/soft_bodies.h"

namespace softforce::testing {

// A bar held at one end, loaded by forces of known place, and seen at points along it. The truth is
// made by the same discretisation: these experiments check the estimator, not the model.
struct BarExperiment {
  fem::Body body = MakeBar();
  std::vector<mesh::NodalWeights> points;
  std::vector<estimation::ForceSite> sites;

  BarExperiment() {
    for (const double x : {0.03, 0.05, 0.07, 0.09}) {
      points.push_back(PointOf(body, {x, 0.0, 0.005}));
      points.push_back(PointOf(body, {x, 0.005, 0.01}));
    }
    // Across the bar only: along it a bar is so stiff that hardly anything can be seen.
    sites.push_back(
        {"tip", PointOf(body, {0.1, 0.005, 0.005}), Eigen::Matrix3d::Identity().rightCols(2)});
  }

  // The bar's answer to an intensity per component of the sites.
  fem::Equilibrium Load(const Eigen::VectorXd& intensity,
                        const fem::Actuation& actuation = {}) const {
    fem::StaticSolverOptions exact;
    exact.tolerance = 1e-10;
    fem::StaticSolver solver(body, "bar", exact);
    fem::Equilibrium state = solver.AtRest();
    fem::LoadCase load = state.load;
    load.actuation = actuation;
    int component = 0;
    for (const estimation::ForceSite& site : sites) {
      const Eigen::Vector3d force =
          site.directions * intensity.segment(component, site.directions.cols());
      load.forces += LoadAt(body, site.at, force).forces;
      component += static_cast<int>(site.directions.cols());
    }
    solver.Solve(load, &state);
    return state;
  }

  // All points seen with independent noise of the given standard deviation (m).
  std::vector<estimation::Observation> Observe(const fem::Equilibrium& state, double sigma,
                                               std::mt19937* random = nullptr) const {
    std::vector<estimation::Observation> observations;
    std::normal_distribution<double> noise(0, sigma);
    for (const mesh::NodalWeights& point : points) {
      estimation::Observation seen;
      seen.at = point;
      seen.position = point.Apply(body.mesh.nodes) + point.Apply(state.u);
      if (random != nullptr) {
        for (int i = 0; i < 3; ++i) seen.position(i) += noise(*random);
      }
      seen.whitening = Eigen::Matrix3d::Identity() / sigma;
      observations.push_back(seen);
    }
    return observations;
  }
};

// The estimator for a model without error.
inline estimation::EstimatorOptions ExactModel() {
  estimation::EstimatorOptions options;
  options.common_model_error = 0;
  options.local_model_error = 0;
  return options;
}

}  // namespace softforce::testing
