#include "softforce/vision/recorder.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include "softforce/base/input_error.h"
#include "softforce/vision/recording.h"
#include "vision/video_files.h"

namespace softforce::vision {
namespace {

namespace fs = std::filesystem;
using softforce::testing::RigOf;
using softforce::testing::TempFolder;
using ::testing::HasSubstr;

const cv::Size kSize(320, 240);
const std::vector<std::string> kCameras{"left", "right"};

// Every grey level, at random: nothing that a codec could round goes unseen.
cv::Mat NoisePicture(int frame, int camera, cv::Size size = kSize) {
  cv::Mat picture(size, CV_8UC1);
  cv::RNG random(static_cast<uint64_t>(100 * frame + camera + 1));
  random.fill(picture, cv::RNG::UNIFORM, 0, 256);
  return picture;
}

// Times that no decimal of few digits can say.
double TimeOf(int frame) { return frame / 30.0 + 1e-4 * std::sin(frame); }

FrameSet SetOf(int frame) {
  FrameSet set;
  set.frame = frame;
  set.time_s = TimeOf(frame) - TimeOf(0);
  for (int c = 0; c < 2; ++c) {
    set.pictures.push_back(NoisePicture(frame, c));
    set.camera_time_s.push_back(set.time_s + c * 1.25e-3);
  }
  return set;
}

void Record(const fs::path& folder, int frames, double segment_s = 0.2) {
  RecorderOptions options;
  options.segment_s = segment_s;
  options.queue = frames + 1;  // nothing is dropped here
  options.longest_wait_s = 1e9;
  Recorder recorder(folder, kCameras, options);
  for (int k = 0; k < frames; ++k) recorder.Add(SetOf(k));
  recorder.Finish();
}

Recording Play(const fs::path& folder) {
  return Recording(RigOf(kSize), {{"left", folder / "left"}, {"right", folder / "right"}});
}

void ExpectSet(const FrameSet& got, int k) {
  const FrameSet expected = SetOf(k);
  EXPECT_EQ(got.frame, k);
  EXPECT_EQ(got.time_s, expected.time_s) << k;  // to the last bit
  EXPECT_EQ(got.camera_time_s, expected.camera_time_s) << k;
  ASSERT_EQ(got.pictures.size(), 2u);
  for (int c = 0; c < 2; ++c) {
    EXPECT_EQ(cv::norm(got.pictures[c], expected.pictures[c], cv::NORM_INF), 0) << k;
  }
}

std::string ReadText(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(Recorder, KeepsEveryBitAndEveryTimeOverManySegments) {
  const fs::path folder = TempFolder() / "recorded";
  Record(folder, 20);

  Recording recording = Play(folder);

  EXPECT_EQ(recording.announced_frames(), 20);
  for (int k = 0; k < 20; ++k) {
    const auto set = recording.Next();
    ASSERT_TRUE(set) << k;
    ExpectSet(*set, k);
  }
  EXPECT_FALSE(recording.Next());
  EXPECT_EQ(recording.Report().truncation, "");
  EXPECT_TRUE(recording.TakeMessages().empty());
  EXPECT_TRUE(fs::exists(folder / "left" / "000002.mkv"));
  EXPECT_THAT(ReadText(folder / "recording.yaml"), HasSubstr("complete: true"));
}

TEST(Recorder, ARecordingPlaysAgainFromTheStart) {
  const fs::path folder = TempFolder() / "recorded";
  Record(folder, 9);
  Recording recording = Play(folder);
  for (int k = 0; k < 8; ++k) recording.Next();

  recording.Rewind();

  const auto set = recording.Next();
  ASSERT_TRUE(set);
  ExpectSet(*set, 0);
}

TEST(Recorder, DropsNothingWhenToldToWait) {
  RecorderOptions options;
  options.queue = 1;
  options.wait = true;
  const fs::path folder = TempFolder() / "recorded";
  Recorder recorder(folder, kCameras, options);
  for (int k = 0; k < 30; ++k) recorder.Add(SetOf(k));
  recorder.Finish();

  EXPECT_EQ(recorder.Report().dropped, 0);
  EXPECT_EQ(Play(folder).announced_frames(), 30);
}

TEST(Recorder, CountsWhatItCannotWriteInTime) {
  RecorderOptions options;
  options.queue = 2;
  const fs::path folder = TempFolder() / "recorded";
  Recorder recorder(folder, kCameras, options);
  for (int k = 0; k < 200; ++k) recorder.Add(SetOf(0));
  recorder.Finish();

  const RecorderReport report = recorder.Report();
  EXPECT_EQ(report.written + report.dropped, 200);
  EXPECT_EQ(Play(folder).announced_frames(), report.written);
}

// What a kill can cost is bounded in time, at whatever rate pictures come.
TEST(Recorder, KeepsNoSetWaitingForLong) {
  RecorderOptions options;
  options.queue = 1000;
  options.longest_wait_s = 0.25;
  Recorder recorder(TempFolder() / "recorded", kCameras, options);
  FrameSet set = SetOf(0);
  for (auto& picture : set.pictures) picture = NoisePicture(0, 0, {1280, 1024});
  for (int k = 0; k < 200; ++k) {  // far faster than they can be compressed
    set.time_s = 0.1 * k;
    recorder.Add(set);
    EXPECT_LE(recorder.Report().queued, 3);  // those of 0.25 s
  }
  recorder.Finish();
  EXPECT_EQ(recorder.Report().written + recorder.Report().dropped, 200);
  EXPECT_GT(recorder.Report().dropped, 0);
}

std::string RefusalOf(const fs::path& folder, const std::vector<std::string>& cameras) {
  try {
    Recorder recorder(folder, cameras);
    ADD_FAILURE() << "accepted";
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RecorderRefusal, OverwritesNothing) {
  const fs::path folder = TempFolder() / "recorded";
  Record(folder, 3);
  EXPECT_THAT(RefusalOf(folder, kCameras), HasSubstr("already holds a recording"));
  EXPECT_EQ(Play(folder).announced_frames(), 3);

  const fs::path other = TempFolder() / "other";
  fs::create_directories(other);
  std::ofstream(other / "thesis.tex") << "x";
  EXPECT_THAT(RefusalOf(other, kCameras), HasSubstr("not empty"));
  EXPECT_THAT(RefusalOf(other / "thesis.tex", kCameras), HasSubstr("is a file"));
}

TEST(RecorderRefusal, NamesCamerasThatCannotBeFolders) {
  const fs::path folder = TempFolder() / "recorded";
  EXPECT_THAT(RefusalOf(folder, {"left", "left"}), HasSubstr("two cameras are called \"left\""));
  EXPECT_THAT(RefusalOf(folder, {"a/b"}), HasSubstr("\"a/b\""));
  EXPECT_THAT(RefusalOf(folder, {".."}), HasSubstr("\"..\""));
  EXPECT_THAT(RefusalOf(folder, {}), HasSubstr("no camera"));
  EXPECT_FALSE(fs::exists(folder));
}

TEST(RecorderRefusal, NamesOptionsOutOfRange) {
  RecorderOptions options;
  options.segment_s = 0;
  EXPECT_THROW(options.Check(), base::InputError);
  options = {};
  options.queue = 0;
  EXPECT_THROW(options.Check(), base::InputError);
  options = {};
  options.longest_wait_s = 0;
  EXPECT_THROW(options.Check(), base::InputError);
}

class RecordedFolder : public ::testing::Test {
 protected:
  RecordedFolder() { Record(folder_, 15); }
  std::string PlayRefusal() {
    return softforce::testing::Refusal(RigOf(kSize),
                                       {{"left", folder_ / "left"}, {"right", folder_ / "right"}});
  }
  const fs::path folder_ = TempFolder() / "recorded";
};

TEST_F(RecordedFolder, NamesASegmentThatIsMissing) {
  fs::remove(folder_ / "right" / "000001.mkv");
  EXPECT_THAT(PlayRefusal(), HasSubstr("right/000001.mkv: this part of the recording is missing"));
}

TEST_F(RecordedFolder, NamesALineOfTimesThatIsNoneOfOurs) {
  std::ofstream(folder_ / "left" / "times.csv", std::ios::app) << "15,soon,0.5,2\n";
  EXPECT_THAT(PlayRefusal(), HasSubstr("times.csv: line 17"));
}

TEST_F(RecordedFolder, NamesAFolderThatIsNoRecording) {
  fs::remove(folder_ / "left" / "times.csv");
  EXPECT_THAT(PlayRefusal(), HasSubstr("left: is a folder without times.csv"));
}

TEST_F(RecordedFolder, SaysWhereASegmentIsDamaged) {
  const fs::path file = folder_ / "left" / "000001.mkv";
  fs::resize_file(file, fs::file_size(file) / 2);
  Recording recording = Play(folder_);
  while (recording.Next()) {
  }
  EXPECT_THAT(recording.Report().truncation, HasSubstr("left: ended after"));
}

// What a failure of the power leaves of the last segment: less than times.csv tells.
TEST_F(RecordedFolder, OfAnUnfinishedLastSegmentPlaysWhatIsThere) {
  std::string manifest = ReadText(folder_ / "recording.yaml");
  manifest.replace(manifest.find("complete: true"), 14, "complete: false");
  std::ofstream(folder_ / "recording.yaml") << manifest;
  const fs::path file = folder_ / "right" / "000002.mkv";
  fs::resize_file(file, fs::file_size(file) / 2);
  std::ofstream(folder_ / "left" / "times.csv", std::ios::app) << "15,0.5";

  Recording recording = Play(folder_);
  const int announced = recording.announced_frames();
  for (int k = 0; k < announced; ++k) {
    const auto set = recording.Next();
    ASSERT_TRUE(set) << k;
    ExpectSet(*set, k);
  }
  EXPECT_GE(announced, 12);  // two whole segments of 0.2 s
  EXPECT_LT(announced, 15);
  EXPECT_EQ(recording.Report().truncation, "");
  EXPECT_THAT(recording.TakeMessages(), ::testing::ElementsAre(HasSubstr("ended by force")));
}

// A recorder in a process of its own, which tells after each set that it handed over.
pid_t StartRecorder(const fs::path& folder, int tell) {
  const pid_t child = fork();
  if (child != 0) return child;
  RecorderOptions options;
  options.segment_s = 0.1;
  options.wait = true;  // set k is the k-th in the files
  Recorder recorder(folder, kCameras, options);
  for (int k = 0;; ++k) {
    recorder.Add(SetOf(k));
    // What had been recorded before this set was handed over must be found after a kill.
    const auto written = static_cast<int>(recorder.Report().written);
    if (write(tell, &written, sizeof written) != sizeof written) _exit(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST(Recorder, KilledAtAnyMomentLeavesARecordingOfAllThatWasWritten) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 8; ++trial) {
    const fs::path folder = TempFolder() / "recorded";
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = StartRecorder(folder, ends[1]);
    close(ends[1]);
    int written = 0;
    const int sets = 20 + static_cast<int>(random() % 40);  // handed over before the kill
    for (int k = 0; k < sets; ++k)
      ASSERT_EQ(read(ends[0], &written, sizeof written), sizeof written);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 10000));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    while (read(ends[0], &written, sizeof written) == sizeof written) {
    }
    close(ends[0]);

    Recording recording = Play(folder);
    EXPECT_GE(recording.announced_frames(), written);
    for (int k = 0; k < recording.announced_frames(); ++k) {
      const auto set = recording.Next();
      ASSERT_TRUE(set) << "trial " << trial << ", set " << k;
      ExpectSet(*set, k);
    }
    EXPECT_EQ(recording.Report().truncation, "");
  }
}

}  // namespace
}  // namespace softforce::vision
