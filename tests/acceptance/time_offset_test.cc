#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "acceptance/program.h"
#include "softforce/scene/rig_file.h"
#include "softforce/vision/recorder.h"
#include "softforce/vision/recording.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;
using ::testing::HasSubstr;

const Folder kDemo = Folder(SOFTFORCE_SOURCE_DIR) / "datasets/sheet_two_weights";
constexpr int kFrames = 40;
constexpr double kRate = 30;  // Hz

// One camera of the demo's rig at half the resolution, which is drawn in a quarter of the time.
camera::Rig HalfSize(const std::vector<int>& cameras) {
  const camera::Rig demo = scene::LoadRig(kDemo / "rig.yaml");
  camera::Rig rig;
  for (const int c : cameras) {
    camera::Camera camera = demo.cameras[c];
    camera.width /= 2;
    camera.height /= 2;
    camera.lens.fx /= 2;
    camera.lens.fy /= 2;
    camera.lens.cx = (camera.lens.cx + 0.5) / 2 - 0.5;
    camera.lens.cy = (camera.lens.cy + 0.5) / 2 - 0.5;
    rig.cameras.push_back(camera);
  }
  return rig;
}

std::string RigPlace() {
  const auto truth = nlohmann::json::parse(testing::ReadText(kDemo / "truth.json"));
  std::string rows;
  for (int i = 0; i < 4; ++i) {
    auto row = truth["cameras"]["left"]["T_camera_robot"][i].get<std::vector<double>>();
    if (i < 3) row[3] *= 1e-3;  // mm
    rows += fmt::format("      - [{}]\n", fmt::join(row, ", "));
  }
  return rows;
}

// The sheet as it swings, seen by one camera whose time stamps are late.
void Film(int camera, double late_s, const Folder& folder) {
  std::filesystem::create_directories(folder);
  const camera::Rig rig = HalfSize({camera});
  scene::SaveRig(rig, folder / "rig.yaml");
  std::filesystem::copy(kDemo / "sheet.msh", folder);
  std::string history;
  for (int i = 0; i <= 4 * kFrames; ++i) {
    const double stamp_s = i / (4 * kRate);
    const double force = 2.4 - 2.2 * std::cos(2 * M_PI * 0.9 * (stamp_s - late_s));  // N
    history +=
        fmt::format("{}{{time: {} s, force: 0 0 {} N}}", i == 0 ? "" : ", ", stamp_s, -force);
  }
  testing::WriteText(folder / "scene.yaml",
                     testing::ReadText(kDemo / "scene.yaml") +
                         fmt::format("simulation:\n"
                                     "  frames: {}\n"
                                     "  rate: {} Hz\n"
                                     "  seed: {}\n"
                                     "  mesh: {{refine: 0, order: 1}}\n"
                                     "  forces:\n"
                                     "    - {{candidate: 0, history: [{}]}}\n"
                                     "  rig:\n    T_rig_robot:\n{}",
                                     kFrames, kRate, camera + 1, history, RigPlace()));
  testing::Edit(folder / "scene.yaml", "{left: left.mp4, right: right.mp4}",
                fmt::format("{{{0}: {0}.mp4}}", rig.cameras[0].name));
  const testing::ProgramResult simulated = testing::RunProgram(
      fmt::format("simulate '{0}/scene.yaml' --out '{0}/recording'", folder.string()));
  ASSERT_EQ(simulated.exit_code, 0) << simulated.errors;
}

testing::ProgramResult FindClocks(const Folder& folder, const std::string& options = "") {
  return testing::RunProgram(
      fmt::format("register '{}' --clocks {}", (folder / "scene.yaml").string(), options));
}

// The right camera's stamps are late by more than a period: pictures of one number do not belong
// together.
TEST(TimeOffset, IsFoundFromTheSwingingBodyAndHeldByReplay) {
  constexpr double kLate = 0.0437;  // s
  const Folder folder = testing::FreshFolder("time_offset");
  Film(0, 0, folder / "a");
  Film(1, kLate, folder / "b");
  scene::SaveRig(HalfSize({0, 1}), folder / "rig.yaml");
  std::filesystem::copy(kDemo / "sheet.msh", folder);
  std::filesystem::copy(kDemo / "scene.yaml", folder);
  std::filesystem::copy(folder / "a/recording/left.mp4", folder);
  std::filesystem::copy(folder / "b/recording/right.mp4", folder);

  const testing::ProgramResult found = FindClocks(folder, "--in-place");

  ASSERT_EQ(found.exit_code, 0) << found.output << found.errors;
  std::cout << found.output;
  const camera::Rig rig = scene::LoadRig(folder / "rig.yaml");
  const camera::Camera& right = rig.cameras[1];
  EXPECT_EQ(rig.cameras[0].time_offset_s, 0);
  EXPECT_NEAR(right.time_offset_s, kLate, 3 * right.time_offset_sd_s);
  EXPECT_LT(right.time_offset_sd_s, 0.5e-3);  // s; a fiftieth of a period

  // What was found is taken off now, and what is left is nothing.
  vision::Recording recording(rig,
                              {{"left", folder / "left.mp4"}, {"right", folder / "right.mp4"}});
  while (const auto set = recording.Next()) {
    EXPECT_LT(std::abs(set->camera_time_s[1] - set->camera_time_s[0]), 0.5 / kRate);
  }
  const testing::ProgramResult again =
      FindClocks(folder, fmt::format("-o '{}'", (folder / "again.yaml").string()));
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  // s; the same pictures, but for one or two at the ends.
  EXPECT_NEAR(scene::LoadRig(folder / "again.yaml").cameras[1].time_offset_s, right.time_offset_s,
              right.time_offset_sd_s);
}

TEST(TimeOffset, IsRefusedWhereNothingMoves) {
  const Folder demo = testing::CopyOfDemo("time_offset_still");
  const camera::Rig rig = scene::LoadRig(demo / "rig.yaml");
  vision::Recording recording(rig, {{"left", demo / "left.mp4"}, {"right", demo / "right.mp4"}});
  const vision::FrameSet still = recording.Next().value();
  vision::RecorderOptions options;
  options.wait = true;
  vision::Recorder recorder(demo / "still", {"left", "right"}, options);
  cv::RNG random(1);
  for (int k = 0; k < 30; ++k) {
    vision::FrameSet set;
    set.time_s = k / kRate;
    for (const cv::Mat& picture : still.pictures) {
      cv::Mat noise(picture.size(), CV_16SC1), noisy;
      random.fill(noise, cv::RNG::NORMAL, 0, 2);  // grey levels, as a camera's
      cv::add(picture, noise, noisy, cv::noArray(), CV_8U);
      set.pictures.push_back(noisy);
      set.camera_time_s.push_back(set.time_s);
    }
    recorder.Add(set);
  }
  recorder.Finish();
  const std::string before = testing::ReadText(demo / "rig.yaml");

  const testing::ProgramResult result =
      FindClocks(demo, fmt::format("--in-place --camera left='{0}/left' --camera right='{0}/right'",
                                   (demo / "still").string()));

  EXPECT_EQ(result.exit_code, 1) << result.output << result.errors;
  EXPECT_THAT(result.output, HasSubstr("too little motion"));
  EXPECT_THAT(result.output, HasSubstr("up and down"));
  EXPECT_EQ(testing::ReadText(demo / "rig.yaml"), before);
}

struct Refused {
  const char* name;
  const char* arguments;
  const char* named;
};

class RefusedClocks : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedClocks, InOneMessage) {
  const testing::ProgramResult result = testing::RunProgram(
      fmt::format("register '{}' {}", (kDemo / "scene.yaml").string(), GetParam().arguments));
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.errors, HasSubstr(GetParam().named));
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedClocks,
    ::testing::Values(Refused{"WithFrom", "--clocks --from markers", "--clocks"},
                      Refused{"DurationAlone", "--duration '4 s'", "--duration"},
                      Refused{"NoDuration", "--clocks --duration '0 s'", "--duration"},
                      Refused{"UnknownCamera", "--clocks --time-offset top='4 ms'", "\"top\""},
                      Refused{"SearchNothing", "--clocks --largest-offset '0 ms'", "longest_s"}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace softforce
