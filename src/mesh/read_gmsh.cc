#include <fmt/format.h>
#include <gmsh.h>

#include <string>
#include <vector>

#include "mesh/gmsh_file.h"
#include "mesh/gmsh_model.h"
#include "mesh/gmsh_session.h"
#include "mesh/readers.h"
#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

using base::InputError;

// The SDK leaves out what it cannot use without a word.
void CheckCount(const std::string& where, const std::string& what, std::size_t announced,
                std::size_t found, const std::string& advice) {
  if (announced == found) return;
  throw InputError(where, fmt::format("announces {} {}, Gmsh finds {}", announced, what, found),
                   advice);
}

std::size_t CountNodes() {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  return tags.size();
}

std::size_t CountElements() {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes);
  std::size_t count = 0;
  for (const auto& of_type : tags) count += of_type.size();
  return count;
}

}  // namespace

TetMesh ReadGmsh(const std::filesystem::path& path) {
  const std::string where = path.string();
  const GmshFileCounts announced = InspectGmshFile(path);
  const GmshSession session;
  if (const std::string problem = GmshComplaint([&] { gmsh::merge(where); }); !problem.empty()) {
    throw InputError(where, fmt::format("Gmsh cannot read it ({}): the file is damaged", problem),
                     "Export it again, and open it in Gmsh to see more.");
  }

  CheckCount(where, "nodes", announced.nodes, CountNodes(),
             "Either the file is damaged, or it has nodes that no element uses; remove those with: "
             "gmsh -save -format msh22 IN -o OUT.msh");
  CheckCount(
      where, "elements", announced.elements, CountElements(),
      "Either the file is damaged, or it mixes elements with and without nodes in the middle "
      "of their edges; mesh the whole body with one element order.");
  return MeshOfGmshModel(where);
}

}  // namespace softforce::mesh
