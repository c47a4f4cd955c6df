#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh/writers.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"

namespace softforce::mesh {
namespace {

using Triangle = std::array<int, 3>;
using Middles = std::map<std::pair<int, int>, int>;  // node in the middle of each edge

// Triangles that belong to the same surface groups, with the tags of those.
struct SurfacePart {
  std::vector<int> groups;
  std::vector<Triangle> triangles;
};

// Gmsh wants each triangle once, so overlapping groups share parts: one part per combination.
std::vector<SurfacePart> SplitIntoParts(const TetMesh& mesh) {
  std::map<Triangle, std::set<int>> groups_of;
  std::vector<Triangle> all;  // each once, in the order of the groups
  int tag = 0;
  for (const auto& [name, triangles] : mesh.surface_groups) {
    ++tag;
    for (const Triangle& triangle : triangles) {
      std::set<int>& groups = groups_of[Sorted(triangle)];
      if (groups.empty()) all.push_back(triangle);
      groups.insert(tag);
    }
  }
  std::map<std::set<int>, std::vector<Triangle>> by_groups;
  for (const Triangle& triangle : all) by_groups[groups_of[Sorted(triangle)]].push_back(triangle);
  std::vector<SurfacePart> parts;
  for (const auto& [groups, triangles] : by_groups) {
    parts.push_back({{groups.begin(), groups.end()}, triangles});
  }
  return parts;
}

Middles FindMiddles(const TetMesh& mesh) {
  Middles middles;
  for (int e = 0; mesh.order() == 2 && e < mesh.num_elements(); ++e) {
    for (int i = 0; i < 6; ++i) {
      const auto [a, b] = kEdges[i];
      middles[std::minmax({mesh.elements(a, e), mesh.elements(b, e)})] = mesh.elements(4 + i, e);
    }
  }
  return middles;
}

// Text of a file that grows.
class Text {
 public:
  template <typename... Args>
  void Add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<Args>(args)...);
  }
  const fmt::memory_buffer& buffer() const { return buffer_; }

 private:
  fmt::memory_buffer buffer_;
};

std::string Box(const TetMesh& mesh) {
  const Eigen::Vector3d low = mesh.nodes.rowwise().minCoeff();
  const Eigen::Vector3d high = mesh.nodes.rowwise().maxCoeff();
  return fmt::format("{} {} {} {} {} {}", low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
}

void AddNames(const TetMesh& mesh, Text& text) {
  const bool has_regions = mesh.region_names != std::vector<std::string>{""};
  const std::size_t regions = std::count_if(mesh.region_names.begin(), mesh.region_names.end(),
                                            [](const std::string& name) { return !name.empty(); });
  if (!has_regions && mesh.surface_groups.empty()) return;
  text.Add("$PhysicalNames\n{}\n", mesh.surface_groups.size() + regions);
  int tag = 0;
  for (const auto& group : mesh.surface_groups) text.Add("2 {} \"{}\"\n", ++tag, group.first);
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r) {
    if (!mesh.region_names[r].empty()) text.Add("3 {} \"{}\"\n", r + 1, mesh.region_names[r]);
  }
  text.Add("$EndPhysicalNames\n");
}

// A surface for each part, a volume for each region, with the groups that they belong to.
void AddEntities(const TetMesh& mesh, const std::vector<SurfacePart>& parts, Text& text) {
  const std::string box = Box(mesh);
  text.Add("$Entities\n0 0 {} {}\n", parts.size(), mesh.region_names.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    text.Add("{} {} {}", p + 1, box, parts[p].groups.size());
    for (const int group : parts[p].groups) text.Add(" {}", group);
    text.Add(" 0\n");
  }
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r) {
    if (mesh.region_names[r].empty()) {
      text.Add("{} {} 0 0\n", r + 1, box);
    } else {
      text.Add("{} {} 1 {} 0\n", r + 1, box, r + 1);
    }
  }
  text.Add("$EndEntities\n");
}

void AddNodes(const TetMesh& mesh, Text& text) {
  text.Add("$Nodes\n1 {0} 1 {0}\n3 1 0 {0}\n", mesh.num_nodes());
  for (int n = 0; n < mesh.num_nodes(); ++n) text.Add("{}\n", n + 1);
  for (const auto& node : mesh.nodes.colwise()) {
    text.Add("{} {} {}\n", node.x(), node.y(), node.z());
  }
  text.Add("$EndNodes\n");
}

// Triangles are numbered after the tetrahedra, so that those keep the numbers they have in memory.
void AddElements(const TetMesh& mesh, const std::vector<SurfacePart>& parts, const Middles& middles,
                 const std::string& where, Text& text) {
  std::vector<std::vector<int>> of_region(mesh.region_names.size());
  for (int e = 0; e < mesh.num_elements(); ++e) of_region[mesh.region[e]].push_back(e);
  std::size_t total = mesh.elements.cols(), blocks = parts.size();
  for (const SurfacePart& part : parts) total += part.triangles.size();
  for (const auto& elements : of_region) blocks += !elements.empty();

  text.Add("$Elements\n{} {} 1 {}\n", blocks, total, total);
  int tag = mesh.num_elements();
  for (std::size_t p = 0; p < parts.size(); ++p) {
    text.Add("2 {} {} {}\n", p + 1, mesh.order() == 2 ? 9 : 2, parts[p].triangles.size());
    for (const Triangle& t : parts[p].triangles) {
      text.Add("{} {} {} {}", ++tag, t[0] + 1, t[1] + 1, t[2] + 1);
      for (int i = 0; mesh.order() == 2 && i < 3; ++i) {
        const auto found = middles.find(std::minmax({t[i], t[(i + 1) % 3]}));
        if (found == middles.end()) {
          throw base::InputError(where,
                                 fmt::format("a surface group names the nodes {}, {} and {}, which "
                                             "are not the corners of a face of a tetrahedron",
                                             t[0], t[1], t[2]),
                                 "Export the mesh with the surfaces of the same volumes only.");
        }
        text.Add(" {}", found->second + 1);
      }
      text.Add("\n");
    }
  }
  for (std::size_t r = 0; r < of_region.size(); ++r) {
    if (of_region[r].empty()) continue;
    text.Add("3 {} {} {}\n", r + 1, mesh.order() == 2 ? 11 : 4, of_region[r].size());
    for (const int e : of_region[r]) {
      Eigen::VectorXi nodes = mesh.elements.col(e);
      if (mesh.order() == 2) std::swap(nodes(8), nodes(9));  // Gmsh's order of edges
      text.Add("{}", e + 1);
      for (const int node : nodes) text.Add(" {}", node + 1);
      text.Add("\n");
    }
  }
  text.Add("$EndElements\n");
}

}  // namespace

void WriteGmsh(const std::filesystem::path& path, const TetMesh& mesh) {
  const std::vector<SurfacePart> parts = SplitIntoParts(mesh);
  Text text;
  text.Add("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
  AddNames(mesh, text);
  AddEntities(mesh, parts, text);
  AddNodes(mesh, text);
  AddElements(mesh, parts, FindMiddles(mesh), path.string(), text);

  base::PendingFile pending(path);
  std::ofstream file(pending.temporary(), std::ios::binary);
  file.write(text.buffer().data(), static_cast<std::streamsize>(text.buffer().size()));
  file.close();
  if (!file) {
    throw base::InputError(path.string(), "cannot be written",
                           "Check that its folder exists, and the space on the disk.");
  }
  pending.Commit();
}

}  // namespace softforce::mesh
