#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/videoio.hpp>
#include <sstream>

#include "acceptance/program.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;

// The demo recording, spoilt in one way, and what the message must name.
struct Spoilt {
  const char* name;
  void (*spoil)(const Folder& folder);
  std::vector<const char*> named;
};

void PrintTo(const Spoilt& spoilt, std::ostream* out) { *out << spoilt.name; }

// Replaces the numbers of one node of sheet.msh (format 4.1) by `coordinates`: the node in the
// middle of a run.
void SetNode(const Folder& folder, const std::string& coordinates) {
  std::istringstream in(testing::ReadText(folder / "sheet.msh"));
  std::ostringstream out;
  std::string line;
  bool in_nodes = false;
  int coordinate_lines = 0;
  while (std::getline(in, line)) {
    if (line == "$Nodes") in_nodes = true;
    if (line == "$EndNodes") in_nodes = false;
    std::istringstream numbers(line);
    double x, y, z, more;
    const bool three = static_cast<bool>(numbers >> x >> y >> z) && !(numbers >> more);
    if (in_nodes && three && ++coordinate_lines == 800) line = coordinates;
    out << line << '\n';
  }
  testing::WriteText(folder / "sheet.msh", out.str());
}

// A node more than the elements use, in the last block of nodes.
void AddLooseNode(const Folder& folder) {
  testing::WriteText(
      folder / "sheet.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 200 0 0\n3 0 200 0\n"
      "4 0 0 10\n5 50 50 5\n$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n");
}

// Writes left.mp4 anew with other pictures.
void Record(const Folder& folder, int frames, cv::Size size) {
  cv::VideoWriter writer((folder / "left.mp4").string(), cv::CAP_FFMPEG,
                         cv::VideoWriter::fourcc('m', 'p', '4', 'v'), 30, size);
  for (int i = 0; i < frames; ++i) writer.write(cv::Mat(size, CV_8UC3, cv::Scalar::all(60)));
}

const Spoilt kCases[] = {
    {"SceneMissing",
     [](const Folder& f) { std::filesystem::remove(f / "scene.yaml"); },
     {"scene.yaml"}},
    {"MeshMissing",
     [](const Folder& f) { std::filesystem::remove(f / "sheet.msh"); },
     {"sheet.msh"}},
    {"RigMissing", [](const Folder& f) { std::filesystem::remove(f / "rig.yaml"); }, {"rig.yaml"}},
    {"VideoMissing",
     [](const Folder& f) { std::filesystem::remove(f / "right.mp4"); },
     {"right.mp4"}},
    {"UnknownKey",
     [](const Folder& f) { testing::Edit(f / "scene.yaml", "  size: 6 mm", "  siez: 6 mm"); },
     {"scene.yaml:", "siez", "size"}},
    {"UnitMissing",
     [](const Folder& f) { testing::Edit(f / "scene.yaml", "290 kPa", "290"); },
     {"scene.yaml:", "youngs_modulus", "unit"}},
    {"UnitWrong",
     [](const Folder& f) { testing::Edit(f / "scene.yaml", "290 kPa", "290 mm"); },
     {"scene.yaml:", "youngs_modulus", "mm"}},
    {"MeshWithNaN", [](const Folder& f) { SetNode(f, "nan 1 1"); }, {"sheet.msh", "node"}},
    {"MeshInverted", [](const Folder& f) { SetNode(f, "900 900 900"); }, {"sheet.msh", "element"}},
    {"MeshWithLooseNode", AddLooseNode, {"sheet.msh", "node"}},
    {"NothingFixed",
     [](const Folder& f) {
       for (int i = 0; i < 4; ++i)
         testing::Edit(f / "scene.yaml", "- {box: {min",
                       "- {box: {min: 500 500 500 mm, max: 600 600 600 mm}}  # {box: {was");
     },
     {"scene.yaml", "fixed", "no node"}},
    {"HeldAtALineOnly",
     [](const Folder& f) {
       testing::Edit(f / "scene.yaml", "{min: 0 0 0 mm, max: 10 10 10 mm}",
                     "{min: 0 0 0 mm, max: 10 0 0 mm}");
       for (const char* box :
            {"{min: 0 190 0 mm, max: 10 200 10 mm}", "{min: 190 0 0 mm, max: 200 10 10 mm}",
             "{min: 190 190 0 mm, max: 200 200 10 mm}"}) {
         testing::Edit(f / "scene.yaml", box, "{min: 0 0 0 mm, max: 10 0 0 mm}");
       }
     },
     {"fixed", "not in line"}},
    {"MarkerOffTheSurface",
     [](const Folder& f) { testing::Edit(f / "scene.yaml", "41 37 10 mm", "41 37 16 mm"); },
     {"scene.yaml", "markers", "id 0", "6 mm off"}},
    {"CandidateOffTheSurface",
     [](const Folder& f) { testing::Edit(f / "scene.yaml", "140 75 0 mm", "140 75 5 mm"); },
     {"scene.yaml", "candidates", "id 1", "5 mm off"}},
    {"VideosOfDifferentLength",
     [](const Folder& f) {
       Record(f, 12, {1280, 1024});
     },
     {".mp4", "12", "30"}},
    {"VideoOfOtherSize",
     [](const Folder& f) {
       Record(f, 30, {640, 512});
     },
     {"left.mp4", "640x512", "1280x1024"}},
    {"OneLiveSource",
     [](const Folder& f) {
       testing::Edit(f / "scene.yaml", "left: left.mp4", "left: 'rtsp://camera/left'");
     },
     {"left", "right", "live"}},
    {"FiducialsInWrongOrder",
     [](const Folder& f) {
       testing::Edit(f / "scene.yaml", "[-44 38 -40 mm, -24 38 -40 mm",
                     "[-24 38 -40 mm, -44 38 -40 mm");
     },
     {"scene.yaml", "fiducials", "px"}},
};

class BadInput : public ::testing::TestWithParam<Spoilt> {};

TEST_P(BadInput, IsRefusedInOneMessageAndLeavesNothing) {
  const Folder folder = testing::CopyOfDemo(std::string("bad_") + GetParam().name);
  GetParam().spoil(folder);
  const Folder out = folder / "results";

  const testing::ProgramResult run = testing::RunProgram(
      fmt::format("run '{}' --out '{}'", (folder / "scene.yaml").string(), out.string()));

  EXPECT_EQ(run.exit_code, 2) << run.output << run.errors;
  EXPECT_EQ(run.errors.rfind("softforce: ", 0), 0u) << run.errors;
  EXPECT_EQ(run.errors.find("softforce: ", 1), std::string::npos)
      << "more than one message: " << run.errors;
  for (const char* word : GetParam().named) {
    EXPECT_NE(run.errors.find(word), std::string::npos)
        << '"' << word << "\" is not in: " << run.errors;
  }
  EXPECT_TRUE(!std::filesystem::exists(out) || std::filesystem::is_empty(out));
}

TEST(BadOutput, OverTheScenesOwnFilesIsRefusedAndTheyStay) {
  const Folder folder = testing::CopyOfDemo("bad_output");

  const testing::ProgramResult run = testing::RunProgram(
      fmt::format("run '{}' --out '{}'", (folder / "scene.yaml").string(), folder.string()));

  EXPECT_EQ(run.exit_code, 2) << run.errors;
  EXPECT_NE(run.errors.find("--out"), std::string::npos) << run.errors;
  EXPECT_TRUE(std::filesystem::exists(folder / "scene.yaml"));
  EXPECT_FALSE(std::filesystem::exists(folder / "forces.csv"));
}

TEST(BadOutput, ThatCannotBeMadeIsRefused) {
  const testing::ProgramResult run = testing::RunProgram(
      fmt::format("run '{}/datasets/sheet_two_weights/scene.yaml' --out /proc/softforce",
                  SOFTFORCE_SOURCE_DIR));

  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.errors.find("/proc/softforce"), std::string::npos) << run.errors;
}

INSTANTIATE_TEST_SUITE_P(Demo, BadInput, ::testing::ValuesIn(kCases),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace softforce
