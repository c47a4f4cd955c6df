#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "acceptance/program.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;

const Folder kShared = Folder(SOFTFORCE_SOURCE_DIR) / "../shared/recordings";

// Mean norm of the force on a candidate over the hold frames of a run, N.
double HeldForce(const Folder& results, const std::string& candidate, int first, int last) {
  double sum = 0;
  int frames = 0;
  for (auto& row : testing::ReadTable(results / "forces.csv")) {
    const int frame = std::stoi(row["frame"]);
    if (row["candidate"] != candidate || frame < first || frame > last) continue;
    sum += std::stod(row["norm_N"]);
    ++frames;
  }
  EXPECT_EQ(frames, last - first + 1);
  return sum / frames;
}

void SetModulus(const Folder& scene, double kilopascals) {
  const std::string text = testing::ReadText(scene);
  const size_t at = text.find("youngs_modulus: ") + 16;
  testing::Edit(scene, text.substr(at, text.find(',', at) - at),
                fmt::format("{:.6g} kPa", kilopascals));
}

double ModulusIn(const Folder& scene) {  // kPa
  const std::string text = testing::ReadText(scene);
  return std::stod(text.substr(text.find("youngs_modulus: ") + 16));
}

// Young's modulus from one recording makes the forces of another one right.
TEST(Identify, YoungsModulusFromTagsMakesTheForcesOnDotsRight) {
  const Folder tags = kShared / "sheet_two_weights_tags";
  if (!std::filesystem::exists(tags)) GTEST_SKIP() << "no recording at " << tags;
  const Folder out = testing::FreshFolder("identify_tags");
  const testing::ProgramResult identified = testing::RunProgram(
      fmt::format("identify '{}' --weights '20:30: 0 = 0.559 N, 1 = 0.559 N' -o '{}'",
                  (tags / "scene.yaml").string(), (out / "tags.yaml").string()));
  ASSERT_EQ(identified.exit_code, 0) << identified.output << identified.errors;
  std::cout << identified.output;

  const Folder dots = testing::CopyOfDemo("identify_dots");  // sheet_two_weights of the recordings
  SetModulus(dots / "scene.yaml", ModulusIn(out / "tags.yaml"));
  const testing::ProgramResult run = testing::RunProgram(fmt::format(
      "run '{}' --out '{}' --no-overlay", (dots / "scene.yaml").string(), (out / "dots").string()));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const char* candidate : {"0", "1"}) {
    const double force = HeldForce(out / "dots", candidate, 20, 29);
    std::cout << "candidate " << candidate << ": " << force << " N of 0.559 N\n";
    EXPECT_NEAR(force / 0.559, 1, 0.01);  // the aim of an identified modulus, per cent
  }
}

TEST(Identify, AModulusThreeTimesTooLargeIsPutRight) {
  const Folder demo = testing::CopyOfDemo("identify_wrong");
  const Folder scene = demo / "scene.yaml";
  SetModulus(scene, 870);
  const testing::ProgramResult identified = testing::RunProgram(fmt::format(
      "identify '{}' --weights '29: 0 = 0.559 N, 1 = 0.559 N' --in-place", scene.string()));

  ASSERT_EQ(identified.exit_code, 0) << identified.output << identified.errors;
  EXPECT_NEAR(ModulusIn(scene), 285.5, 3);  // kPa; what a right start leads to, and one per cent
  EXPECT_NE(identified.output.find("The model fits"), std::string::npos) << identified.output;
}

TEST(Identify, CableOffsetAndModulusOfTheRobotFromAWrongStartMakeItsForcesRight) {
  const Folder robot = kShared / "robot_tip_weight";
  if (!std::filesystem::exists(robot)) GTEST_SKIP() << "no recording at " << robot;
  const Folder out = testing::FreshFolder("identify_robot");
  const Folder wrong = testing::FreshFolder("identify_robot_wrong");
  std::filesystem::copy(robot, wrong, std::filesystem::copy_options::recursive);
  for (const char* guide : {"guide: 5 0 6 mm,", "guide: 0 5 6 mm,"}) {
    testing::Edit(wrong / "scene.yaml", guide, std::string(guide) + " offset: 1.5 mm,");
  }
  const testing::ProgramResult identified = testing::RunProgram(fmt::format(
      "identify '{}' --weights '0:10: none' --weights '27: 0 = 0.859 N' --unknown youngs_modulus "
      "--unknown cable_offset --correct-mesh refined -o '{}'",
      (wrong / "scene.yaml").string(), (out / "robot.yaml").string()));
  ASSERT_EQ(identified.exit_code, 0) << identified.output << identified.errors;
  std::cout << identified.output;
  for (const char* cable : {"cable1", "cable2"}) {
    const std::string line = "offset of " + std::string(cable);
    const size_t at = identified.output.find(line);
    ASSERT_NE(at, std::string::npos);
    double start = NAN, value = NAN;  // mm
    std::sscanf(identified.output.c_str() + at + line.size(), "%lf -> %lf", &start, &value);
    EXPECT_EQ(start, 1.5);
    EXPECT_NEAR(value, 0, 0.02);  // five of its standard deviations
  }
  EXPECT_NE(identified.output.find("for runs with --correct-mesh refined"), std::string::npos);
  const testing::ProgramResult run = testing::RunProgram(
      fmt::format("run '{}' --out '{}' --no-overlay --correct-mesh refined --frames 9:30",
                  (out / "robot.yaml").string(), (out / "results").string()));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  // On the ramp, 15 steps of equal size, and in the hold after it: within a per cent of the force
  // itself, which is the aim of an identified modulus.
  for (int frame = 10; frame < 30; ++frame) {
    const double truth = 0.859 * std::min(frame - 9, 15) / 15;
    const double force = HeldForce(out / "results", "0", frame, frame);
    std::cout << "frame " << frame << ": " << force << " N of " << truth << " N\n";
    EXPECT_NEAR(force / truth, 1, 0.01) << "frame " << frame;
  }
}

TEST(Identify, OfWhatDoesNotShowIsNotUsable) {
  const Folder demo = testing::CopyOfDemo("identify_nothing");
  const std::string before = testing::ReadText(demo / "scene.yaml");
  const testing::ProgramResult identified = testing::RunProgram(
      fmt::format("identify '{}' --weights '0: none' --in-place", (demo / "scene.yaml").string()));
  EXPECT_EQ(identified.exit_code, 1);
  EXPECT_NE(identified.output.find("says next to nothing about Young's modulus"), std::string::npos)
      << identified.output;
  EXPECT_EQ(testing::ReadText(demo / "scene.yaml"), before);
}

TEST(Identify, AWeightThatIsStillBeingHungIsNotUsable) {
  const Folder demo = testing::CopyOfDemo("identify_ramp");
  const std::string before = testing::ReadText(demo / "scene.yaml");
  const testing::ProgramResult identified = testing::RunProgram(
      fmt::format("identify '{}' --weights '17:30: 0 = 0.559 N, 1 = 0.559 N' --in-place",
                  (demo / "scene.yaml").string()));
  EXPECT_EQ(identified.exit_code, 1) << identified.output;
  EXPECT_NE(identified.output.find("the body moves in frames 17 to 29"), std::string::npos)
      << identified.output;
  EXPECT_EQ(testing::ReadText(demo / "scene.yaml"), before);
}

TEST(Identify, RefusesBadInput) {
  const Folder demo = testing::CopyOfDemo("identify_refusals");
  const std::string scene = (demo / "scene.yaml").string();
  const auto refused = [&](const std::string& options, const char* says) {
    const testing::ProgramResult result =
        testing::RunProgram(fmt::format("identify '{}' {}", scene, options));
    EXPECT_EQ(result.exit_code, 2) << options;
    EXPECT_NE(result.errors.find(says), std::string::npos) << options << ": " << result.errors;
  };
  refused("", "--weights");
  testing::Edit(demo / "scene.yaml", "known: true", "known: false");
  refused("--weights '20:30: 0 = 1 N'", "known places only");
  testing::Edit(demo / "scene.yaml", "known: false", "known: true");
  refused("--weights '20:30: 5 = 1 N'", "no candidate \"5\"");
  refused("--weights '20:31: none'", "the recording has 30 frames");
  refused("--weights '29: none' --unknown stiffness", "expected youngs_modulus");
  refused("--weights '29: none' --unknown cable_offset", "has no cables");
  refused("--weights '29: none' --unknown youngs_modulus --unknown youngs_modulus", "twice");
  refused("--weights '29: none' --in-place -o other.yaml", "expected one of them");
  refused(fmt::format("--weights '29: none' -o '{}'", scene), "Use --in-place");
  refused("--weights '29: none' -o /nowhere/at/all.yaml", "/nowhere/at");
  for (const char* input : {"sheet.msh", "rig.yaml", "left.mp4"}) {
    const std::string before = testing::ReadText(demo / input);
    refused(fmt::format("--weights '29: none' -o '{}'", (demo / input).string()),
            "would replace the input");
    EXPECT_EQ(testing::ReadText(demo / input), before);
  }
  testing::WriteText(demo / "weights.txt", "29: none\n");
  refused(fmt::format("--weights '{0}' -o '{0}'", (demo / "weights.txt").string()),
          "would replace the input");
  EXPECT_EQ(testing::ReadText(demo / "weights.txt"), "29: none\n");
  std::filesystem::create_directories(demo / "scene.partial.yaml/in the way");
  refused("--weights '29: none' --in-place", "cannot be written");
  refused("--weights '29: none' --camera left", "expected NAME=SOURCE");
}

}  // namespace
}  // namespace softforce
