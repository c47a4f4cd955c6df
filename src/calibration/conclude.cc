#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "calibration/stages.h"
#include "calibration/uncertainty.h"

namespace softforce::calibration {
namespace {

void WriteValues(const NormalEquations& equations, const Estimate& estimate, double noise_factor,
                 Calibration* calibration) {
  using Kind = CalibratedValue::Kind;
  calibration->covariance = noise_factor * noise_factor * equations.SharedCovariance();
  std::vector<CalibratedValue>& values = calibration->values;
  const std::array<std::string, 3> axes = {" x", " y", " z"};
  for (int c = 0; c < static_cast<int>(estimate.lenses.size()); ++c) {
    const std::vector<std::string> names = ParameterNames(estimate.fits[c]);
    const Eigen::VectorXd lens = LensVector(estimate.lenses[c], estimate.fits[c]);
    for (int i = 0; i < lens.size(); ++i) {
      const bool core = i < 4;
      values.push_back(
          {core ? Kind::kIntrinsics : Kind::kDistortion, c, names[i], core ? "px" : "", lens(i)});
    }
    if (equations.pose_start(c) < 0) continue;
    const Eigen::AngleAxisd turn(estimate.T_camera_rig[c].linear());
    for (int i = 0; i < 3; ++i) {
      values.push_back(
          {Kind::kRotation, c, "rotation" + axes[i], "rad", turn.angle() * turn.axis()(i)});
    }
    for (int i = 0; i < 3; ++i) {
      values.push_back({Kind::kTranslation, c, "translation" + axes[i], "m",
                        estimate.T_camera_rig[c].translation()(i)});
    }
  }
  for (int i = 0; estimate.fit_warp && i < 2; ++i) {
    values.push_back({Kind::kWarp, -1, "warp" + axes[i], "m", estimate.warp(i)});
  }
  for (size_t i = 0; i < values.size(); ++i) {
    values[i].sd = std::sqrt(calibration->covariance(i, i));
  }
}

int Cell(double at, int pixels, int cells) {
  return std::clamp(static_cast<int>((at + 0.5) / pixels * cells), 0, cells - 1);
}

void WriteResiduals(const CalibrationInput& input, const BoardShape& board,
                    const CalibrationOptions& options, const std::vector<Sighting>& sightings,
                    const Fit& fit, const Estimate& estimate, Calibration* calibration) {
  calibration->cameras.resize(input.cameras.size());
  for (CameraFit& camera : calibration->cameras) {
    camera.coverage = Eigen::MatrixXi::Zero(options.coverage_rows, options.coverage_columns);
  }
  for (size_t i = 0; i < sightings.size(); ++i) {
    const Sighting& sighting = sightings[i];
    PointResidual residual;
    residual.view = sighting.view;
    residual.camera = sighting.camera;
    residual.id = sighting.id;
    residual.pixel = sighting.pixel;
    const auto at = camera::Project(
        estimate.lenses[sighting.camera],
        estimate.T_camera_rig[sighting.camera] *
            (estimate.T_rig_board[sighting.view] * board.Bent(sighting.id, estimate.warp)));
    residual.error = sighting.pixel - at.pixel;
    residual.sigmas = fit.sigmas[i];
    residual.outlier = !sighting.used;
    calibration->residuals.push_back(residual);
    if (residual.outlier) continue;
    const CameraToCalibrate& camera = input.cameras[sighting.camera];
    ++calibration->cameras[sighting.camera].coverage(
        Cell(sighting.pixel.y(), camera.height, options.coverage_rows),
        Cell(sighting.pixel.x(), camera.width, options.coverage_columns));
  }
}

struct Tally {
  int points = 0, outliers = 0;
  double sum = 0;  // px²

  void Add(const PointResidual& residual) {
    if (residual.outlier) {
      ++outliers;
    } else {
      ++points;
      sum += residual.error.squaredNorm();
    }
  }
  double rms() const { return points > 0 ? std::sqrt(sum / points) : NAN; }
};

PictureFit FitOfPicture(const Calibration& calibration, const Estimate& estimate,
                        const BoardShape& board, int view, int camera) {
  Tally tally;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const PointResidual& residual : calibration.residuals) {
    if (residual.view != view || residual.camera != camera) continue;
    tally.Add(residual);
    if (!residual.outlier) middle += board.points[residual.id];
  }
  PictureFit fit;
  fit.camera = camera;
  fit.points = tally.points;
  fit.outliers = tally.outliers;
  fit.left_out = tally.points == 0;
  fit.rms_px = tally.rms();
  if (fit.left_out) return fit;
  const Eigen::Isometry3d T_camera_board =
      estimate.T_camera_rig[camera] * estimate.T_rig_board[view];
  const Eigen::Vector3d p_camera = T_camera_board * (middle / tally.points);
  fit.distance = p_camera.norm();
  fit.tilt = std::acos(
      std::min(1.0, std::abs(T_camera_board.linear().col(2).dot(p_camera)) / fit.distance));
  return fit;
}

void WriteFits(const CalibrationInput& input, const BoardShape& board, const Estimate& estimate,
               const NormalEquations& equations, Calibration* calibration) {
  Tally all;
  double whole_views = 0;
  std::vector<Tally> of_camera(input.cameras.size());
  for (const PointResidual& residual : calibration->residuals) {
    all.Add(residual);
    of_camera[residual.camera].Add(residual);
  }
  const double variance = calibration->noise_factor * calibration->noise_factor;
  for (int v = 0; v < static_cast<int>(input.views.size()); ++v) {
    ViewFit view;
    view.name = input.views[v].name;
    view.used = equations.has_board(v);
    if (view.used) {
      view.T_rig_board = estimate.T_rig_board[v];
      view.covariance = variance * equations.BoardCovariance(v);
      ++whole_views;
    }
    for (int c = 0; c < static_cast<int>(input.cameras.size()); ++c) {
      if (input.views[v].seen[c].size() == 0) continue;
      view.pictures.push_back(FitOfPicture(*calibration, estimate, board, v, c));
      if (!view.pictures.back().left_out) ++calibration->cameras[c].pictures;
    }
    calibration->views.push_back(view);
  }
  for (size_t c = 0; c < of_camera.size(); ++c) {
    calibration->cameras[c].points = of_camera[c].points;
    calibration->cameras[c].outliers = of_camera[c].outliers;
    calibration->cameras[c].rms_px = of_camera[c].rms();
  }
  calibration->rms_px = all.rms();
  calibration->points = all.points;
  calibration->outliers = all.outliers;
  // Each fitted parameter takes its share of the noise away.
  const double degrees = 2.0 * all.points - equations.num_shared() - 6 * whole_views;
  calibration->noise_px = std::sqrt(all.sum / std::max(1.0, degrees));
}

double MedianDistance(const std::vector<ViewFit>& views) {
  std::vector<double> distances;
  for (const ViewFit& view : views) {
    for (const PictureFit& picture : view.pictures) {
      if (!picture.left_out) distances.push_back(picture.distance);
    }
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

camera::Rig RigOf(const CalibrationInput& input, const Estimate& estimate) {
  camera::Rig rig;
  for (size_t c = 0; c < input.cameras.size(); ++c) {
    const CameraToCalibrate& camera = input.cameras[c];
    rig.cameras.push_back(
        {camera.name, camera.width, camera.height, estimate.lenses[c], estimate.T_camera_rig[c]});
  }
  return rig;
}

void Conclude(const CalibrationInput& input, const BoardShape& board,
              const CalibrationOptions& options, const std::vector<Sighting>& sightings,
              const Fit& fit, const NormalEquations& equations, const Estimate& estimate,
              Calibration* calibration) {
  calibration->rig = RigOf(input, estimate);
  calibration->lenses = estimate.fits;
  calibration->warp = estimate.warp;
  calibration->warp_fitted = estimate.fit_warp;
  calibration->noise_factor = fit.noise_factor;
  WriteValues(equations, estimate, fit.noise_factor, calibration);
  WriteResiduals(input, board, options, sightings, fit, estimate, calibration);
  WriteFits(input, board, estimate, equations, calibration);
  const double distance =
      options.working_distance > 0 ? options.working_distance : MedianDistance(calibration->views);
  for (int c = 0; c < static_cast<int>(input.cameras.size()); ++c) {
    calibration->uncertainty.push_back(
        ProjectionUncertaintyOf(equations, estimate, fit.noise_factor, input.cameras[c], c,
                                distance, options.uncertainty_columns, options.uncertainty_rows));
  }
}

}  // namespace softforce::calibration
