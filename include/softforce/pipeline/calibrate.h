#pragma once

#include <optional>
#include <string>
#include <vector>

#include "softforce/calibration/calibrate.h"
#include "softforce/pipeline/next_pose.h"
#include "softforce/report/calibration_report.h"
#include "softforce/scene/rig_file.h"
#include "softforce/vision/board_detector.h"
#include "softforce/vision/board_pictures.h"
#include "softforce/vision/choose_views.h"
#include "softforce/vision/frame_source.h"

namespace softforce::pipeline {

struct CalibrateOptions {
  std::vector<vision::CameraInput> inputs;
  vision::Board board;
  std::optional<calibration::LensFit> lens;  // of all cameras; nothing: the best is found
  vision::BoardOptions detection;
  vision::ChooseOptions choose;
  calibration::CalibrationOptions calibration;
  int most_moments = 400;            // that are looked at in a video, spread over its length
  int stride_of_unknown_length = 5;  // every so manyth frame of a video that does not say it
  bool show_progress = true;
};

// Finds the board in all pictures and calibrates the cameras with it. Throws InputError for what no
// calibration can be made of: a file that is no picture, pictures of several sizes, a board that is
// found in no picture of a camera (and says what was found instead). Whether the answer is usable
// is told by its status.
report::CalibrationRecord Calibrate(const CalibrateOptions& options);

// The same from cameras that run, named in the source's order: collects views, says on standard
// error which pose is wanted next, and ends when the boards cover enough of the pictures and the
// projection is certain enough, or `calibration.stop` is set; then calibrates with what there is.
// What was not reached is among the advice. `inputs` is not used.
report::CalibrationRecord CalibrateLive(vision::FrameSource& source,
                                        const std::vector<std::string>& cameras,
                                        const CalibrateOptions& options,
                                        const GuideOptions& guide = {});

// What a rig.yaml keeps of it.
scene::RigStatistics StatisticsOf(const report::CalibrationRecord& record);

}  // namespace softforce::pipeline
