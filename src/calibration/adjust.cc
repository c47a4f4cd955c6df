#include "calibration/adjust.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include <algorithm>
#include <cmath>

#include "calibration/reprojection_cost.h"

namespace softforce::calibration {
namespace {

class EndWhenAsked : public ceres::IterationCallback {
 public:
  explicit EndWhenAsked(const std::atomic<bool>* asked) : asked_(asked) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    return asked_ != nullptr && *asked_ ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const std::atomic<bool>* asked_;
};

// An estimate as Ceres wants it. All parameters lie in one array: Ceres orders blocks by their
// address, and the same order gives the same bits.
class Blocks {
 public:
  explicit Blocks(const Estimate& estimate) {
    for (size_t c = 0; c < estimate.lenses.size(); ++c) {
      lens_starts_.push_back(Append(LensVector(estimate.lenses[c], estimate.fits[c])));
    }
    for (const auto& T : estimate.T_camera_rig) camera_starts_.push_back(Append(ToVector(T)));
    for (const auto& T : estimate.T_rig_board) board_starts_.push_back(Append(ToVector(T)));
    warp_start_ = Append(estimate.warp);
  }

  double* lens(int camera) { return values_.data() + lens_starts_[camera]; }
  double* camera(int camera) { return values_.data() + camera_starts_[camera]; }
  double* board(int view) { return values_.data() + board_starts_[view]; }
  double* warp() { return values_.data() + warp_start_; }

  void WriteTo(Estimate* estimate) {
    for (int c = 0; c < static_cast<int>(estimate->lenses.size()); ++c) {
      estimate->lenses[c] = LensFrom(lens(c), estimate->fits[c]);
      if (c > 0) estimate->T_camera_rig[c] = ToTransform(camera(c));
    }
    for (int v = 0; v < static_cast<int>(estimate->T_rig_board.size()); ++v) {
      estimate->T_rig_board[v] = ToTransform(board(v));
    }
    estimate->warp = Eigen::Vector2d(warp());
  }

 private:
  size_t Append(const Eigen::VectorXd& block) {
    values_.insert(values_.end(), block.data(), block.data() + block.size());
    return values_.size() - block.size();
  }

  std::vector<double> values_;
  std::vector<size_t> lens_starts_, camera_starts_, board_starts_;
  size_t warp_start_ = 0;
};

void AddPriors(const Estimate& estimate, Blocks* blocks, ceres::Problem* problem) {
  for (int c = 0; c < static_cast<int>(estimate.lenses.size()); ++c) {
    if (!problem->HasParameterBlock(blocks->lens(c))) continue;
    const int size = estimate.num_lens(c);
    Eigen::MatrixXd whitening = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < size; ++i) whitening(i, i) = 1 / PriorSd(estimate.fits[c], i);
    if (whitening.isZero(0)) continue;
    const Eigen::VectorXd mean = Eigen::VectorXd::Zero(size);
    problem->AddResidualBlock(new ceres::NormalPrior(whitening, mean), nullptr, blocks->lens(c));
  }
}

std::vector<int> KeptLensParameters(int size, const AdjustOptions& options) {
  std::vector<int> kept;
  if (!options.free_centre) kept = {2, 3};
  for (int i = 4 + options.free_distortion; i < size; ++i) kept.push_back(i);
  return kept;
}

void SetConstants(const Estimate& estimate, const AdjustOptions& options, Blocks* blocks,
                  ceres::Problem* problem) {
  for (int c = 0; c < static_cast<int>(estimate.lenses.size()); ++c) {
    double* const lens = blocks->lens(c);
    if (!problem->HasParameterBlock(lens)) continue;
    const int size = estimate.num_lens(c);
    const std::vector<int> kept = KeptLensParameters(size, options);
    if (!kept.empty()) problem->SetManifold(lens, new ceres::SubsetManifold(size, kept));
    // Views that leave the focal length open must not let it run away.
    for (int i = 0; i < 2; ++i) {
      problem->SetParameterLowerBound(lens, i, 0.02 * lens[i]);
      problem->SetParameterUpperBound(lens, i, 50 * lens[i]);
    }
  }
  double* const first = blocks->camera(0);
  if (problem->HasParameterBlock(first)) problem->SetParameterBlockConstant(first);
  if (!(estimate.fit_warp && options.free_warp)) {
    problem->SetParameterBlockConstant(blocks->warp());
  }
}

}  // namespace

Adjustment Adjust(const BoardShape& board, const std::vector<Sighting>& sightings,
                  const AdjustOptions& options, Estimate* estimate) {
  Blocks blocks(*estimate);
  ceres::CauchyLoss cauchy(std::isfinite(options.loss_scale) ? options.loss_scale : 1);
  ceres::LossFunction* const loss = std::isfinite(options.loss_scale) ? &cauchy : nullptr;
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (const Sighting& sighting : sightings) {
    if (!sighting.used || !std::isfinite(WhitenedError(board, *estimate, sighting))) continue;
    problem.AddResidualBlock(new ReprojectionCost(sighting, estimate->fits[sighting.camera], board),
                             loss, blocks.lens(sighting.camera), blocks.camera(sighting.camera),
                             blocks.board(sighting.view), blocks.warp());
  }
  if (problem.NumResidualBlocks() == 0) return {};
  AddPriors(*estimate, &blocks, &problem);
  SetConstants(*estimate, options, &blocks, &problem);

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  std::vector<double*> all;
  problem.GetParameterBlocks(&all);
  for (double* block : all) solver.linear_solver_ordering->AddElementToGroup(block, 1);
  for (int v = 0; v < static_cast<int>(estimate->T_rig_board.size()); ++v) {
    if (problem.HasParameterBlock(blocks.board(v))) {
      solver.linear_solver_ordering->AddElementToGroup(blocks.board(v), 0);
    }
  }
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.tolerance;
  solver.parameter_tolerance = options.tolerance;
  solver.gradient_tolerance = 1e-14;
  // Enough damping is left for a Cholesky factorisation where the views hardly tell a direction.
  solver.max_trust_region_radius = 1e11;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  EndWhenAsked end_when_asked(options.stop);
  solver.callbacks = {&end_when_asked};
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);

  Adjustment adjustment;
  adjustment.stopped = summary.termination_type == ceres::USER_FAILURE;
  adjustment.usable = summary.IsSolutionUsable();
  adjustment.converged = summary.termination_type == ceres::CONVERGENCE;
  if (adjustment.usable) blocks.WriteTo(estimate);
  return adjustment;
}

Adjustment AdjustRobustly(const BoardShape& board, const std::vector<Sighting>& sightings,
                          AdjustOptions options, Estimate* estimate) {
  std::vector<Sighting> used;
  for (const Sighting& sighting : sightings) {
    if (sighting.used) used.push_back(sighting);
  }
  Adjustment adjustment;
  double noise = RobustNoise(board, *estimate, used);
  for (int round = 0; round < 10; ++round) {
    options.tolerance = 1e-6;                        // the scale changes the answer anyhow
    options.loss_scale = 2 * std::max(noise, 1e-9);  // the floor: data without any noise
    adjustment = Adjust(board, used, options, estimate);
    if (!adjustment.usable || adjustment.stopped) return adjustment;
    const double before = noise;
    noise = RobustNoise(board, *estimate, used);
    if (!(noise < 0.9 * before)) break;
  }
  return adjustment;
}

}  // namespace softforce::calibration
