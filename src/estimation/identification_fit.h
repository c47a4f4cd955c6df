#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "estimation/model_error.h"
#include "estimation/parametric_body.h"

namespace softforce::estimation {

// The rigid offset of the observed points.
struct OffsetModel {
  OffsetPrior about;                // its centre
  geometry::Matrix6d registration;  // root of its covariance from the rig's place
  geometry::Matrix6d model;         // root of its covariance per m of common model error
};
OffsetModel MakeOffsetModel(const PointCloud& cloud, const geometry::Matrix6d& registration);

// The least-squares problem of an identification at given model errors.
//
// What is fitted is scaled to be of order one: the unknowns in standard deviations of a guess, then
// the offset from the rig's place and, for each state, what the model's error adds to the offset on
// the way there from the next smaller displacement in its group: whitened (standard deviation 1), 6
// each.
class IdentificationFit {
 public:
  // All arguments must outlive it. `rejected`: per state and observation.
  IdentificationFit(ParametricBody* body, const std::vector<KnownState>& states,
                    const std::vector<std::vector<char>>& rejected, const OffsetModel& offset,
                    const Eigen::VectorXd& guess, const Eigen::VectorXd& prior_sd,
                    const IdentificationOptions& options);

  // The model's errors go with the displacement of each state, m: see SetDisplacements.
  void SetDisplacements(const std::vector<double>& displacements);

  int num_parameters() const { return num_parameters_; }
  int num_rows() const;  // measured coordinates in use

  struct Result {
    bool converged = false;
    int iterations = 0;
  };
  // Minimises from `parameters`, which are replaced.
  Result Minimise(Eigen::VectorXd* parameters);

  Eigen::VectorXd Theta(const Eigen::VectorXd& parameters) const;
  RigidOffset Offset(int state, const Eigen::VectorXd& parameters) const;
  // Model's position of an observed point less its measurement, m, where the body stands now.
  Eigen::Vector3d Misfit(int state, const Observation& seen,
                         const Eigen::VectorXd& parameters) const;

  // χ² of the observations and of the priors at `parameters`, where the body stands now.
  double ChiSquare(const Eigen::VectorXd& parameters) const;
  // JᵀJ of everything, where sensitivities were computed. With the loss, markers far off say less;
  // without, it is what they could say once they fit.
  Eigen::MatrixXd Information(const Eigen::VectorXd& parameters, bool with_loss) const;

  // The observation that is most impossible by itself, as (state, number); (−1, −1) if none is.
  std::pair<int, int> MostImpossible(const Eigen::VectorXd& parameters) const;

  // What is said of a point in the states of a group: observations that share one local error.
  struct Block {
    std::vector<std::pair<int, int>> members;  // state, number
    Eigen::MatrixXd whitening;                 // of the stacked whitened misfits
  };
  Eigen::VectorXd Residuals(const Block& block, const Eigen::VectorXd& parameters) const;
  Eigen::MatrixXd Jacobian(const Block& block) const;

 private:
  // Weights of the priors, in the parameters' own scale; 0 where nothing was known.
  Eigen::VectorXd PriorWeights() const;
  double LocalError(int state, int number) const;  // m, standard deviation
  double LossScale(const Block& block) const;
  // ∂(offset twist)/∂(all whitened offset parameters) of a state, 6×(6 + 6 states).
  Eigen::MatrixXd OffsetRoot(int state) const;

  ParametricBody* body_;
  const std::vector<KnownState>& states_;
  const std::vector<std::vector<char>>& rejected_;
  const OffsetModel& offset_;
  Eigen::VectorXd guess_, prior_sd_;
  const IdentificationOptions& options_;
  int num_parameters_ = 0;
  std::vector<std::vector<int>> companions_;  // per state and observation, see CountCompanions
  std::vector<double> displacements_;
  std::vector<Eigen::MatrixXd> offset_roots_;  // per state
  std::vector<Block> blocks_;
};

}  // namespace softforce::estimation
