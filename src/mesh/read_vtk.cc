#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <new>
#include <set>

#include "mesh/readers.h"
#include "mesh/vtk_messages.h"
#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

using base::InputError;

constexpr char kAdvice[] = "Export it again, and open it in ParaView to see more.";

// Cells of one kind of tetrahedron; the others are left out.
std::vector<vtkIdType> TetrahedraOf(const std::string& where, vtkUnstructuredGrid& grid) {
  std::vector<vtkIdType> linear, quadratic;
  for (vtkIdType cell = 0; cell < grid.GetNumberOfCells(); ++cell) {
    if (grid.GetCellType(cell) == VTK_TETRA) linear.push_back(cell);
    if (grid.GetCellType(cell) == VTK_QUADRATIC_TETRA) quadratic.push_back(cell);
  }
  if (!linear.empty() && !quadratic.empty()) {
    throw InputError(where,
                     fmt::format("has {} tetrahedra of 4 nodes and {} of 10, must have one kind",
                                 linear.size(), quadratic.size()),
                     "Mesh the whole body with the same element order.");
  }
  return linear.empty() ? quadratic : linear;
}

void ReadElements(const std::string& where, vtkUnstructuredGrid& grid,
                  const std::vector<vtkIdType>& cells, TetMesh& mesh) {
  if (cells.empty()) return;
  const int num_nodes = grid.GetCellType(cells[0]) == VTK_TETRA ? 4 : 10;
  mesh.elements.resize(num_nodes, cells.size());
  vtkNew<vtkIdList> ids;
  for (std::size_t e = 0; e < cells.size(); ++e) {
    grid.GetCellPoints(cells[e], ids);
    if (ids->GetNumberOfIds() != num_nodes) {
      throw InputError(where,
                       fmt::format("cell {} has {} nodes, must have {} by its type", cells[e],
                                   ids->GetNumberOfIds(), num_nodes),
                       kAdvice);
    }
    for (int i = 0; i < num_nodes; ++i) {
      const vtkIdType node = ids->GetId(i);
      if (node < 0 || node >= grid.GetNumberOfPoints()) {
        throw InputError(where,
                         fmt::format("cell {} names node {}, must be within 0 … {}", cells[e], node,
                                     grid.GetNumberOfPoints() - 1),
                         kAdvice);
      }
      mesh.elements(i, static_cast<Eigen::Index>(e)) = static_cast<int>(node);
    }
  }
}

// Regions from the values of the cell array "region", in ascending order.
void ReadRegions(const std::string& where, vtkUnstructuredGrid& grid,
                 const std::vector<vtkIdType>& cells, TetMesh& mesh) {
  mesh.region.assign(cells.size(), 0);
  mesh.region_names = {""};
  vtkDataArray* const array = grid.GetCellData()->GetArray("region");
  if (array == nullptr || cells.empty()) return;

  std::vector<int> values;
  for (const vtkIdType cell : cells) {
    const double value = array->GetComponent(cell, 0);
    if (!(std::abs(value) < 1e9) || value != std::floor(value)) {
      throw InputError(where, fmt::format("cell {}: region is {}, must be an integer", cell, value),
                       "The cell array \"region\" numbers the materials.");
    }
    values.push_back(static_cast<int>(value));
  }
  const std::set<int> distinct(values.begin(), values.end());
  mesh.region_names.clear();
  for (const int value : distinct) mesh.region_names.push_back(std::to_string(value));
  for (std::size_t e = 0; e < values.size(); ++e) {
    mesh.region[e] = static_cast<int>(std::distance(distinct.begin(), distinct.find(values[e])));
  }
}

TetMesh FromGrid(const std::string& where, vtkUnstructuredGrid& grid) {
  TetMesh mesh;
  mesh.nodes.resize(3, grid.GetNumberOfPoints());
  for (vtkIdType i = 0; i < grid.GetNumberOfPoints(); ++i) {
    grid.GetPoint(i, mesh.nodes.col(i).data());
  }
  const auto cells = TetrahedraOf(where, grid);
  ReadElements(where, grid, cells, mesh);
  ReadRegions(where, grid, cells, mesh);
  return mesh;
}

template <typename Reader>
TetMesh ReadWith(Reader& reader, const std::string& where) {
  const VtkMessages messages;
  try {
    reader.SetFileName(where.c_str());
    reader.Update();
  } catch (const std::bad_alloc&) {
    throw InputError(where, "announces more data than memory holds: the file is damaged", kAdvice);
  }
  if (const std::string problem = messages.FirstProblem(); !problem.empty()) {
    throw InputError(where, fmt::format("VTK cannot read it ({})", problem), kAdvice);
  }
  return FromGrid(where, *reader.GetOutput());
}

}  // namespace

TetMesh ReadVtk(const std::filesystem::path& path) {
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->ReadAllScalarsOn();
  reader->ReadAllFieldsOn();
  return ReadWith(*reader.Get(), path.string());
}

TetMesh ReadVtu(const std::filesystem::path& path) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  return ReadWith(*reader.Get(), path.string());
}

}  // namespace softforce::mesh
