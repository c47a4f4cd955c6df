#include <gtest/gtest.h>

#include <filesystem>

#include "softforce/scene/rig_file.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;

TEST(Recordings, AreAllUnderstood) {
  const fs::path recordings = fs::path(SOFTFORCE_SOURCE_DIR) / "../shared/recordings";
  if (!fs::is_directory(recordings)) GTEST_SKIP() << "no recordings at " << recordings;

  int scenes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(recordings)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("scene", 0) != 0 || entry.path().extension() != ".yaml") continue;
    const Scene scene = LoadScene(entry.path());
    EXPECT_EQ(LoadRig(scene.cameras.rig).cameras.size(), scene.cameras.sources.size());
    ++scenes;
  }
  EXPECT_GT(scenes, 0);
}

}  // namespace
}  // namespace softforce::scene
