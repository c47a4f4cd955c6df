#include <gtest/gtest.h>

#include "acceptance/board_scene.h"
#include "softforce/pipeline/calibrate.h"

namespace softforce::pipeline {
namespace {

using softforce::testing::BoardPlace;
using softforce::testing::BoardScene;
using softforce::testing::GoodPlaces;

// A pair of cameras before which a board is shown in one place after the other, each for so many
// moments.
class ShownBoard : public vision::FrameSource {
 public:
  ShownBoard(std::vector<BoardPlace> places, int moments) : moments_(moments) {
    const BoardScene scene = softforce::testing::MakeChessboard(9, 6);
    for (const BoardPlace& place : places) {
      sets_.push_back({scene.Picture(place.turn, place.middle, false),
                       scene.Picture(place.turn, place.middle, true)});
    }
  }

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

TEST(CalibrateLive, TakesAViewOfEveryPlaceOnceAndCalibrates) {
  ShownBoard source(GoodPlaces(), 3);
  const report::CalibrationRecord record = CalibrateLive(source, {"left", "right"}, Options());

  ASSERT_TRUE(record.result.ok()) << record.result.reason;
  EXPECT_EQ(record.input.views.size(), GoodPlaces().size());
  EXPECT_EQ(record.input.cameras[1].width, 640);
  // px; as for pictures from files
  EXPECT_NEAR(record.result.rig.cameras[0].lens.fx, BoardScene::kFocal, 0.7);
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
  ShownBoard source(GoodPlaces(), 2);
  const std::atomic<bool> stop{true};  // the source here ends by itself
  CalibrateOptions options = Options();
  options.calibration.stop = &stop;
  const report::CalibrationRecord record = CalibrateLive(source, {"left", "right"}, options);

  EXPECT_TRUE(record.result.ok()) << record.result.reason;
}

TEST(CalibrateLive, SaysThatNothingWasSeen) {
  ShownBoard source({}, 1);
  const report::CalibrationRecord record = CalibrateLive(source, {"left", "right"}, Options());

  EXPECT_FALSE(record.result.ok());
  EXPECT_FALSE(record.result.reason.empty());
}

}  // namespace
}  // namespace softforce::pipeline
