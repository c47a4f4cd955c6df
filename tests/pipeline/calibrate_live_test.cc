#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "acceptance/board_scene.h"
#include "pipeline/certainty.h"
#include "softforce/pipeline/calibrate.h"

namespace softforce::pipeline {
namespace {

namespace fs = std::filesystem;

using softforce::testing::BoardPlace;
using softforce::testing::BoardScene;
using softforce::testing::GoodPlaces;

const fs::path kRealPictures = "/usr/share/doc/opencv-doc/examples/data";

// A pair of cameras before which a board is shown in one place after the other, each for so many
// moments.
class ShownBoard : public vision::FrameSource {
 public:
  ShownBoard(const std::vector<BoardPlace>& places, int moments) : moments_(moments) {
    const BoardScene scene = softforce::testing::MakeChessboard(9, 6);
    for (const BoardPlace& place : places) {
      sets_.push_back({scene.Picture(place.turn, place.middle, false),
                       scene.Picture(place.turn, place.middle, true)});
    }
  }
  ShownBoard(std::vector<std::vector<cv::Mat>> sets, int moments)
      : sets_(std::move(sets)), moments_(moments) {}

  std::optional<vision::FrameSet> Next() override {
    const int place = next_ / moments_;
    if (place >= static_cast<int>(sets_.size())) return std::nullopt;
    vision::FrameSet set;
    set.frame = next_++;
    set.time_s = set.frame / 30.0;
    set.pictures = sets_[place];
    set.camera_time_s = {set.time_s, set.time_s};
    return set;
  }
  bool live() const override { return true; }
  int announced_frames() const override { return 0; }
  void Stop() override {}
  vision::SourceReport Report() const override { return {}; }
  std::vector<std::string> TakeMessages() override { return {}; }

  int given() const { return next_; }

 private:
  std::vector<std::vector<cv::Mat>> sets_;
  int moments_, next_ = 0;
};

CalibrateOptions Options() {
  CalibrateOptions options;
  options.board = vision::ParseBoard("chessboard:9x6,square=20mm");
  options.lens = calibration::LensFit::kBrownConrady4;
  options.calibration.max_folds = 0;  // to save time; the acceptance tests hold views out
  options.show_progress = false;
  return options;
}

bool Advises(const report::CalibrationRecord& record, calibration::Advice::Kind kind) {
  const auto& advice = record.result.advice;
  return std::any_of(advice.begin(), advice.end(),
                     [&](const calibration::Advice& given) { return given.kind == kind; });
}

TEST(CalibrateLive, TakesAViewOfEveryPlaceOnceAndCalibrates) {
  ShownBoard source(GoodPlaces(), 2);
  const report::CalibrationRecord record = CalibrateLive(source, {"left", "right"}, Options());

  ASSERT_TRUE(record.result.ok()) << record.result.reason;
  EXPECT_EQ(record.input.views.size(), GoodPlaces().size());
  EXPECT_EQ(record.input.cameras[1].width, 640);
  // px; as for pictures from files
  EXPECT_NEAR(record.result.rig.cameras[0].lens.fx, BoardScene::kFocal, 0.7);
  // Ten views are fewer than are wanted.
  EXPECT_TRUE(Advises(record, calibration::Advice::Kind::kEndedEarly));
}

TEST(CalibrateLive, EndsByItselfWhenEnoughHasBeenSeen) {
  ShownBoard source(GoodPlaces(), 2);
  GuideOptions guide;
  guide.columns = guide.rows = 1;
  guide.views_per_tilt = 1;
  guide.min_views = 6;
  const report::CalibrationRecord record =
      CalibrateLive(source, {"left", "right"}, Options(), guide);

  EXPECT_TRUE(record.result.ok()) << record.result.reason;
  EXPECT_LT(source.given(), 20);
}

TEST(CalibrateLive, CalibratesWithWhatThereIsWhenStopped) {
  std::vector<BoardPlace> places = GoodPlaces();
  places.resize(6);
  ShownBoard source(places, 2);
  const std::atomic<bool> stop{true};  // the source here ends by itself
  CalibrateOptions options = Options();
  options.calibration.stop = &stop;
  const report::CalibrationRecord record = CalibrateLive(source, {"left", "right"}, options);

  EXPECT_TRUE(record.result.ok()) << record.result.reason;
}

TEST(CalibrateLive, SaysThatNothingWasSeen) {
  ShownBoard source(std::vector<BoardPlace>(), 1);
  const report::CalibrationRecord record = CalibrateLive(source, {"left", "right"}, Options());

  EXPECT_FALSE(record.result.ok());
  EXPECT_FALSE(record.result.reason.empty());
}

constexpr size_t kRealPairs = 13;

// Real pictures of a pair of cameras, each shown once, the last first: these cover more.
ShownBoard RealPictures() {
  std::vector<std::vector<cv::Mat>> sets;
  for (int i = 14; i >= 1; --i) {
    if (i == 10) continue;  // there is none
    std::vector<cv::Mat> set;
    for (const char* side : {"left", "right"}) {
      const fs::path file = kRealPictures / fmt::format("{}{:02}.jpg", side, i);
      set.push_back(cv::imread(file.string(), cv::IMREAD_GRAYSCALE));
    }
    sets.push_back(set);
  }
  return {sets, 1};
}

// What the real pictures cover soon.
GuideOptions EasyCoverage() {
  GuideOptions guide;
  guide.columns = guide.rows = 1;
  guide.views_per_tilt = 1;
  guide.tilt = 0.02;
  guide.min_views = 4;
  return guide;
}

report::CalibrationRecord ShowReal(double max_uncertainty_px, int max_views = 60) {
  GuideOptions guide = EasyCoverage();
  guide.max_uncertainty_px = max_uncertainty_px;
  guide.max_views = max_views;
  CalibrateOptions options = Options();
  options.board = vision::ParseBoard("chessboard:9x6,square=25mm");
  options.calibration.working_distance = 0.4;
  options.choose.max_speed = 1e3;  // the board leaps from picture to picture
  ShownBoard source = RealPictures();
  return CalibrateLive(source, {"left", "right"}, options, guide);
}

class CalibrateLiveReal : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kRealPictures / "left01.jpg")) {
      GTEST_SKIP() << "no pictures of opencv-doc in " << kRealPictures;
    }
  }
};

TEST_F(CalibrateLiveReal, GoesOnUntilTheProjectionIsCertainEnough) {
  const report::CalibrationRecord covered = ShowReal(1e6);
  const report::CalibrationRecord certain = ShowReal(0.5);
  ASSERT_TRUE(certain.result.ok()) << certain.result.reason;
  EXPECT_GT(CertaintyOf(covered.result).sd_px, 0.5);
  EXPECT_GT(certain.input.views.size(), covered.input.views.size());
  EXPECT_LE(CertaintyOf(certain.result).sd_px, 0.5);
  for (const report::CalibrationRecord& record : {covered, certain}) {
    EXPECT_LT(record.input.views.size(), kRealPairs);  // it ended by itself
    EXPECT_FALSE(Advises(record, calibration::Advice::Kind::kUncertainProjection));
  }
}

TEST_F(CalibrateLiveReal, GivesUpAtTheMostViewsAndSaysWhatIsLacking) {
  const report::CalibrationRecord record = ShowReal(0.01, 12);
  ASSERT_TRUE(record.result.ok()) << record.result.reason;
  EXPECT_EQ(record.input.views.size(), 12);
  EXPECT_TRUE(Advises(record, calibration::Advice::Kind::kUncertainProjection));
  EXPECT_FALSE(Advises(record, calibration::Advice::Kind::kEndedEarly));
}

}  // namespace
}  // namespace softforce::pipeline
