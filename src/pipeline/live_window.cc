#include "pipeline/live_window.h"

#include <fmt/format.h>

#include <opencv2/highgui.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/display.h"
#include "softforce/base/input_error.h"
#include "softforce/serve/low_priority.h"

namespace softforce::pipeline {
namespace {

constexpr int kWidth = 1280;  // px, at most
constexpr int kKeyWait = 30;  // ms, between looks for keys and new frames
constexpr int kEscape = 27;
constexpr int kLine = 24;  // px
constexpr double kFontScale = 0.5;
const cv::Scalar kInk(235, 235, 235), kPaper(40, 40, 40);

const char* const kKeys = "P pause    T tare    R record    S screenshot    Q quit";

const camera::Rig& WithCameras(const MarkerSource& source) {
  if (source.rig().cameras.empty()) {
    throw base::InputError("--view", "there are no pictures to show: the scene has no cameras",
                           "Leave it out; the report has the forces and the body.");
  }
  const std::string why = WhyNoDisplay();
  if (!why.empty()) {
    throw base::InputError("--view", why,
                           "Run it where there is a screen, or show the run on a page: --serve.");
  }
  return source.rig();
}

void Write(cv::Mat* page, const std::string& text, int line) {
  cv::putText(*page, text, {8, page->rows - kLine * line + 17}, cv::FONT_HERSHEY_SIMPLEX,
              kFontScale, kInk, 1, cv::LINE_AA);
}

}  // namespace

LiveWindow::LiveWindow(const RunOptions& options, const scene::Scene& scene, const World& world,
                       const MarkerSource& source)
    : options_(options),
      title_("softforce: " + scene.name),
      painter_(scene, world, WithCameras(source), kWidth, options.layers) {
  thread_ = std::thread([this] { Work(); });
}

LiveWindow::~LiveWindow() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  thread_.join();
}

void LiveWindow::Show(const FrameInWork& frame) {
  painter_.Note(frame.result);
  std::shared_ptr<const FrameInWork> copy = CopyForViewers(frame);
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_ = std::move(copy);
  rate_.Add(FrameRate::Clock::now());
}

double LiveWindow::Rate() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return rate_.PerSecond(FrameRate::Clock::now());
}

std::string LiveWindow::Note(int frame) const {
  std::string note = fmt::format("frame {}    {:.1f} frames/s", frame, Rate());
  const RunControls* controls = options_.controls;
  if (controls != nullptr && controls->pause) note += "    PAUSED";
  if (controls != nullptr && controls->recording) note += "    RECORDING";
  if (controls != nullptr && controls->tared > 0) note += "    tared";
  return said_.empty() ? note : note + "    " + said_;
}

// The pictures, and below them what the keys do and how the run fares.
cv::Mat LiveWindow::Page(const cv::Mat& picture, int frame) const {
  cv::Mat page(picture.rows + 2 * kLine, picture.cols, CV_8UC3, kPaper);
  picture.copyTo(page.rowRange(0, picture.rows));
  Write(&page, Note(frame), 2);
  Write(&page, kKeys, 1);
  return page;
}

void LiveWindow::Press(int key, const cv::Mat& shown) {
  RunControls* const controls = options_.controls;
  if (key == 's') {
    const std::string name = fmt::format("screenshot-{}.png", ++screenshots_);
    const bool written = !shown.empty() && cv::imwrite((options_.out / name).string(), shown);
    said_ = written ? name : name + " cannot be written";
  }
  if (controls == nullptr) return;
  if (key == 'p') controls->pause = !controls->pause;
  if (key == 't') {
    ++controls->tares;
    said_ = "";
  }
  if (key == 'r') {
    said_ = controls->can_record ? "" : "there is nothing to record that is not recorded already";
    if (controls->can_record) controls->record = !controls->recording;
  }
  if (key == 'q' || key == kEscape) controls->stop = true;
}

void LiveWindow::Work() {
  serve::RunAtLowestPriority();
  cv::namedWindow(title_, cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL);
  cv::Mat picture, page(200, 640, CV_8UC3, kPaper);
  Write(&page, "waiting for the first frame", 2);
  std::shared_ptr<const FrameInWork> drawn;
  while (true) {
    std::shared_ptr<const FrameInWork> newest;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (closing_) break;
      newest = newest_;
    }
    if (newest && newest != drawn) picture = painter_.Draw(*newest);
    drawn = newest;
    if (drawn) page = Page(picture, drawn->result.frame);
    cv::imshow(title_, page);
    Press(cv::waitKey(kKeyWait), page);
    if (cv::getWindowProperty(title_, cv::WND_PROP_VISIBLE) < 1) return;
  }
  cv::destroyWindow(title_);
}

}  // namespace softforce::pipeline
