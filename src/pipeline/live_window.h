#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "pipeline/marker_source.h"
#include "pipeline/viewer_painter.h"

namespace softforce::pipeline {

// Shows a run in a window while it goes on, with keys that are shown below the pictures. It has a
// thread of its own, of low priority, which draws the newest frame and skips the others: the run
// waits for nobody. Closing the window does not end the run.
class LiveWindow {
 public:
  // All must outlive it. Throws InputError if there is no display, or nothing to see.
  LiveWindow(const RunOptions& options, const scene::Scene& scene, const World& world,
             const MarkerSource& source);
  ~LiveWindow();  // closes the window

  // The frames in their order.
  void Show(const FrameInWork& frame);

 private:
  void Work();
  void Press(int key, const cv::Mat& shown);
  cv::Mat Page(const cv::Mat& picture, int frame) const;
  std::string Note(int frame) const;
  double Rate() const;  // frames per second

  const RunOptions& options_;
  const std::string title_;
  ViewerPainter painter_;

  mutable std::mutex mutex_;
  std::shared_ptr<const FrameInWork> newest_;
  FrameRate rate_;
  bool closing_ = false;

  int screenshots_ = 0;  // of the window's thread, as what follows
  std::string said_;     // about the last key
  std::thread thread_;
};

}  // namespace softforce::pipeline
