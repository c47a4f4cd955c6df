#pragma once

#include <Eigen/Core>
#include <vector>

#include "softforce/estimation/location_estimator.h"
#include "softforce/mesh/patches.h"
#include "softforce/mesh/surface_walk.h"

namespace softforce::estimation {

// What acts at a place: the weights of its patch on the nodes and how they change along the
// tangents (3×2), and its directions (3×k).
struct PlacedPatch {
  mesh::MovingPatch patch;
  Eigen::Matrix<double, 3, 2> tangents;
  Eigen::Matrix3Xd directions;
};

// The body's faces, on which forces are placed.
class ForceFaces {
 public:
  ForceFaces(const mesh::Surface& surface, const Eigen::Matrix3Xd& X, double patch, double crease);

  PlacedPatch Place(const mesh::SurfacePoint& at, const LocationCandidate& candidate) const;
  const mesh::SurfaceWalk& walk() const { return walk_; }
  const mesh::Surface& surface() const { return surface_; }

 private:
  const mesh::Surface& surface_;
  Eigen::Matrix3Xd X_;
  mesh::Patches patches_;
  mesh::SurfaceWalk walk_;
};

// A force on its way to being located.
struct TrialForce {
  int identity = -1;
  int candidate = -1;  // whose direction it has
  mesh::SurfacePoint at;
  Eigen::VectorXd intensity;  // N, per direction
};

// The observed points under small changes of the forces, whitened: with all forces F (nodal, N) the
// residual is  whitening · responseᵀ · F − b  (paper eqs. 5 to 8, computed from the observations'
// side).
struct LinearisedPoints {
  const Eigen::MatrixXd* response;  // 3N×3m, m per N: of the nodes to forces on the observed points
  Eigen::MatrixXd whitening;        // rows×3m, 1/m
  Eigen::VectorXd b;

  // What a nodal force of the given weights does, by its three components: rows×3.
  Eigen::MatrixXd Of(const std::vector<int>& nodes, const Eigen::VectorXd& weights) const;
  Eigen::MatrixXd Of(const mesh::NodalWeights& weights) const;
};

// Residual of all forces, and its derivative by each force's intensities and steps (rows×(k+2)).
struct LocationResidual {
  Eigen::VectorXd residual;
  std::vector<Eigen::MatrixXd> J;
};
LocationResidual Evaluate(const LinearisedPoints& points, const ForceFaces& faces,
                          const std::vector<LocationCandidate>& candidates,
                          const std::vector<TrialForce>& forces);

// Moves intensities and places of the forces to the least squares; returns χ².
double FitLocations(const LinearisedPoints& points, const ForceFaces& faces,
                    const std::vector<LocationCandidate>& candidates,
                    std::vector<TrialForce>* forces);

// Fits the intensities alone; returns χ², infinite if they cannot be told apart or would pull.
double FitIntensities(const LinearisedPoints& points, const ForceFaces& faces,
                      const std::vector<LocationCandidate>& candidates,
                      std::vector<TrialForce>* forces);

}  // namespace softforce::estimation
