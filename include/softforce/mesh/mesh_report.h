#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

// An extreme value and where in the body it is (m).
struct Worst {
  double value = NAN;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
};

struct RegionReport {
  std::string name;  // "" for elements without a physical volume
  int elements = 0;
  double volume = 0;  // m³
};

struct SurfaceGroupReport {
  std::string name;
  int triangles = 0;
  double area = 0;                                   // m²
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // m, mean over the area
  bool closed = false;                               // no edge belongs to one triangle only
  double enclosed_volume = 0;                        // m³, if closed
  int off_surface = 0;                               // triangles that are not on the surface
};

// What a mesh is made of, and how well it suits a simulation.
struct MeshReport {
  int order = 1, nodes = 0, elements = 0;
  Eigen::Vector3d low, high;  // bounding box, m
  double volume = 0;          // m³
  double solid_volume = NAN;  // m³, of the geometry that was meshed; NaN if not known
  int parts = 0;              // that share no node
  int parts_by_faces = 0;     // that share no face
  int cavities = 0;           // hollows without a way out
  std::vector<RegionReport> regions;
  std::vector<SurfaceGroupReport> groups;

  // Shape of the elements: mean ratio of the corners, 1 for a regular tetrahedron, 0 for a flat
  // one.
  Worst least_quality;
  double quality_1_percent = 0, median_quality = 0;
  int poor_elements = 0;                                      // quality below kPoorQuality
  double least_dihedral = 0, greatest_dihedral = 0;           // rad
  double least_edge = 0, median_edge = 0, greatest_edge = 0;  // m
  // 10-node elements: least over greatest volume per unit of the reference element within one
  // element; 1 if edges are straight.
  Worst least_jacobian_ratio;

  // Share of the surface with so many cells to the opposite wall; all 0 if there is none.
  double one_cell_thick = 0, two_cells_thick = 0, more_cells_thick = 0;
  Worst thinnest;  // m, distance to the opposite wall

  int coincident_nodes = 0;  // at the place of another one
  Eigen::Vector3d coincident_at = Eigen::Vector3d::Zero();

  int overlapping_cells = 0;  // their centres lie within a cell of another part
  Eigen::Vector3d overlapping_at = Eigen::Vector3d::Zero();

  std::vector<std::string> warnings;  // each with advice

  std::string BriefReport() const;  // one line
  std::string FullReport() const;   // a table, and the warnings
};

inline constexpr double kPoorQuality = 0.1;

// Examines a mesh that CheckMesh accepts. `solid_volume` (m³): of the geometry that it was made
// from, if that is known.
MeshReport ExamineMesh(const TetMesh& mesh, double solid_volume = NAN);

}  // namespace softforce::mesh
