#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "softforce/fem/material.h"
#include "softforce/mesh/surface.h"
#include "softforce/mesh/tet_mesh.h"

namespace softforce::fem {

// A cable that runs freely through points of the body and out to a guide fixed in space. It pulls,
// never pushes, and its directions follow the deformation.
struct Cable {
  std::string name;
  std::vector<mesh::NodalWeights> points;  // attachment first, then via points towards the guide
  Eigen::Vector3d guide;                   // m, robot frame
};

// A hollow of the body that is filled at a known pressure, which follows the deformation.
struct Chamber {
  std::string name;
  // Node numbers of the surface triangles around it, 3×T or 6×T as in mesh::Surface: corners
  // counter-clockwise seen from the hollow. Closed, but for rims on fixed nodes.
  Eigen::MatrixXi walls;
};

// One component of a node's displacement that is held at zero: a plane of symmetry, a sliding
// support.
struct FixedComponent {
  int node = 0;
  int axis = 0;  // 0, 1, 2: x, y, z
};

// A soft body: cells, what they are made of, where they are held, and what drives them.
struct Body {
  mesh::TetMesh mesh;                            // 4- or 10-node cells, at rest
  std::vector<Material> materials;               // of each region of the mesh
  std::vector<int> fixed_nodes;                  // do not move
  std::vector<FixedComponent> fixed_components;  // besides those of the fixed nodes
  std::vector<Cable> cables;
  std::vector<Chamber> chambers;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  // m/s²
  double density = 0;                                 // kg/m³

  // Throws InputError, naming `where`, if any part of the body that hangs together could drift or
  // spin away, or if a material, a cable or a chamber is of
  // no use.
  void Check(const std::string& where) const;
};

}  // namespace softforce::fem
