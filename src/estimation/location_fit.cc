// Least squares over intensities and places, the body's response to nodal forces being linear.
#include "estimation/location_fit.h"

#include <ceres/ceres.h>

#include <array>
#include <cmath>
#include <utility>

#include "estimation/subset_search.h"
#include "estimation/surface_manifold.h"

namespace softforce::estimation {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kMaxIterations = 30;

class LocationCost : public ceres::CostFunction {
 public:
  LocationCost(const LinearisedPoints& points, const ForceFaces& faces,
               const std::vector<LocationCandidate>& candidates, std::vector<TrialForce> forces)
      : points_(points), faces_(faces), candidates_(candidates), forces_(std::move(forces)) {
    set_num_residuals(static_cast<int>(points.b.size()));
    for (const TrialForce& force : forces_) {
      mutable_parameter_block_sizes()->push_back(static_cast<int>(force.intensity.size()));
      mutable_parameter_block_sizes()->push_back(SurfaceManifold::kAmbient);
    }
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    std::vector<TrialForce> forces = forces_;
    for (size_t j = 0; j < forces.size(); ++j) {
      forces[j].intensity =
          Eigen::Map<const Eigen::VectorXd>(parameters[2 * j], forces[j].intensity.size());
      forces[j].at = Unpack(parameters[2 * j + 1]);
    }
    const LocationResidual at = estimation::Evaluate(points_, faces_, candidates_, forces);
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = at.residual;
    if (jacobians == nullptr) return true;
    for (size_t j = 0; j < forces.size(); ++j) {
      const Eigen::Index k = forces[j].intensity.size();
      if (jacobians[2 * j] != nullptr) {
        Eigen::Map<RowMajor>(jacobians[2 * j], num_residuals(), k) = at.J[j].leftCols(k);
      }
      if (jacobians[2 * j + 1] != nullptr) {
        Eigen::Map<RowMajor>(jacobians[2 * j + 1], num_residuals(), SurfaceManifold::kAmbient) =
            AmbientJacobian(at.J[j].rightCols<2>());
      }
    }
    return true;
  }

 private:
  const LinearisedPoints& points_;
  const ForceFaces& faces_;
  const std::vector<LocationCandidate>& candidates_;
  std::vector<TrialForce> forces_;
};

}  // namespace

ForceFaces::ForceFaces(const mesh::Surface& surface, const Eigen::Matrix3Xd& X, double patch,
                       double crease)
    : surface_(surface),
      X_(X),
      patches_(surface, X, patch),
      walk_(surface, X, mesh::SmoothFaces(surface, X, crease)) {}

PlacedPatch ForceFaces::Place(const mesh::SurfacePoint& at,
                              const LocationCandidate& candidate) const {
  PlacedPatch placed;
  placed.tangents = walk_.Tangents(at.triangle);
  placed.patch = patches_.At(at, placed.tangents);
  switch (candidate.direction) {
    case ForceDirection::kFree:
      placed.directions = Eigen::Matrix3d::Identity();
      break;
    case ForceDirection::kPush:
      placed.directions = -mesh::Normal(surface_, X_, at);
      break;
    case ForceDirection::kFixed:
      placed.directions = candidate.fixed;
      break;
  }
  return placed;
}

Eigen::MatrixXd LinearisedPoints::Of(const std::vector<int>& nodes,
                                     const Eigen::VectorXd& weights) const {
  Eigen::Matrix3Xd moved = Eigen::Matrix3Xd::Zero(3, response->cols());
  for (size_t i = 0; i < nodes.size(); ++i) {
    moved += weights(static_cast<Eigen::Index>(i)) * response->middleRows<3>(3 * nodes[i]);
  }
  return whitening * moved.transpose();
}

Eigen::MatrixXd LinearisedPoints::Of(const mesh::NodalWeights& weights) const {
  return Of(weights.nodes,
            Eigen::Map<const Eigen::VectorXd>(weights.weights.data(),
                                              static_cast<Eigen::Index>(weights.weights.size())));
}

LocationResidual Evaluate(const LinearisedPoints& points, const ForceFaces& faces,
                          const std::vector<LocationCandidate>& candidates,
                          const std::vector<TrialForce>& forces) {
  LocationResidual result;
  result.residual = -points.b;
  for (const TrialForce& force : forces) {
    const PlacedPatch placed = faces.Place(force.at, candidates[force.candidate]);
    const Eigen::Index k = force.intensity.size();
    Eigen::MatrixXd J(points.b.size(), k + 2);
    J.leftCols(k) = points.Of(placed.patch.weights) * placed.directions;
    const Eigen::Vector3d f = placed.directions * force.intensity;
    for (int axis = 0; axis < 2; ++axis) {
      J.col(k + axis) = points.Of(placed.patch.weights.nodes, placed.patch.slopes.col(axis)) * f;
    }
    result.residual += J.leftCols(k) * force.intensity;
    result.J.push_back(std::move(J));
  }
  return result;
}

double FitLocations(const LinearisedPoints& points, const ForceFaces& faces,
                    const std::vector<LocationCandidate>& candidates,
                    std::vector<TrialForce>* forces) {
  if (forces->empty()) return points.b.squaredNorm();
  std::vector<std::array<double, SurfaceManifold::kAmbient>> places(forces->size());
  std::vector<double*> blocks;
  for (size_t j = 0; j < forces->size(); ++j) {
    Pack((*forces)[j].at, places[j].data());
    blocks.push_back((*forces)[j].intensity.data());
    blocks.push_back(places[j].data());
  }
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  SurfaceManifold manifold(&faces.walk());
  problem.AddResidualBlock(new LocationCost(points, faces, candidates, *forces), nullptr, blocks);
  for (size_t j = 0; j < forces->size(); ++j) {
    problem.SetManifold(places[j].data(), &manifold);
    const TrialForce& force = (*forces)[j];
    if (candidates[force.candidate].direction == ForceDirection::kPush) {
      problem.SetParameterLowerBound(blocks[2 * j], 0, 0);
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kMaxIterations;
  options.function_tolerance = 1e-6;
  options.parameter_tolerance = 1e-9;
  options.gradient_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (size_t j = 0; j < forces->size(); ++j) (*forces)[j].at = Unpack(places[j].data());
  return summary.IsSolutionUsable() ? 2 * summary.final_cost : INFINITY;
}

double FitIntensities(const LinearisedPoints& points, const ForceFaces& faces,
                      const std::vector<LocationCandidate>& candidates,
                      std::vector<TrialForce>* forces) {
  GroupedProblem problem;
  problem.b = points.b;
  std::vector<int> all;
  for (const TrialForce& force : *forces) {
    const PlacedPatch placed = faces.Place(force.at, candidates[force.candidate]);
    problem.A.emplace_back(points.Of(placed.patch.weights) * placed.directions);
    problem.push.push_back(candidates[force.candidate].direction == ForceDirection::kPush);
    all.push_back(static_cast<int>(all.size()));
  }
  const Subset fit = SubsetSearch(problem).Fit(all);
  if (!std::isfinite(fit.chi2)) return fit.chi2;
  Eigen::Index i = 0;
  for (TrialForce& force : *forces) {
    const Eigen::Index k = force.intensity.size();
    force.intensity = fit.x.segment(i, k);
    i += k;
  }
  return fit.chi2;
}

}  // namespace softforce::estimation
