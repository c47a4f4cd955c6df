#pragma once

#include <opencv2/core.hpp>

#include "render/body_picture.h"
#include "softforce/render/overlay.h"

namespace softforce::render {

// The visible surface in the colours of a field, translucent, darker where it turns away from the
// camera.
void DrawSkin(cv::Mat3b picture, const View& view, const mesh::Surface& surface,
              const Eigen::Matrix3Xd& x, const BodyPicture& body, const SurfaceField& field);

}  // namespace softforce::render
