#pragma once

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <vector>

#include "softforce/mesh/write_vtu.h"

namespace softforce::mesh {

// The mesh for VTK's writers: nodes, cells, fields and the cell array "region" as WriteVtu
// describes it.
vtkSmartPointer<vtkUnstructuredGrid> ToVtkGrid(const TetMesh& mesh,
                                               const std::vector<PointField>& fields = {},
                                               const std::vector<CellField>& cell_fields = {});

// The surface's triangles; nodes that none of them uses are left out.
vtkSmartPointer<vtkUnstructuredGrid> ToVtkGrid(const Surface& surface, const Eigen::Matrix3Xd& x,
                                               const std::vector<CellField>& fields);

// Points, each a cell of its own.
vtkSmartPointer<vtkUnstructuredGrid> ToVtkGrid(const Eigen::Matrix3Xd& places,
                                               const std::vector<PointField>& fields);

}  // namespace softforce::mesh
