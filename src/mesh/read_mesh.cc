#include "softforce/mesh/read_mesh.h"

#include <fmt/format.h>

#include <cassert>

#include "mesh/generate.h"
#include "mesh/readers.h"
#include "softforce/base/input_error.h"

namespace softforce::mesh {

TetMesh ReadMesh(const std::filesystem::path& path, double metres_per_unit) {
  assert(metres_per_unit > 0);
  using base::InputError;
  const std::string where = path.string();
  const std::string extension = LowerExtension(path);
  if (extension != ".msh" && extension != ".vtk" && extension != ".vtu") {
    throw InputError(
        where, fmt::format("its extension is \"{}\", must be .msh (Gmsh), .vtk or .vtu", extension),
        "Convert it, for example with: gmsh -3 -format msh41 IN -o OUT.msh");
  }
  if (!std::filesystem::exists(path)) {
    throw InputError(where, "there is no such file",
                     "Paths in a scene are relative to the scene's folder.");
  }
  if (!std::filesystem::is_regular_file(path)) throw InputError(where, "is not a file");
  if (std::filesystem::file_size(path) == 0) {
    throw InputError(where, "the file is empty", "Export the mesh again.");
  }

  TetMesh mesh = extension == ".msh"   ? ReadGmsh(path)
                 : extension == ".vtk" ? ReadVtk(path)
                                       : ReadVtu(path);
  if (mesh.num_elements() == 0) {
    throw InputError(
        where, fmt::format("has {} nodes, but no tetrahedron of 4 or 10 nodes", mesh.num_nodes()),
        "Mesh the volume, not only its surface (in Gmsh: gmsh -3), and put it into a "
        "physical volume.");
  }
  mesh.nodes *= metres_per_unit;
  return mesh;
}

}  // namespace softforce::mesh
