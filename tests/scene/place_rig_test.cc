#include "softforce/scene/place_rig.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "softforce/base/input_error.h"
#include "softforce/scene/rig_file.h"

namespace softforce::scene {
namespace {

const char* const kCameras =
    "softforce: 1\n"
    "# measured on a Tuesday\n"
    "cameras:\n"
    "  only: {model: brown_conrady, resolution: [640, 480], intrinsics: [500, 500, 320, 240],\n"
    "         distortion: [0, 0, 0, 0],\n"
    "         T_camera_rig: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}\n";

std::filesystem::path Write(const std::string& name, const std::string& text) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / name;
  std::ofstream(file) << text;
  return file;
}

std::string Read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

Eigen::Isometry3d Place(double x) {
  return Eigen::Translation3d(x, 0.2, 0.3) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY());
}

TEST(WritePlacedRig, AddsThePlaceAndLeavesTheRestAlone) {
  const auto file = Write("place_add.yaml", kCameras);

  WritePlacedRig(file, Place(0.1), "sd 0.1 mm\nand more", file);

  EXPECT_EQ(Read(file).substr(0, std::string(kCameras).size()), kCameras);
  EXPECT_NE(Read(file).find("  # sd 0.1 mm\n  # and more\n"), std::string::npos);
  EXPECT_EQ(LoadRig(file).T_rig_robot->matrix(), Place(0.1).matrix());
}

TEST(WritePlacedRig, ReplacesAnOldPlaceInAnyForm) {
  const std::string rows =
      "T_rig_robot:\n  - [1, 0, 0, 0]\n  - [0, 1, 0, 0]\n  - [0, 0, 1, 0]\n  - [0, 0, 0, 1]\n";
  const std::string flow =
      "T_rig_robot: [[1, 0, 0, 0], [0, 1, 0, 0],\n  [0, 0, 1, 0], [0, 0, 0, 1]]\n";
  const std::string cameras = std::string(kCameras).substr(13);  // without the version
  for (const std::string& old : {rows, flow}) {
    const auto file = Write("place_replace.yaml", "softforce: 1\n" + old + "# after\n" + cameras);

    WritePlacedRig(file, Place(0.4), "new", file);

    EXPECT_EQ(LoadRig(file).T_rig_robot->matrix(), Place(0.4).matrix());
    const std::string text = Read(file);
    EXPECT_EQ(text.find("T_rig_robot"), text.rfind("T_rig_robot"));
    EXPECT_NE(text.find("# after\n" + cameras), std::string::npos);
  }
}

TEST(WritePlacedRig, WritesAnotherFile) {
  const auto file = Write("place_from.yaml", kCameras);
  const auto to = std::filesystem::path(::testing::TempDir()) / "place_to.yaml";
  WritePlacedRig(file, Place(0.1), "", to);
  EXPECT_EQ(Read(file), kCameras);
  EXPECT_TRUE(LoadRig(to).T_rig_robot);
}

TEST(WritePlacedRig, RefusesAPlaceThatItCannotReplace) {
  const std::string quoted =
      std::string(kCameras) +
      "\"T_rig_robot\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n";
  const auto file = Write("place_quoted.yaml", quoted);
  EXPECT_THROW(WritePlacedRig(file, Place(0.1), "", file), base::InputError);
  EXPECT_EQ(Read(file), quoted);
}

}  // namespace
}  // namespace softforce::scene
