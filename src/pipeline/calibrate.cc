#include "softforce/pipeline/calibrate.h"

#include "pipeline/find_boards.h"

namespace softforce::pipeline {

report::CalibrationRecord Calibrate(const CalibrateOptions& options) {
  options.board.Check();
  options.detection.Check();
  options.choose.Check();
  options.calibration.Check();
  report::CalibrationRecord record;
  record.board = options.board;
  FindBoards(options, record);
  if (options.calibration.stop != nullptr && *options.calibration.stop) {
    record.result.status = calibration::Calibration::Status::kStopped;
    record.result.reason = "stopped while the board was looked for";
    return record;
  }
  record.result = calibration::Calibrate(record.input, options.calibration);
  return record;
}

scene::RigStatistics StatisticsOf(const report::CalibrationRecord& record) {
  const calibration::Calibration& result = record.result;
  scene::RigStatistics statistics;
  statistics.board = record.board.Text();
  for (const calibration::ViewFit& view : result.views) statistics.views += view.used ? 1 : 0;
  statistics.rms_px = result.rms_px;
  if (result.hold_out.folds > 0) {
    statistics.held_out_px = result.hold_out.rms_px;
    statistics.held_out_square = result.hold_out.square_rms;
    statistics.held_out_board = result.hold_out.board_rms;
  }
  for (size_t c = 0; c < result.cameras.size(); ++c) {
    const calibration::CameraFit& fit = result.cameras[c];
    statistics.cameras.push_back(
        {record.input.cameras[c].name, fit.pictures, fit.points, fit.rms_px});
  }
  for (const calibration::CalibratedValue& value : result.values) {
    const std::string owner = value.camera < 0 ? "board" : record.input.cameras[value.camera].name;
    statistics.parameters.push_back(owner + ": " + value.name);
  }
  statistics.covariance = result.covariance;
  return statistics;
}

}  // namespace softforce::pipeline
