#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/mesh/surface.h"

namespace softforce::render {

// From where a body is looked at.
struct MapView {
  std::string name;
  camera::Camera camera;
  Eigen::Isometry3d T_camera_robot = Eigen::Isometry3d::Identity();
};

// A view without distortion from a direction (unit vector, from the body towards the eye), from so
// far that perspective is slight.
MapView PlainView(const std::string& name, const Eigen::Matrix3Xd& x,
                  const Eigen::Vector3d& direction);

// What is drawn on the body in one row of pictures.
struct MapRow {
  std::string title;
  Eigen::VectorXd values;                // of each triangle of the surface; NaN: none, grey
  std::vector<Eigen::Vector3d> markers;  // m, robot frame; drawn as labelled discs where seen
  std::vector<std::string> labels;       // one per marker
};

// Values as colours on a logarithmic scale, of a map that people with common colour vision
// deficiencies read as well (viridis: dark is low).
struct MapScale {
  std::string title;          // with its unit
  double low = 1, high = 10;  // > 0; what is beyond has the colour of the end
};

// The body (nodes at x, 3×N, m) drawn once per view and row, each picture as large as the body
// allows, with edges and creases as lines and the scale beside them.
cv::Mat DrawSurfaceMaps(const mesh::Surface& surface, const Eigen::Matrix3Xd& x,
                        const std::vector<MapView>& views, const std::vector<MapRow>& rows,
                        const MapScale& scale);

// The scale's colour of a value, blue green red.
cv::Vec3b MapColour(double value, const MapScale& scale);

}  // namespace softforce::render
