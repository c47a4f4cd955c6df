#include "pipeline/live_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "softforce/report/live_page.h"
#include "softforce/serve/low_priority.h"
#include "softforce/serve/token.h"

namespace softforce::pipeline {
namespace {

constexpr std::chrono::milliseconds kShortestPeriod{67};   // between states
constexpr std::chrono::milliseconds kPeriodPerReader{25};  // but no less for each who looks
constexpr std::chrono::milliseconds kLongestPeriod{500};   // and where no frame comes
constexpr std::chrono::milliseconds kIdle{20};             // after which it is seen who looks
constexpr std::chrono::milliseconds kFarewell{1000};       // for readers to take the last state
constexpr std::chrono::seconds kLastState{10};             // for it to be made, at the longest
constexpr size_t kStageTimes = 200;                        // that percentiles are taken of
constexpr int kPictureWidth = 1280;                        // px
constexpr int kJpegQuality = 75;                           // %

std::string Jpeg(const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return {bytes.begin(), bytes.end()};
}

}  // namespace

LiveView::LiveView(const RunOptions& options, const scene::Scene& scene, const World& world,
                   const MarkerSource& source, const StageClock& clock)
    : options_(options),
      scene_(scene),
      source_(source),
      clock_(clock),
      token_(serve::MakeToken()),
      run_(serve::MakeToken()),
      body_(world) {
  if (!source.rig().cameras.empty()) {
    painter_.emplace(scene, world, source.rig(), kPictureWidth, options.layers);
  }
  serve::LivePageOptions page;
  page.port = *options.serve_port;
  page.token = token_;
  page_.emplace(page, Files(), Controls(), &broadcast_);
  thread_ = std::thread([this] { Work(); });
}

LiveView::~LiveView() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  ended_here_.notify_all();
  thread_.join();
}

std::map<std::string, serve::PageFile> LiveView::Files() const {
  const report::LivePageFiles files = report::MakeLivePage();
  return {{"/", {"text/html; charset=utf-8", files.html}},
          {"/page.css", {"text/css; charset=utf-8", files.style}},
          {"/page.js", {"text/javascript; charset=utf-8", files.script}},
          {"/view.js", {"text/javascript; charset=utf-8", files.view_script}},
          {"/shape", {"application/json", report::LiveShape(body_.shape(), MarkerStatusNames())}}};
}

std::map<std::string, serve::LivePage::Control> LiveView::Controls() const {
  RunControls* const controls = options_.controls;
  if (controls == nullptr) return {};
  return {{"tare", [controls] { ++controls->tares; }},
          {"record", [controls] { controls->record = !controls->recording; }},
          {"pause", [controls] { controls->pause = !controls->pause; }},
          {"stop", [controls] { controls->stop = true; }}};
}

void LiveView::Show(const FrameInWork& frame) {
  std::shared_ptr<const FrameInWork> copy = CopyForViewers(frame);
  if (painter_) painter_->Note(frame.result);
  const Clock::time_point now = Clock::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_ = std::move(copy);
  history_.Add(frame.result);
  ++processed_;
  latency_ms_ = std::chrono::duration<double, std::milli>(now - frame.taken_up).count();
  rate_.Add(now);
}

LiveFacts LiveView::Facts() {
  LiveFacts facts;
  facts.scene = scene_.name;
  facts.run = run_;
  facts.live = source_.live();
  facts.expected = source_.expected_frames();
  facts.processed = processed_;
  facts.latency_ms = latency_ms_;
  facts.ended = ended_;
  facts.usable = usable_;
  facts.pictures = painter_ ? 1 : 0;
  facts.rate = rate_.PerSecond(Clock::now());
  return facts;
}

void LiveView::Publish() {
  LiveFacts facts;
  std::shared_ptr<const FrameInWork> frame;
  std::deque<LivePoint> points;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    facts = Facts();
    frame = newest_;
    points = history_.points();
  }
  facts.stages = clock_.Report(kStageTimes);
  if (facts.live) facts.dropped = source_.Report().dropped;
  auto state = std::make_shared<serve::PageState>();
  state->json = LiveStateJson(facts, frame ? frame->result : FrameResult(), options_.controls);
  state->documents["history"] = LiveHistoryJson(points);
  if (frame) {
    state->documents["view"] = report::LiveView(body_.ViewOf(*frame));
    if (painter_) state->pictures.push_back(Jpeg(painter_->Draw(*frame)));
  }
  broadcast_.Publish(std::move(state));
}

void LiveView::Work() {
  serve::RunAtLowestPriority();
  const auto pause = [this](std::chrono::milliseconds longest) {
    std::unique_lock<std::mutex> lock(mutex_);
    const bool was_ended = !ended_.empty();
    ended_here_.wait_for(lock, longest,
                         [&] { return closing_ || (!was_ended && !ended_.empty()); });
    return !closing_;
  };
  const auto newest = [this] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::pair(newest_, !ended_.empty());
  };
  Publish();
  auto shown = newest();
  Clock::time_point last = Clock::now();
  while (true) {
    const int readers = broadcast_.readers();
    const auto next = newest();
    const bool same = next == shown && Clock::now() - last < kLongestPeriod;
    if (readers == 0 || same) {
      if (!pause(kIdle)) return;
      continue;
    }
    const Clock::time_point start = Clock::now();
    Publish();
    if (next.second) {
      const std::lock_guard<std::mutex> lock(mutex_);
      end_shown_ = true;
      end_shown_here_.notify_all();
    }
    shown = next;
    last = start;
    const auto took = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - start);
    const auto period = std::max(kShortestPeriod, readers * kPeriodPerReader);
    if (!pause(std::max(period - took, std::chrono::milliseconds(1)))) return;
  }
}

void LiveView::End(const RunReport& report) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = report.BriefReport();
    usable_ = report.usable;
  }
  ended_here_.notify_all();
  if (broadcast_.readers() == 0) return;
  {
    // Where no core is idle a thread of the lowest priority takes its time.
    std::unique_lock<std::mutex> lock(mutex_);
    end_shown_here_.wait_for(lock, kLastState, [this] { return end_shown_; });
  }
  std::this_thread::sleep_for(kFarewell);
}

}  // namespace softforce::pipeline
