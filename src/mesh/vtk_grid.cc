#include "mesh/vtk_grid.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <optional>
#include <string>

namespace softforce::mesh {
namespace {

// A tuple for each column.
vtkNew<vtkDoubleArray> ToVtk(const Eigen::MatrixXd& columns) {
  vtkNew<vtkDoubleArray> array;
  array->SetNumberOfComponents(static_cast<int>(columns.rows()));
  array->SetNumberOfTuples(columns.cols());
  std::copy_n(columns.data(), columns.size(), array->GetPointer(0));
  return array;
}

void AddPointFields(const std::vector<PointField>& fields, vtkUnstructuredGrid* grid) {
  for (const PointField& field : fields) {
    assert(field.values.cols() == grid->GetNumberOfPoints());
    const auto array = ToVtk(field.values);
    array->SetName(field.name.c_str());
    grid->GetPointData()->AddArray(array);
  }
}

std::optional<int> AsInteger(const std::string& text) {
  int value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

// The number that stands for each region in the file.
std::vector<int> RegionValues(const std::vector<std::string>& names) {
  std::vector<int> values;
  for (std::size_t i = 0; i < names.size(); ++i) {
    values.push_back(AsInteger(names[i]).value_or(static_cast<int>(i) + 1));
  }
  return values;
}

void AddCellFields(const std::vector<CellField>& fields, vtkUnstructuredGrid* grid) {
  for (const CellField& field : fields) {
    assert(field.values.size() == grid->GetNumberOfCells());
    vtkNew<vtkDoubleArray> array;
    array->SetName(field.name.c_str());
    for (const double value : field.values) array->InsertNextValue(value);
    grid->GetCellData()->AddArray(array);
  }
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> ToVtkGrid(const TetMesh& mesh,
                                               const std::vector<PointField>& fields,
                                               const std::vector<CellField>& cell_fields) {
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetData(ToVtk(mesh.nodes));
  grid->SetPoints(points);
  grid->Allocate(mesh.num_elements());
  for (int e = 0; e < mesh.num_elements(); ++e) {
    std::array<vtkIdType, 10> nodes{};
    std::copy_n(mesh.elements.col(e).begin(), mesh.elements.rows(), nodes.begin());
    grid->InsertNextCell(mesh.order() == 2 ? VTK_QUADRATIC_TETRA : VTK_TETRA, mesh.elements.rows(),
                         nodes.data());
  }
  AddPointFields(fields, grid);
  AddCellFields(cell_fields, grid);
  if (mesh.region_names.size() > 1 || (!mesh.region_names.empty() && mesh.region_names[0] != "")) {
    const std::vector<int> values = RegionValues(mesh.region_names);
    vtkNew<vtkIntArray> regions;
    regions->SetName("region");
    for (const int region : mesh.region) regions->InsertNextValue(values[region]);
    grid->GetCellData()->AddArray(regions);
  }
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> ToVtkGrid(const Surface& surface, const Eigen::Matrix3Xd& x,
                                               const std::vector<CellField>& fields) {
  std::vector<int> number(x.cols(), -1);  // of each node in the file
  std::vector<Eigen::Index> used;
  for (const int node : surface.triangles.reshaped()) {
    if (number[node] >= 0) continue;
    number[node] = static_cast<int>(used.size());
    used.push_back(node);
  }
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetData(ToVtk(x(Eigen::all, used)));
  grid->SetPoints(points);
  grid->Allocate(surface.num_triangles());
  for (int t = 0; t < surface.num_triangles(); ++t) {
    std::array<vtkIdType, 6> nodes{};
    for (Eigen::Index i = 0; i < surface.triangles.rows(); ++i) {
      nodes[i] = number[surface.triangles(i, t)];
    }
    grid->InsertNextCell(surface.order() == 2 ? VTK_QUADRATIC_TRIANGLE : VTK_TRIANGLE,
                         surface.triangles.rows(), nodes.data());
  }
  AddCellFields(fields, grid);
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> ToVtkGrid(const Eigen::Matrix3Xd& places,
                                               const std::vector<PointField>& fields) {
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetData(ToVtk(places));
  grid->SetPoints(points);
  grid->Allocate(places.cols());
  for (vtkIdType i = 0; i < places.cols(); ++i) grid->InsertNextCell(VTK_VERTEX, 1, &i);
  AddPointFields(fields, grid);
  return grid;
}

}  // namespace softforce::mesh
