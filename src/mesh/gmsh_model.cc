#include "mesh/gmsh_model.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

using base::InputError;

// Gmsh's numbers of its kinds of element.
constexpr int kTetrahedron4 = 4, kTetrahedron10 = 11;
constexpr int kTriangle3 = 2, kTriangle6 = 9;

// Gmsh's order of edges in a 10-node tetrahedron is 01 12 20 03 23 13.
constexpr std::array<int, 10> kGmshNode{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

// Column of each node tag. Nodes stand in the order of their tags, whatever the format's order.
using Columns = std::unordered_map<std::size_t, int>;

Columns ReadNodes(TetMesh& mesh) {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  std::vector<std::size_t> order(tags.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });

  Columns column;
  column.reserve(tags.size());
  mesh.nodes.resize(3, tags.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    column[tags[order[i]]] = static_cast<int>(i);
    mesh.nodes.col(i) = Eigen::Vector3d::Map(&coordinates[3 * order[i]]);
  }
  return column;
}

std::string GroupName(int dimension, int tag) {
  std::string name;
  gmsh::model::getPhysicalName(dimension, tag, name);
  return name.empty() ? std::to_string(tag) : name;
}

std::string RegionOfVolume(const std::string& where, int volume) {
  std::vector<int> groups;
  gmsh::model::getPhysicalGroupsForEntity(3, volume, groups);
  if (groups.size() > 1) {
    throw InputError(where,
                     fmt::format("volume {} is in the physical volumes \"{}\" and \"{}\", "
                                 "must be in one at most",
                                 volume, GroupName(3, groups[0]), GroupName(3, groups[1])),
                     "A physical volume gives its elements their material.");
  }
  return groups.empty() ? "" : GroupName(3, groups[0]);
}

[[noreturn]] void RefuseMixedOrders(const std::string& where) {
  throw InputError(where, "mixes elements with and without nodes in the middle of their edges",
                   "Mesh the whole body with one element order: 4- or 10-node tetrahedra.");
}

// Tetrahedra or triangles of one geometrical entity.
struct Block {
  int order;
  std::vector<std::size_t> tags;   // of the elements
  std::vector<std::size_t> nodes;  // node tags, one element after another
};

std::vector<Block> SimplexBlocksOf(int dimension, int entity) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const bool linear = types[i] == kTetrahedron4 || types[i] == kTriangle3;
    const bool quadratic = types[i] == kTetrahedron10 || types[i] == kTriangle6;
    if (!linear && !quadratic) continue;
    blocks.push_back({linear ? 1 : 2, tags[i], nodes[i]});
  }
  return blocks;
}

struct Tetrahedron {
  std::size_t tag;
  int region;
  std::array<int, 10> nodes;
};

int IndexOf(const std::string& name, std::vector<std::string>& names) {
  const auto known = std::find(names.begin(), names.end(), name);
  const auto index = known - names.begin();
  if (known == names.end()) names.push_back(name);
  return static_cast<int>(index);
}

void ReadTetrahedra(const std::string& where, const Columns& column, TetMesh& mesh) {
  std::vector<Tetrahedron> tetrahedra;
  int order = 0;
  gmsh::vectorpair volumes;
  gmsh::model::getEntities(volumes, 3);
  for (const auto& volume : volumes) {
    for (const Block& block : SimplexBlocksOf(3, volume.second)) {
      if (order != 0 && block.order != order) RefuseMixedOrders(where);
      order = block.order;
      const int num_nodes = order == 1 ? 4 : 10;
      const int region = IndexOf(RegionOfVolume(where, volume.second), mesh.region_names);
      for (std::size_t i = 0; i < block.tags.size(); ++i) {
        Tetrahedron tetrahedron{block.tags[i], region, {}};
        for (int k = 0; k < num_nodes; ++k) {
          tetrahedron.nodes[k] = column.at(block.nodes[num_nodes * i + kGmshNode[k]]);
        }
        tetrahedra.push_back(tetrahedron);
      }
    }
  }
  std::stable_sort(tetrahedra.begin(), tetrahedra.end(),
                   [](const auto& a, const auto& b) { return a.tag < b.tag; });
  mesh.elements.resize(order == 2 ? 10 : 4, tetrahedra.size());
  for (std::size_t e = 0; e < tetrahedra.size(); ++e) {
    mesh.elements.col(e) = Eigen::VectorXi::Map(tetrahedra[e].nodes.data(), mesh.elements.rows());
    mesh.region.push_back(tetrahedra[e].region);
  }
}

void ReadSurfaceGroups(const Columns& column, TetMesh& mesh) {
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups, 2);
  for (const auto& group : groups) {
    std::map<std::size_t, std::array<int, 3>> triangles;  // by element tag
    std::vector<int> surfaces;
    gmsh::model::getEntitiesForPhysicalGroup(2, group.second, surfaces);
    for (const int surface : surfaces) {
      for (const Block& block : SimplexBlocksOf(2, surface)) {
        const std::size_t num_nodes = block.order == 1 ? 3 : 6;
        for (std::size_t i = 0; i < block.tags.size(); ++i) {
          for (int k = 0; k < 3; ++k) {
            triangles[block.tags[i]][k] = column.at(block.nodes[num_nodes * i + k]);
          }
        }
      }
    }
    auto& named = mesh.surface_groups[GroupName(2, group.second)];
    for (const auto& entry : triangles) named.push_back(entry.second);
  }
}

}  // namespace

TetMesh MeshOfGmshModel(const std::string& where) {
  TetMesh mesh;
  const Columns column = ReadNodes(mesh);
  ReadTetrahedra(where, column, mesh);
  ReadSurfaceGroups(column, mesh);
  return mesh;
}

}  // namespace softforce::mesh
