#pragma once

#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/body_views.h"
#include "pipeline/frame_pipeline.h"
#include "softforce/pipeline/world.h"
#include "softforce/report/run_report.h"

namespace softforce::pipeline {

// What report.html tells of the frames of a run, gathered frame by frame. Its memory does not grow
// with the number of frames: charts are joined to columns, the body is kept in evenly spread frames
// and in key frames, pictures in key frames only.
class ReportLog {
 public:
  static constexpr int kMaxForces = 12;      // that the charts show
  static constexpr double kViewBytes = 3e6;  // that the body's views may take
  static constexpr int kMinViews = 8, kMaxViews = 150;

  explicit ReportLog(const World& world);

  void Add(const FrameInWork& frame);

  // Sets all that the record shows of frames: charts, pictures and views.
  void Fill(report::RunRecord* record) const;

  // How often each marker had each status: frames[marker][status].
  const std::vector<std::array<int, 4>>& marker_frames() const { return marker_frames_; }
  const std::vector<int>& marker_ids() const { return marker_ids_; }

 private:
  struct KeyFrame {
    std::string label;
    report::BodyView view;
    cv::Mat picture;  // empty: none is drawn
  };

  report::RunColumn ColumnOf(const FrameResult& result);
  void KeepKeyFrames(const FrameInWork& frame);
  void KeepView(const FrameInWork& frame);
  std::vector<KeyFrame> KeyFrames() const;  // in the order of the frames, each once

  const World& world_;
  const BodyViews body_;
  size_t max_views_;

  report::RunColumns columns_;
  std::vector<std::string> forces_;
  std::map<std::string, int> left_out_;  // forces that found no room
  std::vector<int> marker_ids_;
  std::vector<std::array<int, 4>> marker_frames_;

  int frames_ = 0;
  int stride_ = 1;  // between the frames of views_
  std::vector<report::BodyView> views_;
  std::optional<KeyFrame> first_, largest_, without_forces_, rejected_, last_;
  double largest_norm_ = 0;  // N
};

}  // namespace softforce::pipeline
