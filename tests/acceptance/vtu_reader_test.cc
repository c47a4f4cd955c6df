// The ParaView series of a run, read by VTK itself.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <regex>

#include "acceptance/program.h"

namespace softforce {
namespace {

using Folder = std::filesystem::path;
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

struct Part {
  double time_s;
  int part;
  std::string file;
};

std::vector<Part> PartsOf(const Folder& pvd) {
  static const std::regex kPart(R"re(timestep="([0-9.]+)" part="([0-9])" file="([^"]+)")re");
  const std::string text = testing::ReadText(pvd);
  std::vector<Part> parts;
  for (std::sregex_iterator it(text.begin(), text.end(), kPart), end; it != end; ++it) {
    parts.push_back({std::stod((*it)[1]), std::stoi((*it)[2]), (*it)[3]});
  }
  return parts;
}

Grid Read(const Folder& file) {
  const auto reader = vtkSmartPointer<vtkXMLUnstructuredGridReader>::New();
  reader->SetFileName(file.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u) << file;
  return reader->GetOutput();
}

// A value at the points, or null.
vtkDataArray* At(const Grid& grid, const char* name, int components) {
  vtkDataArray* array = grid->GetPointData()->GetArray(name);
  EXPECT_NE(array, nullptr) << name;
  if (array != nullptr) {
    EXPECT_EQ(array->GetNumberOfComponents(), components) << name;
    EXPECT_EQ(array->GetNumberOfTuples(), grid->GetNumberOfPoints()) << name;
  }
  return array;
}

double Norm(vtkDataArray* vectors, vtkIdType point) {
  double v[3];
  vectors->GetTuple(point, v);
  return std::hypot(v[0], v[1], v[2]);
}

double LargestNorm(vtkDataArray* vectors) {
  double largest = 0;
  for (vtkIdType i = 0; i < vectors->GetNumberOfTuples(); ++i) {
    largest = std::max(largest, Norm(vectors, i));
  }
  return largest;
}

TEST(ParaViewSeries, IsReadByVtk) {
  const Folder folder = testing::CopyOfDemo("vtu_reader");
  const auto run = testing::RunProgram(
      fmt::format("run '{0}/scene.yaml' --out '{0}/out' --frames 0:23 --every 22 --vtu "
                  "--no-overlay --no-report --no-frames",
                  folder.string()));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const std::vector<Part> parts = PartsOf(folder / "out/results.pvd");
  ASSERT_EQ(parts.size(), 6u) << "two frames of three parts";
  EXPECT_NEAR(parts[3].time_s - parts[0].time_s, 22.0 / 30, 0.02);  // s; 30 frames/s
  for (size_t i = 0; i < parts.size(); ++i) EXPECT_EQ(parts[i].part, static_cast<int>(i % 3));

  const Grid body = Read(folder / "out" / parts[3].file);
  EXPECT_GT(body->GetNumberOfCells(), 1000);
  EXPECT_EQ(body->GetCellType(0), VTK_QUADRATIC_TETRA);
  vtkDataArray* displacement = At(body, "displacement_m", 3);
  vtkDataArray* stress = At(body, "von_mises_Pa", 1);
  ASSERT_TRUE(displacement != nullptr && stress != nullptr);
  EXPECT_NEAR(LargestNorm(displacement), 0.0113, 0.001);  // m, under both weights
  EXPECT_GE(stress->GetRange()[0], 0);
  EXPECT_GT(stress->GetRange()[1], 1e3);  // Pa

  const Grid forces = Read(folder / "out" / parts[4].file);
  ASSERT_EQ(forces->GetNumberOfPoints(), 2);
  vtkDataArray* force = At(forces, "force_N", 3);
  At(forces, "sd_N", 1);
  At(forces, "force", 1);
  for (vtkIdType f = 0; f < 2; ++f) EXPECT_NEAR(Norm(force, f), 0.559, 0.03);  // N

  const Grid markers = Read(folder / "out" / parts[5].file);
  ASSERT_EQ(markers->GetNumberOfPoints(), 14);
  EXPECT_LT(LargestNorm(At(markers, "residual_m", 3)), 1e-3);  // m
  EXPECT_EQ(At(markers, "status", 1)->GetRange()[1], 0) << "all are seen";
  EXPECT_EQ(At(markers, "marker", 1)->GetRange()[1], 13);
}

}  // namespace
}  // namespace softforce
