// The half of compare_with_mrcal that needs softforce: calibrates from a table of corners, all with
// the same weight as mrcal does, and prints what is compared.
//
//   build/release/benchmarks/calibration_for_mrcal CORNERS.csv 4|5|8 DISTANCE_M COLUMNS ROWS
#include <fmt/format.h>

#include <cstdlib>
#include <exception>

#include "support/corners_file.h"

int main(int argc, char** argv) {
  using namespace softforce;
  using calibration::LensFit;
  if (argc != 6) {
    fmt::print(stderr, "calibration_for_mrcal CORNERS.csv 4|5|8 DISTANCE_M COLUMNS ROWS\n");
    return 2;
  }
  const int parameters = std::atoi(argv[2]);
  const LensFit lens = parameters == 4   ? LensFit::kBrownConrady4
                       : parameters == 5 ? LensFit::kBrownConrady5
                                         : LensFit::kBrownConrady8;
  calibration::CalibrationOptions options;
  options.outlier_probability = 1e-300;  // the same corners for both: none is left out
  options.working_distance = std::atof(argv[3]);
  options.uncertainty_columns = std::atoi(argv[4]);
  options.uncertainty_rows = std::atoi(argv[5]);
  calibration::Calibration result;
  try {
    calibration::CalibrationInput input = testing::ReadCorners(argv[1], lens);
    for (calibration::CalibrationView& view : input.views) {
      for (vision::BoardView& seen : view.seen) {
        for (Eigen::Matrix2d& covariance : seen.covariances) covariance.setIdentity();
      }
    }
    result = calibration::Calibrate(input, options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "calibration_for_mrcal: {}\n", error.what());
    return 2;
  }
  if (!result.ok()) {
    fmt::print(stderr, "calibration_for_mrcal: {}: {}\n", Name(result.status), result.reason);
    return 1;
  }
  fmt::print("noise_px {}\noutliers {}\n", result.noise_px, result.outliers);
  fmt::print("hold_out_square_mm {}\nhold_out_board_mm {}\n", 1e3 * result.hold_out.square_rms,
             1e3 * result.hold_out.board_rms);
  for (const calibration::CalibratedValue& value : result.values) {
    const std::string camera = value.camera < 0 ? "board" : result.rig.cameras[value.camera].name;
    fmt::print("value {} {}={} {}\n", camera, value.name, value.value, value.sd);
  }
  for (size_t c = 0; c < result.uncertainty.size(); ++c) {
    const calibration::ProjectionUncertainty& map = result.uncertainty[c];
    for (int row = 0; row < map.sd_px.rows(); ++row) {
      for (int column = 0; column < map.sd_px.cols(); ++column) {
        fmt::print("uncertainty {} {} {} {}\n", c, map.x[column], map.y[row],
                   map.sd_px(row, column));
      }
    }
  }
  return 0;
}
