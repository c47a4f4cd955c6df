#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "softforce/pipeline/world.h"

namespace softforce::pipeline {

// What the mesh's own error is corrected to, see AssessMesh: nothing, what the once refined mesh
// shows, or the limit that is estimated from it.
enum class MeshAim { kGiven, kRefined, kConverged };

const char* Name(MeshAim aim);  // "none", "refined", "converged"

struct MeshConvergenceOptions {
  // Locally refined meshes are made until a further one is expected to change the compliance by
  // less than this share, or would have more than so many times the degrees of freedom of the
  // given, or there are so many.
  double settled = 2e-3;
  double max_local_growth = 8;
  int max_levels = 12;
  double max_memory_gb = 8;  // refused if finer meshes are expected to need more
  // Loads for the comparison at large displacement: N on every candidate, or, if 0, what moves the
  // softest candidate by `working_deflection` of the body's largest side. A negative
  // `working_deflection` leaves the comparison out.
  double working_load = 0;
  double working_deflection = 0.05;
  bool show_progress = true;

  void Check() const;  // throws InputError naming the option
};

// How much too small a displacement on the given mesh is, as a share of it.
struct MeshBias {
  double refined = NAN;    // against the mesh with every cell cut into 8
  double converged = NAN;  // against the limit of ever finer meshes, estimated; NaN if it cannot be
  double uncertain = NAN;  // part of `converged` that is extrapolated, not computed; ≥ 0
};

struct CandidateMeshBias {
  int id;             // of the scene's candidate
  double compliance;  // m/N, of the place along the force, given mesh
  MeshBias own;       // of the displacement of the place under its own force
};

struct MarkerMeshBias {
  int id;
  MeshBias bias;  // over the forces on all candidates, each weighted by how far it moves the marker
};

// Where the mesh is too coarse: cells that lie close together.
struct CoarsePlace {
  Eigen::Vector3d centre;  // m, weighted by share
  double radius;           // m, root mean square distance of its cells from the centre, × √2
  double share;            // of the difference between the given and the once refined mesh
  double size;             // m, median edge of its cells
  double wanted_size;      // m, edge that leaves a tenth of the error, at the rate observed
};

// The comparison at large displacement.
struct WorkingMeshBias {
  bool ok = false;
  std::string problem;      // if it was tried and is not ok: one line, with advice
  double load = NAN;        // N on each candidate
  double deflection = NAN;  // m, of the candidate that moves most, given mesh
  MeshBias displacement;    // of the markers, by least squares
  MeshBias force;           // by how much forces found with the given mesh are too large
};

// A mesh of the same body, refined where it matters.
struct LocalMesh {
  mesh::TetMesh mesh;
  MeshBias remaining;
};

struct MeshConvergence {
  int cells = 0, refined_cells = 0;
  int dofs = 0, refined_dofs = 0;
  bool locks = false;         // 4-node cells: no limit is estimated
  bool point_forces = false;  // no patch: a candidate's own displacement has no limit
  MeshBias overall;  // of the markers at small displacement, over all candidates, least squares
  std::vector<CandidateMeshBias> candidates;  // a line per direction
  std::vector<MarkerMeshBias> markers;
  WorkingMeshBias working;
  std::vector<CoarsePlace> places;  // largest share first
  Eigen::VectorXd cell_share;  // per given cell, of the difference to the once refined mesh; sum 1
  std::vector<LocalMesh> local;  // coarse to fine

  std::string BriefReport() const;  // one line
  std::string FullReport() const;
};

// Finds how far a scene's mesh is from converged, from the compliance W (displacement per newton)
// of its markers and candidates at rest, cables slack: on the given mesh, on the mesh with every
// cell cut into 8, and on a sequence of meshes refined where the error sits.
//
// The bias is b = 〈W_given, W_fine〉/|W_given|² − 1, over markers and forces. Each cell's part of
// it is known exactly: it is the elastic work between what refining changed in the displacements
// and in the dual displacements, which the markers' weights in b cause if they act as forces. Cells
// with half of the expected error are cut at each level; what is left after the last level is
// estimated from the cells' changes and the rate at which the error falls at a clamped edge.
// Supports given as boxes are looked up anew in each mesh. Of 4-node cells, which lock, there is no
// limit, only the comparison with the once refined mesh. See docs/mesh_convergence.md. Throws
// InputError if no marker or a candidate cannot move, or the refined mesh would be too large.
MeshConvergence AssessMesh(const scene::Scene& scene, const World& given,
                           const MeshConvergenceOptions& options = {});

// Writes the given mesh with the cell field "bias_share", for ParaView. Throws InputError if the
// file cannot be written.
void WriteCellShares(const std::filesystem::path& path, const World& given,
                     const MeshConvergence& convergence);

}  // namespace softforce::pipeline
