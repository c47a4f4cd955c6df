#pragma once

#include <gmsh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "softforce/mesh/tet_mesh.h"
#include "support/box_mesh.h"

namespace softforce::testing {

namespace fs = std::filesystem;

// A folder of the running test's own.
inline fs::path FreshFolder() {
  const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name();
  std::replace(name.begin(), name.end(), '/', '_');
  const fs::path folder = fs::path(::testing::TempDir()) / "softforce_mesh_test" / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

inline std::string ReadText(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline fs::path WriteText(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

// A box of 20 × 30 × 10 mm with the regions "soft" and "stiff".
inline mesh::TetMesh MakeTwoRegionBox(int order) {
  mesh::TetMesh box = MakeBox(2, 3, 1, {0.02, 0.03, 0.01});
  box.region_names = {"soft", "stiff"};
  std::fill(box.region.begin() + box.num_elements() / 2, box.region.end(), 1);
  return order == 2 ? mesh::RaiseOrder(box) : box;
}

struct GmshFormat {
  double version;
  bool binary;
};

// Writes a mesh in millimetres through Gmsh itself: regions as physical volumes, surface groups as
// physical surfaces (6-node triangles at order 2).
inline void WriteGmsh(const fs::path& path, const mesh::TetMesh& mesh, const GmshFormat& format) {
  const auto tag = [](int number) { return static_cast<std::size_t>(number) + 1; };
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::model::add("test");

  std::size_t element_tag = 1;
  std::map<std::pair<int, int>, int> middle;
  std::vector<std::size_t> node_tags;
  for (int n = 0; n < mesh.num_nodes(); ++n) node_tags.push_back(tag(n));
  for (int r = 0; r < static_cast<int>(mesh.region_names.size()); ++r) {
    gmsh::model::addDiscreteEntity(3, r + 1);
    if (r == 0) {
      const Eigen::Matrix3Xd nodes_mm = 1e3 * mesh.nodes;
      gmsh::model::mesh::addNodes(3, 1, node_tags,
                                  {nodes_mm.data(), nodes_mm.data() + nodes_mm.size()});
    }
    std::vector<std::size_t> tags, nodes;
    for (int e = 0; e < mesh.num_elements(); ++e) {
      for (int i = 0; i < 6 && mesh.order() == 2; ++i) {
        const auto [a, b] = mesh::kEdges[i];
        const auto ends = std::minmax(mesh.elements(a, e), mesh.elements(b, e));
        middle[{ends.first, ends.second}] = mesh.elements(4 + i, e);
      }
      if (mesh.region[e] != r) continue;
      tags.push_back(element_tag++);
      Eigen::VectorXi element = mesh.elements.col(e);
      if (mesh.order() == 2) std::swap(element(8), element(9));  // Gmsh's order of edges
      for (const int node : element) nodes.push_back(tag(node));
    }
    gmsh::model::mesh::addElementsByType(r + 1, mesh.order() == 2 ? 11 : 4, tags, nodes);
    const int group = gmsh::model::addPhysicalGroup(3, {r + 1});
    gmsh::model::setPhysicalName(3, group, mesh.region_names[r]);
  }
  for (const auto& [name, triangles] : mesh.surface_groups) {
    const int surface = gmsh::model::addDiscreteEntity(2);
    std::vector<std::size_t> tags, nodes;
    for (const auto& triangle : triangles) {
      tags.push_back(element_tag++);
      for (const int node : triangle) nodes.push_back(tag(node));
      for (int i = 0; i < 3 && mesh.order() == 2; ++i) {
        const auto ends = std::minmax(triangle[i], triangle[(i + 1) % 3]);
        nodes.push_back(tag(middle.at({ends.first, ends.second})));
      }
    }
    gmsh::model::mesh::addElementsByType(surface, mesh.order() == 2 ? 9 : 2, tags, nodes);
    gmsh::model::setPhysicalName(2, gmsh::model::addPhysicalGroup(2, {surface}), name);
  }

  gmsh::option::setNumber("Mesh.MshFileVersion", format.version);
  gmsh::option::setNumber("Mesh.Binary", format.binary);
  gmsh::write(path.string());
  gmsh::finalize();
}

// A legacy VTK file in millimetres, with the region of each element counted from 1.
inline std::string LegacyVtk(const mesh::TetMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  text << "# vtk DataFile Version 3.0\nbox\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  text << "POINTS " << mesh.num_nodes() << " double\n" << 1e3 * mesh.nodes.transpose() << "\n";
  const auto nodes_per_cell = mesh.elements.rows();
  text << "CELLS " << mesh.num_elements() << " " << mesh.num_elements() * (nodes_per_cell + 1)
       << "\n";
  for (int e = 0; e < mesh.num_elements(); ++e) {
    text << nodes_per_cell << " " << mesh.elements.col(e).transpose() << "\n";
  }
  text << "CELL_TYPES " << mesh.num_elements() << "\n";
  for (int e = 0; e < mesh.num_elements(); ++e) text << (mesh.order() == 2 ? 24 : 10) << "\n";
  text << "CELL_DATA " << mesh.num_elements() << "\nSCALARS region int 1\nLOOKUP_TABLE default\n";
  for (const int region : mesh.region) text << region + 1 << "\n";
  return text.str();
}

}  // namespace softforce::testing
