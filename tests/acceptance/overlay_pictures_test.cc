// Overlays beside reference pictures that were looked at. After an intended change:
//   SOFTFORCE_NEW_REFERENCES=1 build/release/tests/acceptance/acceptance_test
//   --gtest_filter='OverlayPictures.*'
// writes them anew; look at each before it is committed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "acceptance/program.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;

const Folder kSource = SOFTFORCE_SOURCE_DIR;
const Folder kReferences = kSource / "tests/acceptance/reference";
const Folder kDemo = kSource / "datasets/sheet_two_weights";
constexpr int kWidth = 960;  // px

// Forces and with them the last digits of labels may differ from machine to machine, and so may
// video codecs and fonts' edges; a layer that is gone, or is drawn elsewhere, differs by far more.
constexpr double kMeanDifference = 1.5;      // grey levels
constexpr double kLarge = 40;                // grey levels
constexpr double kLargelyDifferent = 0.004;  // share of the pixels

cv::Mat LastFrame(const Folder& video) {
  cv::VideoCapture capture(video.string());
  cv::Mat frame, last;
  while (capture.read(frame)) last = frame.clone();
  return last;
}

void Compare(const cv::Mat& picture, const std::string& name) {
  const Folder file = kReferences / (name + ".png");
  ASSERT_FALSE(picture.empty());
  if (std::getenv("SOFTFORCE_NEW_REFERENCES") != nullptr) {
    ASSERT_TRUE(cv::imwrite(file.string(), picture, {cv::IMWRITE_PNG_COMPRESSION, 9}));
    return;
  }
  const cv::Mat reference = cv::imread(file.string());
  ASSERT_EQ(picture.size(), reference.size()) << file;
  cv::Mat difference;
  cv::absdiff(picture, reference, difference);
  const cv::Scalar mean = cv::mean(difference);
  EXPECT_LT((mean[0] + mean[1] + mean[2]) / 3, kMeanDifference) << file;
  cv::Mat largest;
  cv::cvtColor(difference, largest, cv::COLOR_BGR2GRAY);
  const double share = cv::countNonZero(largest > kLarge) / static_cast<double>(largest.total());
  if (share >= kLargelyDifferent) {
    const Folder seen = testing::FreshFolder("overlay_picture_" + name) / "seen.png";
    cv::imwrite(seen.string(), picture);
    ADD_FAILURE() << file << ": " << 100 * share << " % of the pixels differ largely from " << seen;
  }
}

// The overlay in frame 25, of the hold.
cv::Mat Overlay(const Folder& scene, const std::string& name, const std::string& more,
                const std::string& frames = "--frames 23:26") {
  const Folder out = testing::FreshFolder("overlay_of_" + name);
  const testing::ProgramResult run =
      testing::RunProgram(fmt::format("run '{}' --out '{}' --overlay-width {} --no-report {} {}",
                                      scene.string(), out.string(), kWidth, frames, more));
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  return LastFrame(out / "overlay.mp4");
}

// The demo's videos after a filter of ffmpeg, as options of `run`.
std::string Filtered(const std::string& name, const std::string& left, const std::string& right) {
  const Folder folder = testing::FreshFolder("overlay_videos_" + name);
  std::string options;
  for (const auto& [camera, filter] : {std::pair("left", left), std::pair("right", right)}) {
    const Folder video = folder / (std::string(camera) + ".mkv");
    const testing::ProgramResult made = testing::RunCommand(
        fmt::format("ffmpeg -v error -y -i '{}' -vf '{}' -c:v ffv1 '{}'",
                    (kDemo / (std::string(camera) + ".mp4")).string(), filter, video.string()));
    EXPECT_EQ(made.exit_code, 0) << made.errors;
    options += fmt::format(" --camera {}='{}'", camera, video.string());
  }
  return options;
}

TEST(OverlayPictures, TwoForcesOnADarkSheet) {
  Compare(Overlay(kDemo / "scene.yaml", "two_forces", ""), "two_forces");
}

TEST(OverlayPictures, PlacesThatAreFoundHaveRegions) {
  Compare(Overlay(kDemo / "scene_unknown_places.yaml", "regions", "", "--frames 0:26 --every 5"),
          "regions");
}

TEST(OverlayPictures, HiddenMarkers) {
  const auto box = [](int x, int y) {
    return fmt::format("drawbox=x={}:y={}:w=36:h=36:t=fill:color=0x282828", x - 18, y - 18);
  };
  Compare(Overlay(kDemo / "scene.yaml", "hidden",
                  Filtered("hidden", box(698, 432) + "," + box(658, 544),
                           box(678, 454) + "," + box(632, 566))),
          "hidden");
}

TEST(OverlayPictures, OnALightPicture) {
  const std::string light = "lutyuv=y=255-0.5*(255-val)";
  Compare(Overlay(kDemo / "scene.yaml", "light", Filtered("light", light, light)), "light");
}

TEST(OverlayPictures, RobotWithCables) {
  const Folder scene = kSource / "../shared/recordings/robot_tip_weight/scene.yaml";
  if (!std::filesystem::exists(scene)) GTEST_SKIP() << scene << " is not there";
  Compare(Overlay(scene, "robot", ""), "robot");
}

}  // namespace
}  // namespace softforce
