#include "pipeline/working_load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace softforce::pipeline {
namespace {

constexpr int kMaxLoadSearches = 4;
constexpr double kLoadTolerance = 0.03;  // of the wanted deflection; it is a round number anyway

// A newton on every candidate: along its direction or, where that is free, its softest one of the
// three axes, downwards along the axis.
Eigen::VectorXd LoadPattern(const World& world, const MeshAnswer& answer) {
  Eigen::VectorXd pattern = Eigen::VectorXd::Zero(answer.own.size());
  Eigen::Index first = 0;
  for (const estimation::ForceSite& site : world.sites) {
    const Eigen::Index n = site.directions.cols();
    Eigen::Index softest = 0;
    answer.own.segment(first, n).maxCoeff(&softest);
    pattern(first + softest) = n == 1 ? 1 : -1;
    first += n;
  }
  return pattern;
}

struct Shape {
  fem::SolveSummary summary;
  fem::Equilibrium state;
  Eigen::Matrix3Xd u;  // 3×N, m; by the load, without the body's weight
};

Shape Load(const World& world, const Eigen::VectorXd& forces) {
  const int num_nodes = world.mesh().num_nodes();
  Shape shape;
  shape.state = world.solver->AtRest();
  fem::LoadCase load{Eigen::Matrix3Xd::Zero(3, num_nodes), fem::NoActuation(world.solver->body())};
  shape.summary = world.solver->Solve(load, &shape.state);
  if (!shape.summary.ok()) return shape;
  const Eigen::Matrix3Xd at_rest = shape.state.u;
  load.forces = forces.reshaped(3, num_nodes);
  shape.summary = world.solver->Solve(load, &shape.state);
  shape.u = shape.state.u - at_rest;
  return shape;
}

std::string NoEquilibrium(double load, const char* mesh, const fem::SolveSummary& summary) {
  return fmt::format(
      "no equilibrium was found with {:.3g} N on every candidate on the {} mesh: {}. {}", load,
      mesh, summary.BriefReport(), summary.Advice());
}

double LargestDeflection(const World& world, const Eigen::Matrix3Xd& u) {
  double largest = 0;
  for (const estimation::ForceSite& site : world.sites) {
    largest = std::max(largest, site.at.Apply(u).norm());
  }
  return largest;
}

// The load that the options ask for, and the given body under it.
Shape FindLoad(const World& world, const Eigen::VectorXd& forces,
               const MeshConvergenceOptions& options, const Eigen::Matrix3Xd& linear,
               double* load) {
  if (options.working_load > 0) {
    *load = options.working_load;
    return Load(world, *load * forces);
  }
  const Eigen::Matrix3Xd& X = world.mesh().nodes;
  const double wanted =
      options.working_deflection * (X.rowwise().maxCoeff() - X.rowwise().minCoeff()).maxCoeff();
  *load = wanted / LargestDeflection(world, linear);
  Shape shape = Load(world, *load * forces);
  for (int i = 1; i < kMaxLoadSearches && shape.summary.ok(); ++i) {
    const double share = LargestDeflection(world, shape.u) / wanted;
    if (std::abs(share - 1) < kLoadTolerance) break;
    *load /= share;
    shape = Load(world, *load * forces);
  }
  return shape;
}

}  // namespace

WorkingMeshBias CompareAtWork(const World& given, const MeshAnswer& given_answer,
                              const World& local, const Eigen::MatrixXd& local_markers,
                              const Eigen::MatrixXd& refined, const Eigen::MatrixXd& converged,
                              const MeshConvergenceOptions& options) {
  WorkingMeshBias bias;
  const Eigen::VectorXd pattern = LoadPattern(given, given_answer);
  const Eigen::Matrix3Xd linear = (given_answer.du * pattern).reshaped(3, given.mesh().num_nodes());
  const Shape coarse = FindLoad(given, given_answer.forces * pattern, options, linear, &bias.load);
  if (!coarse.summary.ok()) {
    bias.problem = NoEquilibrium(bias.load, "given", coarse.summary);
    return bias;
  }
  const Shape fine = Load(local, bias.load * (UnitForces(local) * pattern));
  if (!fine.summary.ok()) {
    bias.problem = NoEquilibrium(bias.load, "finer", fine.summary);
    return bias;
  }
  const fem::Sensitivity tangent =
      given.solver->Solve(coarse.state, given_answer.forces * pattern, 0);
  if (!tangent.ok) {
    bias.problem = fmt::format(
        "with {:.3g} N on every candidate the body is about to buckle. Take a smaller load.",
        bias.load);
    return bias;
  }

  bias.deflection = LargestDeflection(given, coarse.u);
  const Eigen::VectorXd u = AtMarkers(given, coarse.u);
  const Eigen::VectorXd missing = AtMarkers(local, fine.u) - u;
  const double displacement = u.dot(missing) / u.squaredNorm();
  // More load that moves the given mesh's markers as far as the finer mesh's.
  const Eigen::VectorXd per_newton =
      AtMarkers(given, tangent.du.col(0).reshaped(3, given.mesh().num_nodes()));
  const double force = per_newton.dot(missing) / per_newton.squaredNorm() / bias.load;

  const Eigen::VectorXd at_rest = given_answer.markers * pattern;
  const double local_at_rest = BiasOf(at_rest, local_markers * pattern);
  const double to_refined = BiasOf(at_rest, refined * pattern) / local_at_rest;
  const double to_converged = BiasOf(at_rest, converged * pattern) / local_at_rest;
  bias.displacement = {to_refined * displacement, to_converged * displacement};
  bias.force = {to_refined * force, to_converged * force};
  bias.ok = std::isfinite(bias.force.refined);
  if (!bias.ok) bias.problem = "the meshes move alike, so that their difference cannot be scaled.";
  return bias;
}

}  // namespace softforce::pipeline
