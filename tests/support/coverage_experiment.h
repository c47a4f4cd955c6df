#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "softforce/estimation/force_estimator.h"
#include "support/soft_bodies.h"

namespace softforce::testing {

// What is uncertain in a trial, and modelled as such. Standard deviations.
struct Uncertain {
  double noise = 1e-4;         // m, of each measured coordinate; three times that in depth (y)
  double one_camera = 0;       // share of the points that only one camera sees, along y
  double shift = 0, turn = 0;  // m, rad: of the rig's place
  double tension = 0;          // N, of the cable's tension
};

// A silicone finger of 100 × 20 × 10 mm, held at its foot, with a cable along its upper side and
// forces on two patches of it, seen at ten points. It is estimated on one mesh, and the truth is
// made on a finer one of other proportions; both are fine enough for the difference between them to
// be small beside the noise.
class CoverageExperiment {
 public:
  explicit CoverageExperiment(const Uncertain& uncertain)
      : uncertain_(uncertain),
        finger_(MakeFinger({16, 3, 2})),
        truth_(MakeFinger({24, 5, 3})),
        solver_(finger_.body, "finger"),
        truth_solver_(truth_.body, "truth"),
        estimator_(&solver_, finger_.sites, ExactModel(), {uncertain.tension}) {
    geometry::Matrix6d registration = geometry::Matrix6d::Zero();
    registration.diagonal().head<3>().setConstant(uncertain.shift * uncertain.shift);
    registration.diagonal().tail<3>().setConstant(uncertain.turn * uncertain.turn);
    estimator_.SetRegistrationCovariance(registration);
  }

  struct Tally {
    int intervals = 0, covered = 0;  // 95 % intervals of single components
    double normalised = 0;           // mean of errorᵀ Σ⁻¹ error / components
    double mean_sd = 0;              // N
    int lost = 0;                    // frames without an estimate
  };

  // `trials` draws of the noise, with a new load for every `per_load` of them.
  Tally Run(int trials, int per_load, std::mt19937* random) {
    Tally tally;
    Eigen::VectorXd force;
    fem::Equilibrium state = truth_solver_.AtRest();
    int done = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const double tension_error = uncertain_.tension * Draw(random);
      // The truth of an uncertain tension differs in every trial.
      if (trial % per_load == 0) force = kForce * DrawMany(estimator_.num_components(), random);
      if (trial % per_load == 0 || uncertain_.tension > 0) {
        Solve(force, kTension + tension_error, &state);
      }
      const estimation::ForceEstimate estimate = estimator_.Estimate(
          Observe(state, random), {{{fem::CableInput::kTension, kTension}}, {}});
      if (!estimate.ok()) {
        ++tally.lost;
        continue;
      }
      ++done;
      const Eigen::VectorXd error = estimate.intensity - force;
      for (int i = 0; i < error.size(); ++i) {
        const double sd = std::sqrt(estimate.covariance(i, i));
        ++tally.intervals;
        if (std::abs(error(i)) <= 1.959964 * sd) ++tally.covered;
        tally.mean_sd += sd / static_cast<double>(error.size());
      }
      tally.normalised +=
          error.dot(estimate.covariance.ldlt().solve(error)) / static_cast<double>(error.size());
    }
    tally.normalised /= done;
    tally.mean_sd /= done;
    return tally;
  }

 private:
  static constexpr double kTension = 0.1;  // N
  static constexpr double kForce = 8e-3;   // N, moves the tip by 1.6 mm

  struct Finger {
    fem::Body body;
    std::vector<estimation::ForceSite> sites;
    std::vector<mesh::NodalWeights> points;
  };

  static estimation::EstimatorOptions ExactModel() {
    estimation::EstimatorOptions options;
    options.common_model_error = 0;
    options.local_model_error = 0;
    return options;
  }

  static Finger MakeFinger(const std::array<int, 3>& bricks) {
    Finger finger;
    fem::Body& body = finger.body;
    body.mesh = mesh::RaiseOrder(MakeBox(bricks[0], bricks[1], bricks[2], {0.1, 0.02, 0.01}));
    body.materials = {{fem::MaterialModel::kNeoHookean, 1e6, 0.45}};
    for (int node = 0; node < body.mesh.num_nodes(); ++node) {
      if (body.mesh.nodes(0, node) < 1e-9) body.fixed_nodes.push_back(node);
    }
    const mesh::Surface surface = mesh::ExtractSurface(body.mesh);
    const auto patch = [&](const Eigen::Vector3d& place) {
      const mesh::SurfaceProjection on = mesh::ClosestSurfacePoint(surface, body.mesh.nodes, place);
      return mesh::PatchWeights(surface, body.mesh.nodes, on.at, 8e-3);
    };
    body.cables.push_back({"upper", {patch({0.07, 0.01, 0.01})}, {-0.02, 0.01, 0.03}});
    finger.sites.push_back(
        {"tip", patch({0.09, 0.01, 0.0}), Eigen::Matrix3d::Identity().rightCols(2)});
    finger.sites.push_back({"middle", patch({0.05, 0.01, 0.0}), Eigen::Vector3d::UnitZ()});
    for (const double x : {0.02, 0.04, 0.06, 0.08, 0.098}) {
      for (const double y : {0.003, 0.017}) {
        finger.points.push_back(PointOf(body, {x, y, 0.01}));
      }
    }
    return finger;
  }

  double Draw(std::mt19937* random) { return normal_(*random); }
  Eigen::VectorXd DrawMany(int n, std::mt19937* random) {
    return Eigen::VectorXd::NullaryExpr(n, [&] { return Draw(random); });
  }

  void Solve(const Eigen::VectorXd& force, double tension, fem::Equilibrium* state) {
    fem::LoadCase load = fem::OwnWeight(truth_.body);
    int component = 0;
    for (const estimation::ForceSite& site : truth_.sites) {
      const auto directions = site.directions.cols();
      const Eigen::Vector3d at_site = site.directions * force.segment(component, directions);
      load.forces += LoadAt(truth_.body, site.at, at_site).forces;
      component += static_cast<int>(directions);
    }
    load.actuation.cables = {{fem::CableInput::kTension, std::max(0.0, tension)}};
    truth_solver_.Solve(load, state);
  }

  std::vector<estimation::Observation> Observe(const fem::Equilibrium& state,
                                               std::mt19937* random) {
    const Eigen::Vector3d sd(uncertain_.noise, 3 * uncertain_.noise, uncertain_.noise);
    const Eigen::Vector3d shift = uncertain_.shift * DrawMany(3, random);
    const Eigen::Vector3d turn = uncertain_.turn * DrawMany(3, random);
    std::uniform_real_distribution<double> uniform;
    std::vector<estimation::Observation> observations;
    for (size_t p = 0; p < finger_.points.size(); ++p) {
      const Eigen::Vector3d x =
          truth_.points[p].Apply(truth_.body.mesh.nodes) + truth_.points[p].Apply(state.u);
      estimation::Observation seen;
      seen.at = finger_.points[p];
      seen.position = x + shift + turn.cross(x) + sd.cwiseProduct(DrawMany(3, random));
      seen.whitening = sd.cwiseInverse().asDiagonal();
      if (uniform(*random) < uncertain_.one_camera) {
        const Eigen::Matrix3d all = seen.whitening;
        seen.whitening = all({0, 2}, Eigen::all);
        seen.position.y() += 0.02;  // m: not measured
      }
      observations.push_back(seen);
    }
    return observations;
  }

  Uncertain uncertain_;
  Finger finger_, truth_;
  fem::StaticSolver solver_, truth_solver_;
  estimation::ForceEstimator estimator_;
  std::normal_distribution<double> normal_;
};

struct CoverageCase {
  std::string name;
  Uncertain uncertain;
};

inline std::vector<CoverageCase> CoverageCases() {
  return {{"noise of 0.1 mm", {1e-4, 0, 0, 0, 0}},
          {"a third of the points seen by one camera", {1e-4, 1.0 / 3, 0, 0, 0}},
          {"rig's place uncertain by 0.2 mm and 2 mrad", {1e-4, 0, 2e-4, 2e-3, 0}},
          {"tension uncertain by 0.05 N", {1e-4, 0, 0, 0, 0.05}},
          {"all of these", {1e-4, 1.0 / 3, 2e-4, 2e-3, 0.05}}};
}

}  // namespace softforce::testing
