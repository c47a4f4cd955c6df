#include "softforce/mesh/write_vtu.h"

#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "mesh/vtk_grid.h"
#include "mesh/vtk_messages.h"
#include "mesh/writers.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"

namespace softforce::mesh {
namespace {

template <typename Writer>
void WriteWith(Writer& writer, const std::filesystem::path& path, vtkUnstructuredGrid* grid) {
  const VtkMessages messages;
  base::PendingFile file(path);
  writer.SetFileName(file.temporary().c_str());
  writer.SetInputData(grid);
  if (writer.Write() == 0 || !messages.FirstProblem().empty()) {
    throw base::InputError(path.string(),
                           fmt::format("cannot be written ({})", messages.FirstProblem()),
                           "Check that its folder exists, and the space on the disk.");
  }
  file.Commit();
}

}  // namespace

void WriteVtu(const std::filesystem::path& path, const TetMesh& mesh,
              const std::vector<PointField>& fields, const std::vector<CellField>& cell_fields) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  WriteWith(*writer.Get(), path, ToVtkGrid(mesh, fields, cell_fields));
}

void WriteSurfaceVtu(const std::filesystem::path& path, const Surface& surface,
                     const Eigen::Matrix3Xd& x, const std::vector<CellField>& fields) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  WriteWith(*writer.Get(), path, ToVtkGrid(surface, x, fields));
}

void WritePointsVtu(const std::filesystem::path& path, const Eigen::Matrix3Xd& places,
                    const std::vector<PointField>& fields) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  WriteWith(*writer.Get(), path, ToVtkGrid(places, fields));
}

void WriteLegacyVtk(const std::filesystem::path& path, const TetMesh& mesh) {
  vtkNew<vtkUnstructuredGridWriter> writer;
  writer->SetFileTypeToBinary();  // its text has fewer digits than a double
  WriteWith(*writer.Get(), path, ToVtkGrid(mesh));
}

}  // namespace softforce::mesh
