#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "acceptance/program.h"
#include "softforce/camera/rig.h"
#include "softforce/scene/rig_file.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;

const Folder kShared = Folder(SOFTFORCE_SOURCE_DIR) / "../shared/recordings";

// m, the largest distance between where two places of the rig have points about the body.
double Apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  double largest = 0;
  for (const double x : {0.0, 0.1, 0.2}) {
    for (const double z : {0.0, 0.05, 0.1}) {
      const Eigen::Vector3d p(x, 0.2 - x, z);
      largest = std::max(largest, (a * p - b * p).norm());
    }
  }
  return largest;
}

Eigen::Isometry3d Registered(const Folder& scene, const std::string& options, const Folder& rig) {
  const testing::ProgramResult result = testing::RunProgram(
      fmt::format("register '{}' {} -o '{}'", scene.string(), options, rig.string()));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  std::cout << result.output;
  return scene::LoadRig(rig).T_rig_robot.value();
}

// The rig's frame is the left camera's.
Eigen::Isometry3d Truth(const Folder& recording) {
  std::ifstream stream(recording / "truth.json");
  const auto rows = nlohmann::json::parse(stream)["cameras"]["left"]["T_camera_robot"];
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) T.matrix()(r, c) = rows[r][c].get<double>() * (c == 3 ? 1e-3 : 1);
  }
  return T;
}

class RegisteredRecording : public ::testing::TestWithParam<const char*> {};

TEST_P(RegisteredRecording, MarkersAndFiducialsPlaceTheRigWhereItStands) {
  const Folder recording = kShared / GetParam();
  if (!std::filesystem::exists(recording)) GTEST_SKIP() << "no recording at " << recording;
  const Folder out = testing::FreshFolder(std::string("register_") + GetParam());
  const Folder scene = recording / "scene.yaml";

  const auto fiducials = Registered(scene, "--from fiducials", out / "fiducials.yaml");
  const auto markers = Registered(scene, "--from markers", out / "markers.yaml");

  std::cout << fmt::format("{}: fiducials {:.3f} mm off, markers {:.3f} mm\n", GetParam(),
                           1e3 * Apart(fiducials, Truth(recording)),
                           1e3 * Apart(markers, Truth(recording)));
  EXPECT_LT(Apart(fiducials, Truth(recording)), 0.3e-3);  // m; the aim, at the body
  EXPECT_LT(Apart(markers, Truth(recording)), 0.3e-3);
}

INSTANTIATE_TEST_SUITE_P(Shared, RegisteredRecording,
                         ::testing::Values("sheet_two_weights", "sheet_two_weights_tags",
                                           "robot_tip_weight"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(Register, ARunWithoutFiducialsUsesThePlaceInTheRigFile) {
  const Folder demo = testing::CopyOfDemo("register_in_place");
  const std::string scene = (demo / "scene.yaml").string();
  const std::string before = testing::ReadText(demo / "rig.yaml");

  const testing::ProgramResult result =
      testing::RunProgram(fmt::format("register '{}' --from markers --in-place", scene));

  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string after = testing::ReadText(demo / "rig.yaml");
  EXPECT_EQ(after.substr(0, before.size()), before);  // only added to
  const std::string text = testing::ReadText(scene);
  testing::WriteText(scene, text.substr(0, text.find("  fiducials:")));
  const testing::ProgramResult run = testing::RunProgram(fmt::format(
      "run '{}' --out '{}' --no-overlay --frames 0:5", scene, (demo / "results").string()));
  EXPECT_EQ(run.exit_code, 0) << run.errors;

  // Again: the place is replaced, not added a second time.
  ASSERT_EQ(testing::RunProgram(fmt::format("register '{}' --in-place", scene)).exit_code, 0);
  const std::string again = testing::ReadText(demo / "rig.yaml");
  EXPECT_EQ(again.find("T_rig_robot:"), again.rfind("T_rig_robot:"));
}

// Rows of a table of pairs, right but for one.
std::string Pairs(const camera::Rig& rig, int wrong) {
  std::string table = "x_mm,y_mm,z_mm,camera,u_px,v_px\n";
  int row = 0;
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0, 0, 10), Eigen::Vector3d(200, 0, 10), Eigen::Vector3d(200, 200, 10),
        Eigen::Vector3d(0, 200, 10), Eigen::Vector3d(100, 0, 0), Eigen::Vector3d(0, 100, 10)}) {
    for (const camera::Camera& camera : rig.cameras) {
      const Eigen::Vector2d pixel =
          camera::Project(camera.lens, camera.T_camera_rig * (*rig.T_rig_robot * (1e-3 * p))).pixel;
      table += fmt::format("{:g},{:g},{:g},{},{:.2f},{:.2f}\n", p.x(), p.y(), p.z(), camera.name,
                           pixel.x() + (row++ == wrong ? 45 : 0), pixel.y());
    }
  }
  return table;
}

TEST(Register, TypedPairsOfWhichOneIsWrong) {
  const Folder demo = testing::CopyOfDemo("register_pairs");
  const Folder scene = demo / "scene.yaml";
  const auto truth = Registered(scene, "", demo / "placed.yaml");
  const camera::Rig rig = scene::LoadRig(demo / "placed.yaml");
  testing::WriteText(demo / "pairs.csv", Pairs(rig, 8));

  const testing::ProgramResult result =
      testing::RunProgram(fmt::format("register '{}' --pairs '{}' -o '{}'", scene.string(),
                                      (demo / "pairs.csv").string(), (demo / "new.yaml").string()));

  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("the pair of (100, 0, 0) mm in camera \"left\" is wrong"),
            std::string::npos)
      << result.output;
  // m; pixels rounded to 0.01
  EXPECT_LT(Apart(*scene::LoadRig(demo / "new.yaml").T_rig_robot, truth), 0.1e-3);
}

TEST(Register, RefusesBadInput) {
  const Folder demo = testing::CopyOfDemo("register_refusals");
  const std::string scene = (demo / "scene.yaml").string();
  const auto refused = [&](const std::string& options, const char* says) {
    const testing::ProgramResult result =
        testing::RunProgram(fmt::format("register '{}' {}", scene, options));
    EXPECT_EQ(result.exit_code, 2) << options;
    EXPECT_NE(result.errors.find(says), std::string::npos) << options << ": " << result.errors;
  };
  const auto table = [&](const std::string& rows) {
    testing::WriteText(demo / "pairs.csv", rows);
    return fmt::format("--pairs '{}'", (demo / "pairs.csv").string());
  };
  const std::string header = "x_mm,y_mm,z_mm,camera,u_px,v_px\n";
  refused("--from thin-air", "expected fiducials, markers or pairs");
  refused("--from pairs", "--pairs");
  refused("--pairs nowhere.csv", "cannot be read");
  refused("--in-place -o other.yaml", "expected one of them");
  refused(fmt::format("-o '{}'", scene), "would replace the input");
  refused(fmt::format("-o '{}'", (demo / "left.mp4").string()), "would replace the input");
  refused("--frame -1", "--frame");
  refused(table(header + "0,0,0,left,600,500\n"), "at least four");
  refused(table(header), "got no pairs");
  refused(table("x,y,z,camera,u,v\n"), "expected x_mm");
  refused(table(header + "0,0,0,lefd,600,500\n"), "Did you mean \"left\"");
  refused(table(header + "0,0,zero,left,600,500\n"), "z_mm");
  refused(table(header + "0,0,0,left,600\n"), "got 5 cells");
  refused(table(header + "0,0,0,left,500,500\n10,0,0,left,520,500\n20,0,0,left,540,500\n"
                         "30,0,0,left,560,500\n"),
          "lie on a line");
  refused(table(header + "0,0,0,left,500,500\n90,0,0,left,520,900\n0,80,0,left,240,500\n"
                         "70,90,0,left,560,300\n50,40,0,left,160,30\n"),
          "fit together");
}

TEST(Register, RefusesThreeMarkers) {
  const Folder demo = testing::CopyOfDemo("register_three");
  std::string scene = testing::ReadText(demo / "scene.yaml");
  const size_t begin = scene.find("    - {id: 3, position: ");
  scene.erase(begin, scene.find("forces:") - begin);
  testing::WriteText(demo / "scene.yaml", scene);
  const testing::ProgramResult result = testing::RunProgram(
      fmt::format("register '{}' --from markers", (demo / "scene.yaml").string()));
  EXPECT_EQ(result.exit_code, 2);  // three lengths are found again by chance
  EXPECT_NE(result.errors.find("at least four"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace softforce
