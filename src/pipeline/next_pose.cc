#include "softforce/pipeline/next_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "softforce/base/input_error.h"

namespace softforce::pipeline {
namespace {

constexpr std::array<Facing, 4> kSides = {Facing::kLeft, Facing::kRight, Facing::kUp,
                                          Facing::kDown};

// What one camera has seen.
struct Seen {
  Eigen::MatrixXi regions;  // points in each, rows × columns
  std::array<int, 4> sides{};
  int views = 0, shared = 0;
};

Seen WhatCameraSaw(const calibration::CalibrationInput& input, int c, const GuideOptions& options) {
  const calibration::CameraToCalibrate& camera = input.cameras[c];
  Seen seen;
  seen.regions = Eigen::MatrixXi::Zero(options.rows, options.columns);
  for (const calibration::CalibrationView& view : input.views) {
    const vision::BoardView& own = view.seen[c];
    if (own.size() == 0) continue;
    ++seen.views;
    const auto others = std::count_if(view.seen.begin(), view.seen.end(),
                                      [](const auto& other) { return other.size() > 0; });
    if (others > 1) ++seen.shared;
    for (const Eigen::Vector2d& pixel : own.pixels) {
      const auto place = [](double pixels, int size, int parts) {
        return std::clamp(static_cast<int>((pixels + 0.5) / size * parts), 0, parts - 1);
      };
      ++seen.regions(place(pixel.y(), camera.height, options.rows),
                     place(pixel.x(), camera.width, options.columns));
    }
    const Facing facing = FacingOf(input.board, own, camera, options.tilt);
    for (size_t i = 0; i < kSides.size(); ++i) seen.sides[i] += facing == kSides[i] ? 1 : 0;
  }
  return seen;
}

// How much of what is wanted of one camera is there, 0 … 1.
double Share(const Seen& seen, bool alone, const GuideOptions& options) {
  double regions = 0, sides = 0;
  for (Eigen::Index i = 0; i < seen.regions.size(); ++i) {
    regions += seen.regions.data()[i] > 0 ? 1.0 / static_cast<double>(seen.regions.size()) : 0;
  }
  for (const int count : seen.sides) {
    sides += 0.25 * std::min(1.0, static_cast<double>(count) / options.views_per_tilt);
  }
  const double views = std::min(1.0, static_cast<double>(seen.views) / options.min_views);
  const double shared =
      alone ? 1 : std::min(1.0, static_cast<double>(seen.shared) / options.min_views);
  return (regions + sides + views + shared) / 4;
}

WantedPose Want(const Seen& seen, int c, bool alone, const GuideOptions& options) {
  WantedPose pose;
  pose.camera = c;
  pose.column = options.columns / 2;
  pose.row = options.rows / 2;
  const auto fewest = std::min_element(seen.sides.begin(), seen.sides.end());
  if (*fewest < options.views_per_tilt) pose.facing = kSides[fewest - seen.sides.begin()];
  Eigen::Index row = 0, column = 0;
  if (seen.regions.minCoeff(&row, &column) == 0) {
    pose.row = static_cast<int>(row);
    pose.column = static_cast<int>(column);
  } else {
    pose.shared = !alone && seen.shared < options.min_views;
  }
  return pose;
}

const char* FacingText(Facing facing) {
  switch (facing) {
    case Facing::kAny:
      return "any tilt";
    case Facing::kLeft:
      return "face turned to the left by 30 to 45 degrees";
    case Facing::kRight:
      return "face turned to the right by 30 to 45 degrees";
    case Facing::kUp:
      return "face turned up by 30 to 45 degrees";
    case Facing::kDown:
      return "face turned down by 30 to 45 degrees";
  }
  return "";
}

}  // namespace

void GuideOptions::Check() const {
  const auto check = [](bool right, const char* name, int got) {
    if (!right) throw base::InputError(name, fmt::format("got {}, expected at least 1", got));
  };
  check(columns >= 1, "columns", columns);
  check(rows >= 1, "rows", rows);
  check(views_per_tilt >= 1, "views_per_tilt", views_per_tilt);
  check(min_views >= 1, "min_views", min_views);
  check(max_views >= 1, "--max-views", max_views);
  if (!(max_uncertainty_px > 0)) {
    throw base::InputError("--max-uncertainty",
                           fmt::format("got {}, expected more than 0 px", max_uncertainty_px));
  }
  if (!(tilt > 0 && tilt < 1.5)) {
    throw base::InputError("tilt", fmt::format("got {}, expected 0 to 1.5 rad", tilt));
  }
}

std::string RegionText(const WantedPose& pose, const GuideOptions& options) {
  const auto word = [](int place, int parts, const char* first, const char* last) {
    return std::string(3 * place < parts ? first : 3 * (place + 1) > 2 * parts ? last : "");
  };
  const std::string vertical = word(pose.row, options.rows, "top", "bottom");
  const std::string horizontal = word(pose.column, options.columns, "left", "right");
  if (vertical.empty() && horizontal.empty()) return "middle";
  return vertical + (vertical.empty() || horizontal.empty() ? "" : " ") + horizontal;
}

std::string Guidance::Text(const calibration::CalibrationInput& input,
                           const GuideOptions& options) const {
  if (!next) return "enough has been seen";
  return fmt::format("{}: {} of the picture, {}{}", input.cameras[next->camera].name,
                     RegionText(*next, options), FacingText(next->facing),
                     next->shared ? ", where another camera sees it too" : "");
}

Facing FacingOf(const std::vector<Eigen::Vector3d>& board, const vision::BoardView& seen,
                const calibration::CameraToCalibrate& camera, double min_tilt) {
  if (seen.size() < 4) return Facing::kAny;
  const double focal = camera.width / 2.0 / std::tan(0.436);  // 25° to each side
  std::vector<cv::Point2d> places, rays;
  for (int i = 0; i < seen.size(); ++i) {
    places.emplace_back(board[seen.ids[i]].x(), board[seen.ids[i]].y());
    rays.emplace_back((seen.pixels[i].x() - camera.width / 2.0) / focal,
                      (seen.pixels[i].y() - camera.height / 2.0) / focal);
  }
  const cv::Mat H = cv::findHomography(places, rays);
  if (H.empty()) return Facing::kAny;
  const Eigen::Vector3d along_x(H.at<double>(0, 0), H.at<double>(1, 0), H.at<double>(2, 0));
  const Eigen::Vector3d along_y(H.at<double>(0, 1), H.at<double>(1, 1), H.at<double>(2, 1));
  Eigen::Vector3d normal = along_x.normalized().cross(along_y.normalized()).normalized();
  if (normal.z() > 0) normal = -normal;  // towards the camera
  cv::Point2d middle(0, 0);
  for (const cv::Point2d& ray : rays) middle += ray * (1.0 / static_cast<double>(rays.size()));
  const Eigen::Vector3d view(middle.x, middle.y, 1);
  // The part of the normal that is not along the ray to the board.
  const Eigen::Vector3d aside = normal - normal.dot(view) / view.squaredNorm() * view;
  if (std::asin(std::min(1.0, aside.norm())) < min_tilt) return Facing::kAny;
  if (std::abs(aside.x()) > std::abs(aside.y())) {
    return aside.x() < 0 ? Facing::kLeft : Facing::kRight;
  }
  return aside.y() < 0 ? Facing::kUp : Facing::kDown;
}

Guidance NextPose(const calibration::CalibrationInput& so_far, const GuideOptions& options) {
  const int cameras = static_cast<int>(so_far.cameras.size());
  Guidance guidance;
  double least = 1;
  for (int c = 0; c < cameras; ++c) {
    const Seen seen = WhatCameraSaw(so_far, c, options);
    const double share = Share(seen, cameras == 1, options);
    guidance.done += share / cameras;
    if (share < least - 1e-9) {  // the camera that lacks most comes first
      least = share;
      guidance.next = Want(seen, c, cameras == 1, options);
    }
  }
  return guidance;
}

}  // namespace softforce::pipeline
