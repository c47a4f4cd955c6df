#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "pipeline/body_views.h"
#include "pipeline/live_state.h"
#include "pipeline/marker_source.h"
#include "pipeline/stage_clock.h"
#include "pipeline/viewer_painter.h"
#include "softforce/serve/broadcast.h"
#include "softforce/serve/live_page.h"

namespace softforce::pipeline {

// Shows a run on a page while it goes on. A frame costs the run a copy of its results; pictures are
// drawn and compressed by a thread of low priority, from the newest frame, and only while somebody
// looks.
class LiveView {
 public:
  // All must outlive it. Throws InputError if the port cannot be had.
  LiveView(const RunOptions& options, const scene::Scene& scene, const World& world,
           const MarkerSource& source, const StageClock& clock);
  ~LiveView();

  // The frames in their order; does not wait for anybody.
  void Show(const FrameInWork& frame);

  // After the last frame. Those who look are given a moment to learn how it ended.
  void End(const RunReport& report);

  std::string Url() const { return page_->Url(); }
  const std::string& token() const { return token_; }

 private:
  using Clock = std::chrono::steady_clock;

  std::map<std::string, serve::PageFile> Files() const;
  std::map<std::string, serve::LivePage::Control> Controls() const;
  LiveFacts Facts();  // with the mutex held
  void Publish();
  void Work();

  const RunOptions& options_;
  const scene::Scene& scene_;
  const MarkerSource& source_;
  const StageClock& clock_;
  const std::string token_, run_;
  const BodyViews body_;
  std::optional<ViewerPainter> painter_;  // nothing: there are no pictures

  std::mutex mutex_;
  std::condition_variable ended_here_, end_shown_here_;
  std::shared_ptr<const FrameInWork> newest_;
  LiveHistory history_;
  FrameRate rate_;
  int processed_ = 0;
  double latency_ms_ = 0;
  std::string ended_;
  bool usable_ = false, closing_ = false, end_shown_ = false;

  serve::Broadcast broadcast_;
  std::optional<serve::LivePage> page_;
  std::thread thread_;
};

}  // namespace softforce::pipeline
