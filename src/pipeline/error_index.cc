#include "pipeline/error_index.h"

#include <cmath>

#include "softforce/fem/compliance.h"

namespace softforce::pipeline {

double IndexW(const World& world) {
  estimation::ForceEstimator estimator(world.solver.get(), world.sites);
  if (!estimator.Advance(fem::NoActuation(world.solver->body())).ok()) return NAN;
  Eigen::MatrixXd W(3 * world.markers.size(), estimator.num_components());
  for (size_t m = 0; m < world.markers.size(); ++m) {
    W.middleRows<3>(3 * static_cast<Eigen::Index>(m)) =
        estimator.Compliance(world.markers[m].weights);
  }
  if (W.rows() < W.cols()) return NAN;
  return fem::InverseComplianceNorm(W);
}

}  // namespace softforce::pipeline
