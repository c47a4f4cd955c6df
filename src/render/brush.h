#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "render/alphabet.h"
#include "render/palette.h"
#include "softforce/render/easel.h"

namespace softforce::render {

// Antialiased, translucent shapes on a picture in colour. Shapes are collected first and painted
// together by Paint, so that where they overlap the colour is not laid on twice:
//
//   brush.Line(a, b, 2);
//   brush.Disc(b, 5);
//   brush.Paint(kOrange, 0.8);
class Brush {
 public:
  // One brush at a time may use an easel, which must outlive it.
  Brush(cv::Mat3b picture, Easel* easel);

  // All in px; (0, 0) is the centre of the top-left pixel.
  void Line(const cv::Point2d& a, const cv::Point2d& b, double width);
  void Polyline(const std::vector<cv::Point2d>& points, double width);
  void Polygon(const std::vector<cv::Point2d>& corners);  // convex, filled
  void Disc(const cv::Point2d& centre, double radius);
  // Part of a circle; angles in degrees from the x axis towards y, `from` < `to`.
  void Arc(const cv::Point2d& centre, double radius, double from, double to, double width);
  // Letters of a size (1: capitals of 21 px) and width of their strokes (px). Returns where the pen
  // stands after the last one.
  cv::Point2d Text(const std::string& text, const cv::Point2d& baseline_left, double scale,
                   double width);

  void Paint(const cv::Vec3b& colour, double opacity);

  // Shapes in `colour` with a dark seam, to be read on any picture. `draw(extra)` must collect the
  // shapes with every stroke wider by `extra` px.
  template <typename Draw>
  void PaintSeamed(const cv::Vec3b& colour, double opacity, double seam, const Draw& draw) {
    draw(2 * seam);
    Paint(kBlack, 0.7 * opacity);
    draw(0.0);
    Paint(colour, opacity);
  }

  cv::Size size() const { return picture_.size(); }

 private:
  void Touch(const cv::Rect& box);

  cv::Mat3b picture_;  // shares the caller's pixels
  Alphabet* alphabet_;
  cv::Mat1b mask_;  // coverage of the collected shapes; 0 outside `touched_`
  cv::Rect touched_;
};

}  // namespace softforce::render
