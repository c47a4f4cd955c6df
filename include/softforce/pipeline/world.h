#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "softforce/estimation/force_estimator.h"
#include "softforce/fem/static_solver.h"
#include "softforce/mesh/surface.h"
#include "softforce/scene/scene.h"

namespace softforce::pipeline {

// A point of the body's surface that the scene speaks of.
struct BodyPoint {
  mesh::SurfacePoint at;
  mesh::NodalWeights weights;  // its shape functions
  Eigen::Vector3d offset;      // m, from that surface point to the place in the scene, body at rest
};

// The soft body of a scene, ready to compute with.
struct World {
  mesh::Surface surface;
  std::unique_ptr<fem::StaticSolver> solver;
  std::vector<estimation::ForceSite> sites;  // one per candidate of the scene
  std::vector<BodyPoint> markers;            // centres of the scene's markers
  double marker_spacing =
      0;  // m, the smallest distance between two markers, at most the body's size

  const mesh::TetMesh& mesh() const { return solver->body().mesh; }
};

// A place of the scene may be this far off the meshed surface, m.
inline constexpr double kSurfaceTolerance = 3e-3;

// The surface point closest to a place of the scene. Throws InputError naming `where` if it lies
// further than kSurfaceTolerance off the surface.
BodyPoint PlaceOnSurface(const mesh::Surface& surface, const Eigen::Matrix3Xd& X,
                         const Eigen::Vector3d& place, const std::string& where);

// Reads the scene's mesh and puts the body together. Throws InputError for a mesh that cannot be
// used, a region without material, nothing fixed, a marker, candidate or
// cable off the surface, or a chamber that is not closed.
World BuildWorld(const scene::Scene& scene);

// The same with another mesh of the same body, such as a refined one: what the scene says in places
// and boxes (supports, markers, candidates, cables) is looked up anew in it.
World BuildWorld(const scene::Scene& scene, mesh::TetMesh mesh);

// What the scene's actuators are told at a time.
fem::Actuation ActuationAt(const scene::Scene& scene, double time_s);

}  // namespace softforce::pipeline
