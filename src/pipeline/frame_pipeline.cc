#include "pipeline/frame_pipeline.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <opencv2/core/utility.hpp>

namespace softforce::pipeline {
namespace {

// While it lives, OpenCV works on the thread that calls it: the stages share out the cores.
class OneOpenCvThread {
 public:
  OneOpenCvThread() : before_(cv::getNumThreads()) { cv::setNumThreads(1); }
  ~OneOpenCvThread() { cv::setNumThreads(before_); }
  OneOpenCvThread(const OneOpenCvThread&) = delete;
  OneOpenCvThread& operator=(const OneOpenCvThread&) = delete;

 private:
  int before_;
};

// The frames in flight lie in a ring. They leave it in the order in which they entered, so the next
// one to enter always finds its place free.
class Belt {
 public:
  Belt(const FrameInput& input, const std::vector<Stage>& stages, int frames_in_flight,
       StageClock* clock)
      : input_(input),
        stages_(stages),
        clock_(clock),
        ring_(static_cast<size_t>(frames_in_flight)),
        waiting_(stages.size()) {}

  void Run() { tbb::parallel_pipeline(ring_.size(), Filters()); }

 private:
  using Filter = tbb::filter<FrameInWork*, FrameInWork*>;

  FrameInWork* Enter(tbb::flow_control* control) {
    FrameInWork* frame = &ring_[entered_ % ring_.size()];
    *frame = {};
    if (!clock_->Measure(input_.name, [&] { return input_.next(frame); })) {
      control->stop();
      return nullptr;
    }
    ++entered_;
    ++waiting_.front();
    return frame;
  }

  FrameInWork* Pass(size_t stage, FrameInWork* frame) {
    clock_->BookQueue(stages_[stage].name, --waiting_[stage]);
    clock_->Measure(stages_[stage].name, [&] { stages_[stage].work(frame); });
    if (stage + 1 < stages_.size()) ++waiting_[stage + 1];
    return frame;
  }

  tbb::filter<void, void> Filters() {
    auto filters = tbb::make_filter<void, FrameInWork*>(
        tbb::filter_mode::serial_in_order,
        [this](tbb::flow_control& control) { return Enter(&control); });
    for (size_t i = 0; i < stages_.size(); ++i) {
      const auto mode = stages_[i].order == Stage::Order::kAny ? tbb::filter_mode::parallel
                                                               : tbb::filter_mode::serial_in_order;
      filters = filters & tbb::make_filter<FrameInWork*, FrameInWork*>(
                              mode, [this, i](FrameInWork* frame) { return Pass(i, frame); });
    }
    return filters & tbb::make_filter<FrameInWork*, void>(tbb::filter_mode::serial_in_order,
                                                          [](FrameInWork*) {});
  }

  const FrameInput& input_;
  const std::vector<Stage>& stages_;
  StageClock* clock_;
  std::vector<FrameInWork> ring_;
  size_t entered_ = 0;
  std::vector<std::atomic<int>> waiting_;  // frames before each stage
};

}  // namespace

int DefaultThreads() { return tbb::info::default_concurrency(); }

void RunStages(const FrameInput& input, const std::vector<Stage>& stages, int threads,
               int frames_in_flight, StageClock* clock) {
  const OneOpenCvThread one_opencv_thread;
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(threads));
  tbb::task_arena arena(threads);
  Belt belt(input, stages, frames_in_flight, clock);
  arena.execute([&] { belt.Run(); });
}

}  // namespace softforce::pipeline
