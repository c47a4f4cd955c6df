#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "softforce/camera/rig.h"
#include "softforce/render/easel.h"

namespace softforce::render {

// Where the pictures of several cameras go that are shown side by side. Width and height are even,
// as video codecs want them.
struct PictureRow {
  cv::Size size;                // px, of all
  std::vector<cv::Rect> cells;  // px, of each picture
};

// Pictures of these sizes (px), scaled down together to at most `max_width` px.
PictureRow SideBySide(const std::vector<cv::Size>& pictures, int max_width);

// A picture (8 bits, grey or colour) in colour, in the size of the cell.
void PutPicture(const cv::Mat& picture, cv::Mat3b cell);

// The camera whose picture has been scaled from one size to another (px).
camera::Camera Scaled(const camera::Camera& camera, const cv::Size& from, const cv::Size& to);

// A camera's name at the bottom left of its picture.
void DrawName(cv::Mat3b cell, const std::string& name, Easel* easel);

}  // namespace softforce::render
