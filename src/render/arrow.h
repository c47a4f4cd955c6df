#pragma once

#include <optional>

#include "render/brush.h"
#include "render/depth_buffer.h"
#include "softforce/render/overlay.h"

namespace softforce::render {

// The arrow of a force in space, m, robot frame.
struct Arrow {
  Eigen::Vector3d tail, tip;
};

// A push ends at its place, a pull starts there: the arrow stays outside the body.
Arrow PlaceArrow(const OverlayForce& force, const OverlayScene& scene, double metres_per_newton);

// An arrow as it is seen; its ends are the pictures of the ends in space.
struct ArrowPicture {
  std::vector<cv::Point2d> shaft;  // px, from tail to tip
  std::vector<bool> hidden;        // of each piece of the shaft
  bool pulls = false;              // the place of the force is the tail, not the tip
  cv::Point2d free_end;            // px, the end away from the body
  cv::Point2d outwards;            // unit vector in the picture from the body to the free end, or 0
};

// Nothing if the lens does not show all of it.
std::optional<ArrowPicture> PictureArrow(const View& view, const DepthBuffer& depth,
                                         const Arrow& arrow, const Eigen::Vector3d& place);

// Shaft and head, fainter where the body hides them; a force along the line of sight is drawn as a
// circle with a dot if it comes towards the camera and with an x if it goes away.
void DrawArrow(Brush* brush, const View& view, const Arrow& arrow, const ArrowPicture& picture);

}  // namespace softforce::render
