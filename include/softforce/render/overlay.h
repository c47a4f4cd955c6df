#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/mesh/surface.h"
#include "softforce/render/easel.h"

namespace softforce::render {

enum class MarkerMark { kSeen, kOneCamera, kHidden, kRejected };

struct OverlayMarker {
  std::string label;
  MarkerMark mark;
  Eigen::Vector3d p_robot;  // m; measured if seen, else where the model expects it
  // m², of that place; its 95 % region is drawn. 0 or not finite: none is.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

struct OverlayForce {
  std::string label;        // drawn beside the value
  Eigen::Vector3d p_robot;  // m, where it acts on the deformed body
  Eigen::Vector3d force;    // N
  double sd_norm = 0;       // N, standard deviation of its norm
  // Of the force (N²) and of its place (m²): 95 % regions are drawn at the free end of the arrow,
  // to its scale, and at the place. 0 or not finite: none is.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d place_covariance = Eigen::Matrix3d::Zero();
};

struct OverlayCandidate {
  std::string label;
  Eigen::Vector3d p_robot;  // m, on the deformed body
};

// A number at every node, shown as colour over the body.
struct SurfaceField {
  std::string name, unit;  // for the scale: "displacement", "mm"
  Eigen::VectorXd values;  // N, in `unit`, ≥ 0
  double largest = 1;      // in `unit`; the end of the scale
};

struct OverlayCable {
  std::vector<Eigen::Vector3d> path;  // m, robot frame, attachment to guide
};

// What to draw over one frame. All places in the robot frame, metres.
struct OverlayScene {
  const mesh::Surface* surface = nullptr;
  const Eigen::Matrix3Xd* x = nullptr;  // 3×N deformed nodes
  std::vector<OverlayMarker> markers;
  std::vector<OverlayForce> forces;
  std::vector<OverlayCable> cables;
  std::vector<OverlayCandidate> candidates;
  std::optional<SurfaceField> field;
  double axes = 0;                   // m, length of the robot frame's axes; 0: not drawn
  std::vector<std::string> caption;  // lines at the top left
};

struct OverlayOptions {
  double metres_per_newton = 0.08;  // length of an arrow in space
  bool net = true;                  // the edges of the body's surface
};

// Draws the scene over a camera's picture: the body's visible surface as a net, over colours with a
// scale if there is a field (faces behind others or turned away are not drawn), markers by status,
// candidates, cables, axes (x red, y green, z blue), 95 % regions, and force arrows with their
// value in newtons; everything goes through the lens model. Strokes and letters are fitted to the
// picture's size. An arrow ends at the place where a push acts and starts there where the force
// pulls, so that it stays outside the body; parts of it behind the body are fainter. A push or a
// pull is told by the surface's normal; without a surface every force counts as a push.
void DrawOverlay(cv::Mat3b picture, const camera::Camera& camera,
                 const Eigen::Isometry3d& T_camera_robot, const OverlayScene& scene,
                 const OverlayOptions& options = {}, Easel* easel = nullptr);

}  // namespace softforce::render
