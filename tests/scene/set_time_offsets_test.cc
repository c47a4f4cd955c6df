#include "softforce/scene/set_time_offsets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scene/temp_scene.h"
#include "softforce/scene/rig_file.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::kRigText;
using testing::RigRefusal;
using testing::TempFolder;
using testing::WriteFile;

std::string TextOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(TimeOffsets, AreZeroUnlessTheRigFileHasThem) {
  const camera::Rig rig = LoadRig(WriteFile(TempFolder() / "rig.yaml", kRigText));
  EXPECT_EQ(rig.cameras[1].time_offset_s, 0);
  EXPECT_EQ(rig.cameras[1].time_offset_sd_s, 0);
}

TEST(TimeOffsets, AreReplacedOrAddedAndAllElseStays) {
  const fs::path file = WriteFile(TempFolder() / "rig.yaml", kRigText + std::string("# mine\n"));
  camera::Rig rig = LoadRig(file);
  for (const double offset_s : {0.0042, -0.0103}) {
    rig.cameras[1].time_offset_s = offset_s;
    rig.cameras[1].time_offset_sd_s = 0.00016;

    WriteTimeOffsets(file, rig, file);

    const camera::Rig read = LoadRig(file);
    EXPECT_NEAR(read.cameras[1].time_offset_s, offset_s, 1e-7);  // s; four digits of a ms
    EXPECT_NEAR(read.cameras[1].time_offset_sd_s, 0.00016, 1e-7);
    EXPECT_EQ(read.cameras[0].time_offset_s, 0);
    EXPECT_EQ(read.cameras[1].T_camera_rig.matrix(), rig.cameras[1].T_camera_rig.matrix());
  }
  const std::string text = TextOf(file);
  EXPECT_THAT(text, HasSubstr("# mine\n"));
  EXPECT_THAT(text, HasSubstr("-10.3000 ms"));
  EXPECT_EQ(text.find("4.2"), std::string::npos);  // the old one is gone
}

TEST(TimeOffsets, SurviveSaveRig) {
  camera::Rig rig = LoadRig(WriteFile(TempFolder() / "rig.yaml", kRigText));
  rig.cameras[0].time_offset_s = 1.0 / 300;
  rig.cameras[0].time_offset_sd_s = 1e-4 / 3;
  SaveRig(rig, TempFolder() / "saved.yaml");
  const camera::Rig loaded = LoadRig(TempFolder() / "saved.yaml");
  EXPECT_EQ(loaded.cameras[0].time_offset_s, 1.0 / 300);
  EXPECT_EQ(loaded.cameras[0].time_offset_sd_s, 1e-4 / 3);
}

TEST(TimeOffsets, NeedAUnit) {
  EXPECT_THAT(
      RigRefusal("    resolution: [640, 480]", "    time_offset: 4\n    resolution: [640, 480]"),
      HasSubstr("time_offset"));
}

}  // namespace
}  // namespace softforce::scene
