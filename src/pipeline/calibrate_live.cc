#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "pipeline/certainty.h"
#include "pipeline/find_boards.h"
#include "softforce/pipeline/calibrate.h"

namespace softforce::pipeline {
namespace {

using vision::FrameSet;

// Ends a wait for pictures when the flag is set from outside.
class StopWatch {
 public:
  StopWatch(const std::atomic<bool>* flag, vision::FrameSource& source)
      : thread_([this, flag, &source] {
          while (!done_) {
            if (flag != nullptr && *flag) source.Stop();
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
          }
        }) {}
  ~StopWatch() {
    done_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> done_{false};
  std::thread thread_;
};

// One line that is rewritten on a terminal; elsewhere a line whenever it says something new.
class GuideLine {
 public:
  void Show(const std::string& text) {
    if (text == last_) return;
    last_ = text;
    if (terminal_) {
      fmt::print(stderr, "\r\033[K{}", text);
      std::fflush(stderr);
    } else {
      fmt::print(stderr, "{}\n", text);
    }
  }
  void Say(const std::string& message) {
    fmt::print(stderr, "{}{}\n", terminal_ ? "\r\033[K" : "", message);
    last_.clear();
  }
  void Finish() const {
    if (terminal_) fmt::print(stderr, "\n");
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  std::string last_;
};

// Adds the moment if any camera's view of it takes part; says whether.
bool AddMoment(const FrameSet& set, const std::vector<vision::BoardDetection>& detections,
               vision::ViewChooser& chooser, calibration::CalibrationInput& input) {
  const std::vector<vision::ViewVerdict> verdicts = chooser.Add(detections);
  calibration::CalibrationView view;
  view.name = fmt::format("{:.3f} s", set.time_s);
  view.seen.resize(verdicts.size());
  bool any = false;
  for (size_t c = 0; c < verdicts.size(); ++c) {
    if (!verdicts[c].kept()) continue;
    view.seen[c] = detections[c].view;
    any = true;
  }
  if (any) input.views.push_back(std::move(view));
  return any;
}

// What there was when the collecting ended.
struct Collected {
  Guidance guidance;    // of the coverage alone
  Certainty certainty;  // not known if the coverage was not complete
};

// Where a camera is least certain.
WantedPose PoseAgainst(const Certainty& certainty, const calibration::CalibrationInput& input,
                       const GuideOptions& guide) {
  WantedPose pose;
  pose.camera = certainty.camera;
  const calibration::CameraToCalibrate& camera = input.cameras[certainty.camera];
  const auto part = [](double pixel, int size, int parts) {
    return std::clamp(static_cast<int>((pixel + 0.5) / size * parts), 0, parts - 1);
  };
  pose.column = part(certainty.worst.x(), camera.width, guide.columns);
  pose.row = part(certainty.worst.y(), camera.height, guide.rows);
  return pose;
}

class Collector {
 public:
  Collector(const CalibrateOptions& options, const GuideOptions& guide,
            calibration::CalibrationInput* input)
      : options_(options),
        guide_(guide),
        input_(*input),
        chooser_(options.choose),
        watch_(options) {}

  Collected Collect(vision::FrameSource& source) {
    const StopWatch stop(options_.calibration.stop, source);
    while (const std::optional<FrameSet> set = source.Next()) {
      for (size_t c = 0; c < input_.cameras.size(); ++c) {
        input_.cameras[c].width = set->pictures[c].cols;
        input_.cameras[c].height = set->pictures[c].rows;
      }
      for (const std::string& message : source.TakeMessages()) line_.Say(message);
      AddMoment(*set, DetectBoards(options_, set->pictures), chooser_, input_);
      if (Enough()) break;
    }
    if (options_.show_progress) line_.Finish();
    return collected_;
  }

 private:
  // Whether the collecting may end; tells what is wanted next.
  bool Enough() {
    collected_.guidance = NextPose(input_, guide_);
    Guidance next = collected_.guidance;
    std::string sure;
    if (!next.next) {
      collected_.certainty = watch_.Of(input_);
      const Certainty& certainty = collected_.certainty;
      if (certainty.Within(guide_.max_uncertainty_px)) return true;
      if (static_cast<int>(input_.views.size()) >= guide_.max_views) return true;
      if (certainty.known) {
        next.next = PoseAgainst(certainty, input_, guide_);
        sure = fmt::format(", uncertain by {:.2f} px, wanted {:.2f}", certainty.sd_px,
                           guide_.max_uncertainty_px);
      } else {
        sure = ", not calibrated yet: " + certainty.reason;
      }
    }
    if (options_.show_progress) {
      const std::string pose =
          next.next ? next.Text(input_, guide_) : "any other place, tilted by 30 to 45 degrees";
      line_.Show(fmt::format("{:3.0f} %, {} views{}; next: {}", std::floor(100 * next.done),
                             input_.views.size(), sure, pose));
    }
    return false;
  }

  const CalibrateOptions& options_;
  const GuideOptions& guide_;
  calibration::CalibrationInput& input_;
  vision::ViewChooser chooser_;
  CertaintyWatch watch_;
  GuideLine line_;
  Collected collected_;
};

// What was not reached, in the finished calibration.
void AdviseOnEnd(const Collected& collected, const GuideOptions& guide,
                 report::CalibrationRecord* record) {
  using Kind = calibration::Advice::Kind;
  calibration::Calibration& result = record->result;
  if (!result.ok()) return;
  if (collected.guidance.next) {
    result.advice.push_back(
        {Kind::kEndedEarly, collected.guidance.next->camera,
         fmt::format("the collecting ended at {:.0f} % of the coverage that is wanted",
                     std::floor(100 * collected.guidance.done)),
         "Next would have been: " + collected.guidance.Text(record->input, guide) + "."});
  }
  const Certainty certainty = CertaintyOf(result);
  if (certainty.Within(guide.max_uncertainty_px)) return;
  const WantedPose pose = PoseAgainst(certainty, record->input, guide);
  result.advice.push_back(
      {Kind::kUncertainProjection, certainty.camera,
       fmt::format("{}, wanted are at most {:.2f} px", certainty.Text(record->input),
                   guide.max_uncertainty_px),
       "Take more views, first with the board at the " + RegionText(pose, guide) +
           " of the picture, and tilted. If that does not help: a board with more points, sharper "
           "pictures, or a lens model with fewer parameters."});
}

}  // namespace

report::CalibrationRecord CalibrateLive(vision::FrameSource& source,
                                        const std::vector<std::string>& cameras,
                                        const CalibrateOptions& options,
                                        const GuideOptions& guide) {
  options.board.Check();
  options.detection.Check();
  options.choose.Check();
  options.calibration.Check();
  guide.Check();
  report::CalibrationRecord record;
  record.board = options.board;
  record.input.board = options.board.Points();
  for (const std::string& name : cameras)
    record.input.cameras.push_back({name, 0, 0, options.lens});
  const Collected collected = Collector(options, guide, &record.input).Collect(source);
  if (record.input.cameras.empty() || record.input.cameras[0].width == 0) {
    record.result.status = calibration::Calibration::Status::kTooFewViews;
    record.result.reason = "no pictures of all cameras at one moment came";
    record.result.what_to_do = source.Report().FullReport();
    return record;
  }
  calibration::CalibrationOptions calibration = options.calibration;
  calibration.stop = nullptr;  // it ended the collecting, not the work on what was collected
  record.result = calibration::Calibrate(record.input, calibration);
  AdviseOnEnd(collected, guide, &record);
  return record;
}

}  // namespace softforce::pipeline
