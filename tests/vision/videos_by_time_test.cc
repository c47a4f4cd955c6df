#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "softforce/base/input_error.h"
#include "softforce/vision/live_cameras.h"
#include "softforce/vision/recorder.h"
#include "softforce/vision/recording.h"
#include "vision/video_files.h"

namespace softforce::vision {
namespace {

namespace fs = std::filesystem;
using softforce::testing::RigOf;
using softforce::testing::TempFolder;
using ::testing::HasSubstr;

constexpr double kPeriod = 1 / 30.0;  // s
const cv::Size kSize(320, 240);

// A recording in which the right camera's picture k shows what the left one's k − `lag` does: every
// pixel is as bright as the number of the moment. `corrected_s`: what it says of the right camera.
fs::path RecordWithLag(int lag, double corrected_s = 0) {
  const fs::path folder = TempFolder() / "take";
  RecorderOptions options;
  options.wait = true;
  options.time_offsets_s = {0, corrected_s};
  Recorder recorder(folder, {"left", "right"}, options);
  for (int k = 0; k < 20; ++k) {
    FrameSet set;
    set.time_s = k * kPeriod;
    for (const int moment : {k + 50, k + 50 - lag}) {
      set.pictures.emplace_back(kSize, CV_8UC1, cv::Scalar(moment));
      set.camera_time_s.push_back(set.time_s);
    }
    recorder.Add(set);
  }
  recorder.Finish();
  return folder;
}

std::vector<Recording::Source> SourcesIn(const fs::path& folder) {
  return {{"left", folder / "left"}, {"right", folder / "right"}};
}

// How many sets there are; fails the test if one is of two moments.
int SetsThatBelongTogether(Recording* recording) {
  int sets = 0;
  while (const auto set = recording->Next()) {
    EXPECT_EQ(set->frame, sets);
    EXPECT_EQ(set->pictures[0].at<uchar>(0, 0), set->pictures[1].at<uchar>(0, 0)) << sets;
    EXPECT_NEAR(set->time_s, sets * kPeriod, 1e-9);
    ++sets;
  }
  return sets;
}

TEST(Replay, PutsPicturesTogetherByTheTimeOffsetOfTheRig) {
  for (const int lag : {2, -3}) {
    const fs::path folder = RecordWithLag(lag);
    camera::Rig rig = RigOf(kSize);
    rig.cameras[1].time_offset_s = (lag + 0.2) * kPeriod;
    Recording recording(rig, SourcesIn(folder));

    EXPECT_EQ(recording.announced_frames(), 20 - std::abs(lag));
    EXPECT_EQ(SetsThatBelongTogether(&recording), 20 - std::abs(lag));
    EXPECT_EQ(recording.truncation(), "");
    recording.Rewind();
    EXPECT_EQ(SetsThatBelongTogether(&recording), 20 - std::abs(lag));
  }
}

TEST(Replay, DoesNotCorrectTwiceWhatWasCorrectedWhileRecording) {
  const fs::path folder = RecordWithLag(0, 2 * kPeriod);
  camera::Rig rig = RigOf(kSize);
  rig.cameras[1].time_offset_s = 2 * kPeriod;
  Recording recording(rig, SourcesIn(folder));
  EXPECT_EQ(SetsThatBelongTogether(&recording), 20);
}

// As after record --time-offset, with a rig file that knows nothing of it.
TEST(Replay, KeepsWhatWasCorrectedWhereTheRigSaysNothing) {
  const fs::path folder = RecordWithLag(0, 2 * kPeriod);
  Recording recording(RigOf(kSize), SourcesIn(folder));
  EXPECT_EQ(SetsThatBelongTogether(&recording), 20);
  EXPECT_EQ(recording.time_offsets_s()[1], 2 * kPeriod);
}

TEST(Replay, TakesTheOffsetThatIsGivenInsteadOfTheRigs) {
  const fs::path folder = RecordWithLag(2);
  camera::Rig rig = RigOf(kSize);
  rig.cameras[1].time_offset_s = 5;
  Recording recording(rig, SourcesIn(folder), {{"right", 2 * kPeriod}});
  EXPECT_EQ(SetsThatBelongTogether(&recording), 18);
}

TEST(Replay, KeepsTheNumbersWhereAllCamerasAreLateAlike) {
  const fs::path folder = RecordWithLag(0);
  camera::Rig rig = RigOf(kSize);
  for (camera::Camera& camera : rig.cameras) camera.time_offset_s = 0.04;
  Recording recording(rig, SourcesIn(folder));
  EXPECT_EQ(SetsThatBelongTogether(&recording), 20);
}

TEST(Replay, RefusesAnOffsetOfACameraThatIsNotThere) {
  const fs::path folder = RecordWithLag(0);
  try {
    Recording recording(RigOf(kSize), SourcesIn(folder), {{"top", 0.01}});
    FAIL() << "accepted";
  } catch (const base::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no camera \"top\""));
  }
}

TEST(LiveCamerasOf, TakesTimeOffsetsFromTheRigUnlessTheyAreGiven) {
  camera::Rig rig = RigOf(kSize);
  rig.cameras[0].time_offset_s = 0.003;
  rig.cameras[1].time_offset_s = 0.004;
  const std::map<std::string, std::string> sources{{"left", "0"}, {"right", "1"}};
  const auto cameras = LiveCamerasOf(rig, sources, {{"right", -0.001}});
  EXPECT_EQ(cameras[0].time_offset_s, 0.003);
  EXPECT_EQ(cameras[1].time_offset_s, -0.001);
}

}  // namespace
}  // namespace softforce::vision
