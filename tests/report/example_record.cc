#include "report/example_record.h"

#include <cmath>
#include <random>

#include "support/stereo_rig.h"

namespace softforce::report::testing {
namespace {

using calibration::CalibratedValue;
using calibration::Calibration;

constexpr int kViews = 12;
constexpr double kNoise = 0.08;  // px

vision::Board MakeBoard() {
  vision::Board board;
  board.columns = 9;
  board.rows = 6;
  board.square = 0.02;
  return board;
}

Eigen::Isometry3d BoardPose(int view) {
  const double turn = 2.4 * view, tilt = 0.15 + 0.05 * view;
  const Eigen::Vector3d axis(std::cos(turn), std::sin(turn), 0);
  const Eigen::Vector3d place(-0.09 + 0.06 * std::cos(turn), -0.05 + 0.05 * std::sin(turn),
                              0.4 + 0.01 * view);
  return Eigen::Translation3d(place) * Eigen::AngleAxisd(tilt, axis);
}

void AddPoint(CalibrationRecord& record, int v, int c, int id, std::mt19937& random) {
  std::normal_distribution<double> noise(0, kNoise);
  const camera::Camera& camera = record.result.rig.cameras[c];
  const Eigen::Vector3d p =
      camera.T_camera_rig * (record.result.views[v].T_rig_board * record.input.board[id]);
  const Eigen::Vector2d projected = camera::Project(camera.lens, p).pixel;
  const bool inside = projected.x() > 4 && projected.y() > 4 && projected.x() < camera.width - 5 &&
                      projected.y() < camera.height - 5;
  if (!inside) return;
  calibration::PointResidual residual;
  residual.view = v;
  residual.camera = c;
  residual.id = id;
  residual.outlier = v == 3 && c == 1 && id == 20;
  residual.error =
      residual.outlier ? Eigen::Vector2d(3, -2) : Eigen::Vector2d(noise(random), noise(random));
  residual.pixel = projected + residual.error;
  residual.sigmas = residual.error.norm() / kNoise;
  record.result.residuals.push_back(residual);
  vision::BoardView& seen = record.input.views[v].seen[c];
  seen.ids.push_back(id);
  seen.pixels.push_back(residual.pixel);
  seen.covariances.push_back(kNoise * kNoise * Eigen::Matrix2d::Identity());
}

void AddViews(CalibrationRecord& record) {
  const int cameras = static_cast<int>(record.input.cameras.size());
  std::mt19937 random(1);
  record.input.board = record.board.Points();
  record.input.views.resize(kViews);
  record.result.views.resize(kViews);
  for (int v = 0; v < kViews; ++v) {
    calibration::ViewFit& view = record.result.views[v];
    record.input.views[v].name = view.name = "board_" + std::to_string(v) + ".jpg";
    record.input.views[v].seen.resize(cameras);
    view.used = v != 9;
    view.T_rig_board = BoardPose(v);
    for (int c = 0; c < cameras; ++c) {
      for (int id = 0; id < record.board.NumPoints(); ++id) AddPoint(record, v, c, id, random);
      calibration::PictureFit picture;
      picture.camera = c;
      picture.points = record.input.views[v].seen[c].size();
      picture.outliers = v == 3 && c == 1 ? 1 : 0;
      picture.left_out = !view.used;
      picture.rms_px = (v == 9 ? 2.4 : 0.1 + 0.004 * v);
      picture.distance = 0.4 + 0.01 * v;
      picture.tilt = 0.15 + 0.05 * v;
      view.pictures.push_back(picture);
    }
  }
}

void CountCoverage(const CalibrationRecord& record, int c, Eigen::MatrixXi& coverage) {
  coverage = Eigen::MatrixXi::Zero(6, 8);
  for (const calibration::PointResidual& point : record.result.residuals) {
    if (point.camera != c || point.outlier) continue;
    const calibration::CameraToCalibrate& camera = record.input.cameras[c];
    ++coverage(static_cast<int>(6 * point.pixel.y() / camera.height),
               static_cast<int>(8 * point.pixel.x() / camera.width));
  }
}

calibration::ProjectionUncertainty MakeUncertainty(const calibration::CameraToCalibrate& camera) {
  calibration::ProjectionUncertainty map;
  map.distance = 0.45;
  for (int i = 0; i < 25; ++i) map.x.push_back((camera.width - 1) * i / 24.0);
  for (int i = 0; i < 19; ++i) map.y.push_back((camera.height - 1) * i / 18.0);
  map.sd_px.resize(19, 25);
  for (int row = 0; row < 19; ++row) {
    for (int col = 0; col < 25; ++col) {
      const double r = std::hypot(col / 12.0 - 1.1, row / 9.0 - 0.9);
      map.sd_px(row, col) = 0.015 * std::exp(1.6 * r * r);
      map.covariances.push_back(std::pow(map.sd_px(row, col), 2) * Eigen::Matrix2d::Identity());
    }
  }
  map.sd_px(0, 0) = NAN;
  return map;
}

void AddValues(Calibration& result) {
  using Kind = CalibratedValue::Kind;
  const auto add = [&](Kind kind, int camera, const char* name, const char* unit, double value,
                       double sd) {
    result.values.push_back({kind, camera, name, unit, value, sd});
  };
  for (int c = 0; c < static_cast<int>(result.rig.cameras.size()); ++c) {
    const camera::Lens& lens = result.rig.cameras[c].lens;
    add(Kind::kIntrinsics, c, "fx", "px", lens.fx, 0.42);
    add(Kind::kIntrinsics, c, "cx", "px", lens.cx, 0.61);
    add(Kind::kDistortion, c, "k1", "", lens.distortion[0], 0.0013);
    if (c == 0) continue;
    const Eigen::Isometry3d& T = result.rig.cameras[c].T_camera_rig;
    add(Kind::kRotation, c, "rotation y", "rad", 0.32, 2e-4);
    add(Kind::kTranslation, c, "translation x", "m", T.translation().x(), 5e-5);
    add(Kind::kTranslation, c, "translation y", "m", T.translation().y(), 5e-5);
    add(Kind::kTranslation, c, "translation z", "m", T.translation().z(), 5e-5);
  }
  add(Kind::kWarp, -1, "warp x", "m", 1.8e-4, 2e-5);
  const int count = static_cast<int>(result.values.size());
  result.covariance = Eigen::MatrixXd::Zero(count, count);
  for (int i = 0; i < count; ++i) {
    result.covariance(i, i) = result.values[i].sd * result.values[i].sd;
  }
}

void AddHoldOut(Calibration& result) {
  result.hold_out.folds = kViews;
  result.hold_out.rms_px = 0.131;
  const bool metric = result.rig.cameras.size() > 1;
  if (metric) {
    result.hold_out.square_rms = 4.2e-5;
    result.hold_out.board_rms = 8.6e-5;
  }
  for (int v = 0; v < kViews; ++v) {
    calibration::HoldOutView view;
    view.view = v;
    view.squared_px = std::pow(0.12 + 0.003 * v, 2);
    if (metric) {
      view.squared_square = std::pow(4e-5 + 1e-6 * v, 2);
      view.squared_board = std::pow(8e-5 + 2e-6 * v, 2);
    }
    result.hold_out.views.push_back(view);
  }
}

CalibrationRecord MakeWith(int cameras) {
  CalibrationRecord record;
  record.board = MakeBoard();
  Calibration& result = record.result;
  result.status = Calibration::Status::kOk;
  result.rig = softforce::testing::MakeStereoRig();
  result.rig.cameras.resize(cameras);
  for (const camera::Camera& camera : result.rig.cameras) {
    record.input.cameras.push_back({camera.name, camera.width, camera.height, {}});
    result.lenses.push_back(calibration::LensFit::kBrownConrady5);
  }
  AddViews(record);
  for (int c = 0; c < cameras; ++c) {
    calibration::CameraFit fit{kViews - 1, 594, c == 1 ? 1 : 0, 0.113, {}};
    CountCoverage(record, c, fit.coverage);
    result.cameras.push_back(fit);
    result.uncertainty.push_back(MakeUncertainty(record.input.cameras[c]));
  }
  result.rms_px = 0.113;
  result.noise_px = kNoise;
  result.warp_fitted = true;
  result.points = 594 * cameras;
  result.outliers = cameras > 1 ? 1 : 0;
  AddValues(result);
  AddHoldOut(result);
  record.left_out = {{0, "dark_<3>.jpg", "no board found"}};
  return record;
}

}  // namespace

CalibrationRecord MakeRecord() {
  CalibrationRecord record = MakeWith(2);
  record.result.advice = {{calibration::Advice::Kind::kEdgeNotCovered, 1,
                           "right: no board within 160 px of the left edge",
                           "Take pictures with the board at the left edge of right."}};
  return record;
}

CalibrationRecord MakeSingleCameraRecord() { return MakeWith(1); }

CalibrationRecord MakeFailedRecord() {
  CalibrationRecord record = MakeRecord();
  record.result = {};
  record.result.status = Calibration::Status::kTooFewViews;
  record.result.reason = "left: 2 pictures with the board, expected at least 3";
  record.result.what_to_do = "Take more pictures.";
  record.input.views.resize(2);
  return record;
}

}  // namespace softforce::report::testing
