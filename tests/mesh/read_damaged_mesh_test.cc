#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mesh/mesh_files.h"
#include "softforce/base/input_error.h"
#include "softforce/mesh/read_mesh.h"
#include "softforce/mesh/write_vtu.h"

namespace softforce::mesh {
namespace {

using base::InputError;
using softforce::testing::FreshFolder;
using softforce::testing::MakeTwoRegionBox;
using softforce::testing::ReadText;
using softforce::testing::WriteGmsh;
using softforce::testing::WriteText;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Expects that reading the file is refused with a message that names it and says `text`.
void ExpectRefusal(const std::filesystem::path& path, const std::string& text) {
  EXPECT_THAT([&] { ReadMesh(path, 1e-3); },
              ThrowsMessage<InputError>(AllOf(HasSubstr(path.string()), HasSubstr(text))));
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string GmshText(const TetMesh& mesh, double version = 4.1, bool binary = false) {
  const auto path = FreshFolder() / "original.msh";
  WriteGmsh(path, mesh, {version, binary});
  return ReadText(path);
}

std::string VtuText(const TetMesh& mesh) {
  const auto path = FreshFolder() / "original.vtu";
  WriteVtu(path, mesh);
  return ReadText(path);
}

TEST(ReadMesh, RefusesAMissingFile) { ExpectRefusal(FreshFolder() / "none.msh", "no such file"); }

TEST(ReadMesh, RefusesAnUnknownExtension) {
  ExpectRefusal(WriteText(FreshFolder() / "body.stl", "solid"), "extension is \".stl\"");
}

TEST(ReadMesh, RefusesAFolder) {
  const auto folder = FreshFolder() / "body.msh";
  std::filesystem::create_directories(folder);
  ExpectRefusal(folder, "is not a file");
}

TEST(ReadMesh, RefusesAnEmptyFile) {
  const auto folder = FreshFolder();
  for (const char* const name : {"body.msh", "body.vtk", "body.vtu"}) {
    ExpectRefusal(WriteText(folder / name, ""), "empty");
  }
}

TEST(ReadMesh, RefusesFilesOfAnotherKind) {
  const auto folder = FreshFolder();
  ExpectRefusal(WriteText(folder / "body.msh", "Printf(\"a script\");\n"), "expected a section");
  ExpectRefusal(WriteText(folder / "body.vtk", "solid body\n"), "VTK cannot read it");
  ExpectRefusal(WriteText(folder / "body.vtu", "solid body\n"), "VTK cannot read it");
}

TEST(ReadMesh, QuotesNoBinaryJunk) {
  std::string junk = "# vtk \x01\x02\x1b[31m\x80\xff\n";
  for (int i = 0; i < 3000; ++i) junk += static_cast<char>(i * 37 % 256);
  const auto path = WriteText(FreshFolder() / "body.vtk", junk);
  try {
    ReadMesh(path, 1);
    ADD_FAILURE() << "was read";
  } catch (const base::InputError& error) {
    const std::string text = std::string(error.what()).substr(path.string().size());
    EXPECT_TRUE(std::all_of(text.begin(), text.end(), [](char c) {
      return c == '\n' || static_cast<unsigned char>(c) >= ' ';
    })) << text;
    EXPECT_EQ(text.find('\xff'), std::string::npos);
    EXPECT_LT(text.size(), 400u);  // one screen, not the file
  }
}

TEST(ReadMesh, RefusesOtherVersionsOfGmshsFormat) {
  const std::string text = Replaced(GmshText(MakeTwoRegionBox(1)), "4.1 0 8", "4 0 8");
  ExpectRefusal(WriteText(FreshFolder() / "body.msh", text), "must be version 2.2 or 4.1");
}

TEST(ReadMesh, RefusesAMeshWithoutTetrahedra) {
  TetMesh box = MakeTwoRegionBox(1);
  box.elements.resize(4, 0);
  box.region.clear();
  const auto folder = FreshFolder();
  ExpectRefusal(WriteText(folder / "b.msh", GmshText(box)), "no tetrahedron");
  ExpectRefusal(WriteText(folder / "b.vtk", softforce::testing::LegacyVtk(box)), "no tetrahedron");
  ExpectRefusal(WriteText(folder / "b.vtu", VtuText(box)), "no tetrahedron");
}

TEST(ReadMesh, RefusesACellThatNamesAMissingNode) {
  const std::string text = Replaced(softforce::testing::LegacyVtk(MakeTwoRegionBox(1)),
                                    "\n4  0  1  4 16\n", "\n4 999  1  4 16\n");
  ExpectRefusal(WriteText(FreshFolder() / "body.vtk", text), "names node 999");
}

TEST(ReadMesh, RefusesRegionsThatAreNoIntegers) {
  const std::string text = Replaced(
      Replaced(softforce::testing::LegacyVtk(MakeTwoRegionBox(1)), "region int", "region double"),
      "default\n1\n", "default\n1.5\n");
  ExpectRefusal(WriteText(FreshFolder() / "body.vtk", text), "region is 1.5");
}

TEST(ReadMesh, RefusesAVolumeInTwoPhysicalVolumes) {
  // In format 4.1 the physical tags of a volume stand behind its bounding box.
  const std::string text = Replaced(GmshText(MakeTwoRegionBox(1)), " 1 1 0 \n", " 2 1 2 0 \n");
  ExpectRefusal(WriteText(FreshFolder() / "body.msh", text), "\"soft\" and \"stiff\"");
}

TEST(ReadMesh, RefusesMixedElementOrders) {
  const std::string text = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
11
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 .5 0 0
6 .5 .5 0
7 0 .5 0
8 0 0 .5
9 0 .5 .5
10 .5 0 .5
11 0 0 -1
$EndNodes
$Elements
2
1 11 2 0 1 1 2 3 4 5 6 7 8 9 10
2 4 2 0 1 1 3 2 11
$EndElements
)";
  ExpectRefusal(WriteText(FreshFolder() / "body.msh", text), "announces 2 elements, Gmsh finds 1");
}

TEST(ReadMesh, RefusesLettersAmongTheNumbers) {
  const std::string text = GmshText(MakeTwoRegionBox(1));
  const auto folder = FreshFolder();
  ExpectRefusal(WriteText(folder / "n.msh", Replaced(text, "\n10 0 0\n", "\n10 x 0\n")),
                "$Nodes, line");
  ExpectRefusal(WriteText(folder / "e.msh", Replaced(text, "\n1 1 2 5 ", "\n1 1 -2 5 ")),
                "$Elements, line");
}

TEST(ReadMesh, RefusesALostLineBreak) {
  const std::string text = Replaced(GmshText(MakeTwoRegionBox(1)), "\n10 0 0\n", "\n10 0 0 ");
  ExpectRefusal(WriteText(FreshFolder() / "body.msh", text), "lines of numbers, must have");
}

TEST(ReadMesh, RefusesAnElementWithANodeTooMany) {
  const std::string text =
      Replaced(GmshText(MakeTwoRegionBox(1), 2.2), "\n$EndElements", " 3\n$EndElements");
  ExpectRefusal(WriteText(FreshFolder() / "body.msh", text), "must be 2 tags and 4 nodes");
}

TEST(ReadMesh, RefusesAPhysicalNameOfADimensionThatDoesNotExist) {
  const std::string text = Replaced(GmshText(MakeTwoRegionBox(1)), "3 1 \"soft\"", "13 1 \"soft\"");
  ExpectRefusal(WriteText(FreshFolder() / "body.msh", text), "$PhysicalNames, entry");
}

class ReadTruncated : public ::testing::TestWithParam<int> {};

TEST_P(ReadTruncated, IsRefusedWhereverTheFileIsCutOff) {
  const int part = GetParam();  // percent
  const auto folder = FreshFolder();
  const auto cut = [&](const std::string& name, const std::string& text) {
    ExpectRefusal(WriteText(folder / name, text.substr(0, text.size() * part / 100)), "");
  };
  const TetMesh box = MakeTwoRegionBox(2);
  const std::string vtu = VtuText(box), vtk = softforce::testing::LegacyVtk(box);
  const std::string text_2 = GmshText(box, 2.2, false), text_4 = GmshText(box, 4.1, false);
  const std::string binary_2 = GmshText(box, 2.2, true), binary_4 = GmshText(box, 4.1, true);

  cut("text2.msh", text_2);
  cut("text4.msh", text_4);
  cut("binary2.msh", binary_2);
  cut("binary4.msh", binary_4);
  cut("box.vtk", vtk);
  cut("box.vtu", vtu);
}

INSTANTIATE_TEST_SUITE_P(Percent, ReadTruncated, ::testing::Values(1, 10, 30, 50, 70, 90, 98));

TEST(ReadMesh, NeitherCrashesNorPrintsOnDamagedText) {
  const auto folder = FreshFolder();
  const std::map<std::string, std::string> originals{
      {".msh", GmshText(MakeTwoRegionBox(1))},
      {".vtk", softforce::testing::LegacyVtk(MakeTwoRegionBox(1))}};
  std::mt19937 random(1);
  int refused = 0;
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  for (const auto& [extension, original] : originals) {
    for (int trial = 0; trial < 200; ++trial) {
      std::string text = original;
      const auto at = std::uniform_int_distribution<std::size_t>(0, text.size() - 1)(random);
      text[at] = "0123456789 .-e\nx"[std::uniform_int_distribution<int>(0, 15)(random)];
      try {
        ReadMesh(WriteText(folder / ("body" + extension), text), 1e-3);
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(refused, 100);  // other changes make another valid number
}

}  // namespace
}  // namespace softforce::mesh
