#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/design/influence.h"
#include "softforce/design/sight.h"
#include "softforce/geometry/rigid.h"
#include "softforce/pipeline/design.h"
#include "softforce/pipeline/world.h"

namespace softforce::pipeline {

// The cameras of a design, and where they stand. Without cameras: isotropic noise.
struct DesignEyes {
  camera::Rig rig;
  Eigen::Isometry3d T_rig_robot = Eigen::Isometry3d::Identity();
  geometry::Matrix6d registration = geometry::Matrix6d::Zero();  // robot frame
  std::string from;                                              // what told it; empty: no cameras
  double noise = 0;                                              // m, without cameras

  bool any() const { return !from.empty(); }
};

// From the scene's cameras: where the fiducials of its recording have them, or the rig's file, or
// the section "simulation". Throws InputError if nothing says where they stand.
DesignEyes FindEyes(const scene::Scene& scene, const DesignOptions& options);

// How markers at places of the body are seen as it stands at x.
class MarkerEyes {
 public:
  // All must outlive it.
  MarkerEyes(const DesignEyes& eyes, const World& world, const Eigen::Matrix3Xd& x,
             const design::SightOptions& options);

  design::MarkerSight Of(const mesh::SurfacePoint& at) const;
  int NumCameras(const mesh::SurfacePoint& at) const;
  // Cameras that must see a marker: two, if there are so many; its place needs them.
  int needed() const { return needed_; }

 private:
  const DesignEyes& eyes_;
  const World& world_;
  const Eigen::Matrix3Xd& x_;
  std::optional<design::Sight> sight_;
  int needed_ = 0;
};

// The triangles that a surface group or a selector names. `option`: for messages.
std::vector<int> TrianglesOf(const World& world, const std::string& what,
                             const std::string& option);

// Those of options.on, or all.
std::vector<int> MarkerTriangles(const World& world, const DesignOptions& options);

// Places for markers: on these triangles, seen by enough cameras, with room for a marker, not on
// nodes that are held. Sets the spacing. Throws InputError if there are none.
std::vector<mesh::SurfacePoint> MarkerPlaces(const World& world, std::vector<int> triangles,
                                             const MarkerEyes& eyes, const DesignOptions& options,
                                             double* spacing);

// Where forces may act, spread over options.loads (or the faces of the scene's candidates).
struct LoadSurface {
  std::vector<int> triangles;
  double area = 0;  // m²
};
LoadSurface LoadsOn(const World& world, const scene::Scene& scene, const DesignOptions& options);
std::vector<mesh::SurfacePoint> LoadPlaces(const World& world, const LoadSurface& loads,
                                           double spacing);

// A load of the given size at a place: its directions are those of the scene's nearest candidate,
// and where they are free it is expected across the surface.
design::SampledLoad LoadAt(const World& world, const scene::Scene& scene,
                           const mesh::SurfacePoint& at, double size);

// The middles of all triangles that are not held.
std::vector<mesh::SurfacePoint> FreeTriangles(const World& world);

double AreaOf(const World& world, const std::vector<int>& triangles);  // m²

// The files of a design.
struct DesignMaps {
  Eigen::VectorXd best, own;  // m, per triangle of the surface; NaN where it is held
};
void WriteDesign(const scene::Scene& scene, const World& world, const Eigen::Matrix3Xd& x,
                 const DesignEyes& eyes, const LoadSurface& loads, const DesignMaps& maps,
                 const std::vector<Eigen::Vector3d>& shown_best,
                 const std::vector<Eigen::Vector3d>& shown_own, const DesignReport& report);
std::vector<std::string> DesignFiles();

}  // namespace softforce::pipeline
