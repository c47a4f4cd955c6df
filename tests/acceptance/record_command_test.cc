#include <fmt/format.h>

#include "acceptance/program.h"
#include "softforce/vision/recording.h"

namespace softforce {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::FreshFolder;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::ReadText;
using testing::RunCommand;
using testing::RunProgram;

// Two cameras without hardware.
std::string Cameras(int width = 320, int height = 240) {
  std::string text;
  for (const auto& [name, pattern] : {std::pair("left", "ball"), std::pair("right", "smpte")}) {
    text += fmt::format(
        " --camera {}=\"videotestsrc is-live=true pattern={} ! "
        "video/x-raw,width={},height={},framerate=30/1\"",
        name, pattern, width, height);
  }
  return text;
}

int FramesIn(const fs::path& folder) {
  camera::Rig rig;
  for (const char* name : {"left", "right"}) {
    camera::Camera camera;
    camera.name = name;
    camera.width = 320;
    camera.height = 240;
    rig.cameras.push_back(camera);
  }
  vision::Recording recording(rig, {{"left", folder / "left"}, {"right", folder / "right"}});
  int frames = 0;
  while (recording.Next()) ++frames;
  EXPECT_EQ(frames, recording.announced_frames());
  return frames;
}

TEST(RecordCommand, RecordsForTheTimeAsked) {
  const fs::path folder = FreshFolder("record") / "take";
  const ProgramResult result = RunProgram(fmt::format(
      "record{} --out '{}' --duration '1 s' --segment '0.5 s'", Cameras(), folder.string()));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("sets in"), HasSubstr("Replay: --camera left=")));
  EXPECT_THAT(ReadText(folder / "recording.yaml"), HasSubstr("complete: true"));
  EXPECT_GE(FramesIn(folder), 1);
  EXPECT_LE(FramesIn(folder), 32);  // 30 a second; one at each end
}

TEST(RecordCommand, EndsOnCtrlCWithCompleteFiles) {
  const fs::path folder = FreshFolder("record_stop") / "take";
  const ProgramResult result = RunCommand(
      fmt::format("timeout --foreground --preserve-status --signal=INT 3 '{}' record{} --out '{}'",
                  SOFTFORCE_PROGRAM, Cameras(), folder.string()));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(ReadText(folder / "recording.yaml"), HasSubstr("complete: true"));
  EXPECT_GE(FramesIn(folder), 1);
}

// The camera never gives a picture; waiting for it would end with exit code 2.
TEST(RecordCommand, EndsOnCtrlCWhileCamerasAreOpened) {
  const fs::path folder = FreshFolder("record_stop_early") / "take";
  const ProgramResult result = RunCommand(
      fmt::format("timeout --foreground --preserve-status --signal=INT 1 '{}' record --camera "
                  "left='videotestsrc is-live=true ! valve drop=true' --out '{}'",
                  SOFTFORCE_PROGRAM, folder.string()));
  EXPECT_EQ(result.exit_code, 1) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("No set of pictures was recorded"));
  EXPECT_FALSE(fs::exists(folder));
}

TEST(RecordCommand, OverwritesNothing) {
  const fs::path folder = FreshFolder("record_over");
  testing::WriteText(folder / "recording.yaml", "mine");
  const ProgramResult result =
      RunProgram(fmt::format("record{} --out '{}'", Cameras(), folder.string()));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("already holds a recording"));
  EXPECT_EQ(ReadText(folder / "recording.yaml"), "mine");
}

struct BadRecord {
  const char* name;
  std::string arguments;
  const char* message;
};
class RefusedRecord : public ::testing::TestWithParam<BadRecord> {};

TEST_P(RefusedRecord, EndsWithOneMessageAndNoFolder) {
  const fs::path folder = FreshFolder(std::string("record_bad_") + GetParam().name) / "take";
  const ProgramResult result = RunProgram(
      fmt::format("record --duration '1 s' --out '{}' {}", folder.string(), GetParam().arguments));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr(GetParam().message));
  EXPECT_FALSE(fs::exists(folder));
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, RefusedRecord,
    ::testing::Values(
        BadRecord{"Device", "--camera left=/dev/video97", "there is no device /dev/video97"},
        BadRecord{"NoCamera", "--camera left=/dev/null", "/dev/null is no camera"},
        BadRecord{"Url", "--camera left=tcp://127.0.0.1:9", "cannot be opened: Connection refused"},
        BadRecord{"File", "--camera left=left.mp4", "no live camera"},
        BadRecord{"Twice", "--camera left=0 --camera left=1", "camera \"left\" is given twice"},
        BadRecord{"SameSource", "--camera left=0 --camera right=0", "the same source"},
        BadRecord{"Form", "--camera left", "expected NAME=SOURCE"},
        BadRecord{"Size", Cameras() + " --size 1280x1024", "pictures are 320x240 px"},
        BadRecord{"SizeText", Cameras() + " --size big", "expected WIDTHxHEIGHT"},
        BadRecord{"Offset", Cameras() + " --time-offset top='4 ms'", "no camera \"top\""},
        BadRecord{"OffsetText", Cameras() + " --time-offset left", "expected NAME=TIME"},
        BadRecord{"Segment", Cameras() + " --segment '1 ms'", "--segment"},
        BadRecord{"Unit", Cameras() + " --tolerance 5", "--tolerance"}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace softforce
