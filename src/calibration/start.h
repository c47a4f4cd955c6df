#pragma once

#include <optional>

#include "calibration/estimate.h"

namespace softforce::calibration {

// Median distance between where the points of a picture are and where they should be, px.
double MedianError(const camera::Lens& lens, const BoardShape& board,
                   const Eigen::Isometry3d& T_camera_board,
                   const std::vector<const Sighting*>& picture);

// Where the board stands before one camera, from its picture through a lens as it is: by the
// homography of the plane, which up to half of the points may spoil. Nothing if there is no pose
// with the board before the camera.
std::optional<Eigen::Isometry3d> PoseOfBoard(const camera::Lens& lens, const BoardShape& board,
                                             const std::vector<const Sighting*>& picture);

// A lens for one camera and the poses of the board in its pictures (into T_rig_board of `views`
// that it saw), from nothing but the sightings: of many focal lengths the one with which the
// pictures look most like pictures of the board, then an adjustment of this camera on its own.
struct CameraStart {
  bool ok = false;
  camera::Lens lens;
  std::vector<std::optional<Eigen::Isometry3d>> T_camera_board;  // per view
};
CameraStart StartCamera(const BoardShape& board, const std::vector<Sighting>& sightings,
                        const CameraToCalibrate& camera, LensFit fit, int camera_index,
                        int num_views);

// The cameras that are connected by views which both ends of a link see.
std::vector<std::vector<int>> ConnectedCameras(const std::vector<std::vector<int>>& shared_views);

// How many views each pair of cameras shares.
std::vector<std::vector<int>> SharedViews(const std::vector<Sighting>& sightings, int num_cameras,
                                          int num_views);

// Puts the cameras and boards of an estimate into the frame of the first camera, along the spanning
// tree with the most shared views. A relative pose is taken from the view whose answer suits the
// other views best.
void PlaceCameras(const BoardShape& board, const std::vector<Sighting>& sightings,
                  const std::vector<CameraStart>& starts,
                  const std::vector<std::vector<int>>& shared_views, Estimate* estimate);

}  // namespace softforce::calibration
