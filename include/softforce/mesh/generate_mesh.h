#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "softforce/mesh/tet_mesh.h"

namespace softforce::mesh {

struct GenerateOptions {
  double size = NAN;           // m, wanted edge length of the tetrahedra; NaN: what the file says
  double feature_angle = 0.7;  // rad; STL: facets that meet more sharply are divided by an edge
  int optimise = 1;            // passes that improve the shapes of the tetrahedra, 0 to 2
  int per_circle = 0;  // CAD and scripts: at least so many edges around a full circle; 0: only size

  void Check() const;  // throws InputError naming the command's option
};

struct GeneratedMesh {
  TetMesh mesh;                       // order 1, unless a script asks for order 2
  double solid_volume = NAN;          // m³, of the geometry that was meshed; NaN if not known
  std::vector<std::string> warnings;  // each with advice
};

// Whether GenerateMesh reads such a file: .stl, .step, .stp, .brep or .geo.
bool IsGeometryFile(const std::filesystem::path& path);

// Whether such a file says itself how long its unit is: .step and .stp.
bool CarriesItsUnit(const std::filesystem::path& path);

// Fills a solid with 4-node tetrahedra, through Gmsh:
// - .stl: closed surfaces of triangles, text or binary; a surface within another one bounds a
//   cavity. They are cut anew into triangles of options.size, or kept as they are if that is NaN.
// - .step, .stp, .brep: the solids of a CAD file; options.size is needed.
// - .geo: a script of Gmsh. Its physical volumes and surfaces become regions and surface groups. A
//   size in the options overrides those of the script.
// Without physical volumes the whole body is one region without a name. Coordinates are multiplied
// by `metres_per_unit`, except for STEP files. The same input gives the same mesh. Throws
// InputError if the file is missing, damaged or no closed solid, or Gmsh cannot fill it. Works in a
// forked process, so that a crash in a CAD library ends with an InputError too.
GeneratedMesh GenerateMesh(const std::filesystem::path& path, double metres_per_unit,
                           const GenerateOptions& options = {});

}  // namespace softforce::mesh
