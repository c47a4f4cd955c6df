#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

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

void CollectViews(vision::FrameSource& source, const CalibrateOptions& options,
                  const GuideOptions& guide, calibration::CalibrationInput& input) {
  const StopWatch watch(options.calibration.stop, source);
  vision::ViewChooser chooser(options.choose);
  GuideLine line;
  while (const std::optional<FrameSet> set = source.Next()) {
    for (size_t c = 0; c < input.cameras.size(); ++c) {
      input.cameras[c].width = set->pictures[c].cols;
      input.cameras[c].height = set->pictures[c].rows;
    }
    for (const std::string& message : source.TakeMessages()) line.Say(message);
    AddMoment(*set, DetectBoards(options, set->pictures), chooser, input);
    const Guidance guidance = NextPose(input, guide);
    if (options.show_progress) {
      line.Show(fmt::format("{:3.0f} %, {} views; next: {}", std::floor(100 * guidance.done),
                            input.views.size(), guidance.Text(input, guide)));
    }
    if (!guidance.next) break;
  }
  if (options.show_progress) line.Finish();
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
  CollectViews(source, options, guide, record.input);
  if (record.input.cameras.empty() || record.input.cameras[0].width == 0) {
    record.result.status = calibration::Calibration::Status::kTooFewViews;
    record.result.reason = "no pictures of all cameras at one moment came";
    record.result.what_to_do = source.Report().FullReport();
    return record;
  }
  calibration::CalibrationOptions calibration = options.calibration;
  calibration.stop = nullptr;  // it ended the collecting, not the work on what was collected
  record.result = calibration::Calibrate(record.input, calibration);
  return record;
}

}  // namespace softforce::pipeline
