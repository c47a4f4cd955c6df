#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "calibration/adjust.h"
#include "calibration/start.h"

namespace softforce::calibration {
namespace {

constexpr int kViewsToTry = 8;  // enough to tell a focal length

using Pictures = std::vector<std::vector<const Sighting*>>;  // by view

Pictures PicturesOf(const std::vector<Sighting>& sightings, int camera, int num_views) {
  Pictures pictures(num_views);
  for (const Sighting& sighting : sightings) {
    if (sighting.used && sighting.camera == camera) pictures[sighting.view].push_back(&sighting);
  }
  return pictures;
}

// The pose behind a homography from the board's plane to the plane z = 1.
std::optional<Eigen::Isometry3d> FromHomography(Eigen::Matrix3d H, const Eigen::Vector3d& middle) {
  if (!H.allFinite()) return std::nullopt;
  H /= std::sqrt(H.col(0).norm() * H.col(1).norm());
  if ((H * Eigen::Vector3d(middle.x(), middle.y(), 1)).z() < 0) H = -H;
  Eigen::Matrix3d R;
  R << H.col(0), H.col(1), H.col(0).cross(H.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  R = svd.matrixU() * svd.matrixV().transpose();
  if (!R.allFinite() || R.determinant() < 0) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R;
  T.translation() = H.col(2);
  return T;
}

// Gauss–Newton on the reprojection error with a loss that bounds each point's say.
Eigen::Isometry3d Refine(const camera::Lens& lens, const BoardShape& board,
                         const std::vector<const Sighting*>& picture, Eigen::Isometry3d T) {
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  for (int iteration = 0; iteration < 10; ++iteration) {
    const double scale = 2 * MedianError(lens, board, T, picture) + 1e-9;  // px
    geometry::Matrix6d A = geometry::Matrix6d::Zero();
    geometry::Vector6d b = geometry::Vector6d::Zero();
    for (const Sighting* sighting : picture) {
      const Linearised at =
          Linearise(lens, identity, T, board.points[sighting->id], Eigen::Vector2d::Zero());
      if (!at.visible) continue;
      const Eigen::Vector2d error = sighting->pixel - at.pixel;
      const double weight = 1 / (1 + error.squaredNorm() / (scale * scale));  // Cauchy's
      A += weight * at.by_board.transpose() * at.by_board;
      b += weight * at.by_board.transpose() * error;
    }
    const geometry::Vector6d step = A.ldlt().solve(b);
    if (!step.allFinite() || step.head<3>().norm() > 1) break;
    const Eigen::Isometry3d moved = Moved(T, step);
    if (!(MedianError(lens, board, moved, picture) < std::numeric_limits<double>::infinity())) {
      break;
    }
    T = moved;
    if (step.norm() < 1e-9) break;
  }
  return T;
}

camera::Lens PlainLens(const CameraToCalibrate& camera, LensFit fit, double focal) {
  camera::Lens lens;
  lens.fx = lens.fy = focal;
  lens.cx = 0.5 * (camera.width - 1);
  lens.cy = 0.5 * (camera.height - 1);
  lens.model = ModelOf(fit);
  return lens;
}

// How badly a focal length explains the pictures: the sum of their median errors, each bounded, so
// that a wrong picture has no say.
double Misfit(const camera::Lens& lens, const BoardShape& board, const Pictures& pictures) {
  const double worst = 0.1 * lens.cx;  // px
  double sum = 0;
  for (const auto& picture : pictures) {
    const auto T = PoseOfBoard(lens, board, picture);
    sum += T ? std::min(worst, MedianError(lens, board, *T, picture)) : worst;
  }
  return sum;
}

// Every few of the views, if there are many.
Pictures Some(const Pictures& pictures) {
  Pictures filled;
  for (const auto& picture : pictures) {
    if (!picture.empty()) filled.push_back(picture);
  }
  Pictures some;
  const size_t count = std::min<size_t>(filled.size(), kViewsToTry);
  for (size_t i = 0; i < count; ++i) some.push_back(filled[i * filled.size() / count]);
  return some;
}

camera::Lens BestPlainLens(const CameraToCalibrate& camera, LensFit fit, const BoardShape& board,
                           const Pictures& pictures) {
  const Pictures some = Some(pictures);
  camera::Lens best;
  double least = std::numeric_limits<double>::infinity();
  for (double focal = 0.15 * camera.width; focal < 12 * camera.width; focal *= 1.4) {
    const camera::Lens lens = PlainLens(camera, fit, focal);
    const double misfit = Misfit(lens, board, some);
    if (misfit < least) {
      least = misfit;
      best = lens;
    }
  }
  return best;
}

}  // namespace

double MedianError(const camera::Lens& lens, const BoardShape& board,
                   const Eigen::Isometry3d& T_camera_board,
                   const std::vector<const Sighting*>& picture) {
  std::vector<double> errors;
  for (const Sighting* sighting : picture) {
    const auto at = camera::Project(lens, T_camera_board * board.points[sighting->id]);
    errors.push_back(at.visible ? (at.pixel - sighting->pixel).norm()
                                : std::numeric_limits<double>::infinity());
  }
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

std::optional<Eigen::Isometry3d> PoseOfBoard(const camera::Lens& lens, const BoardShape& board,
                                             const std::vector<const Sighting*>& picture) {
  std::vector<cv::Point2d> on_board, on_plane;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Sighting* sighting : picture) {
    const auto n = camera::Unproject(lens, sighting->pixel);
    if (!n || n->norm() > 5) continue;  // nearly sideways: nothing that a plane can tell
    const Eigen::Vector3d& p = board.points[sighting->id];
    middle += p;
    on_board.emplace_back(p.x(), p.y());
    on_plane.emplace_back(n->x(), n->y());
  }
  if (on_board.size() < 4) return std::nullopt;
  middle /= static_cast<double>(on_board.size());
  const cv::Mat found = cv::findHomography(on_board, on_plane, cv::LMEDS);
  if (found.empty()) return std::nullopt;
  Eigen::Matrix3d H;
  for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = found.at<double>(i / 3, i % 3);
  const auto T = FromHomography(H, middle);
  if (!T) return std::nullopt;
  return Refine(lens, board, picture, *T);
}

CameraStart StartCamera(const BoardShape& board, const std::vector<Sighting>& sightings,
                        const CameraToCalibrate& camera, LensFit fit, int camera_index,
                        int num_views) {
  const Pictures pictures = PicturesOf(sightings, camera_index, num_views);
  CameraStart start;
  start.T_camera_board.resize(num_views);
  start.lens = BestPlainLens(camera, fit, board, pictures);
  if (!std::isfinite(start.lens.fx)) return start;

  Estimate estimate;
  estimate.fits = {fit};
  estimate.lenses = {start.lens};
  estimate.T_camera_rig = {Eigen::Isometry3d::Identity()};
  estimate.T_rig_board.assign(num_views, Eigen::Isometry3d::Identity());
  std::vector<Sighting> own;
  for (int v = 0; v < num_views; ++v) {
    if (!pictures[v].empty()) {
      start.T_camera_board[v] = PoseOfBoard(start.lens, board, pictures[v]);
    }
    if (!start.T_camera_board[v]) continue;
    estimate.T_rig_board[v] = *start.T_camera_board[v];
    for (const Sighting* sighting : pictures[v]) {
      own.push_back(*sighting);
      own.back().camera = 0;
    }
  }
  if (own.empty()) return start;
  // The weakest parameters last: the start of the lens is far off, and they would make up for it.
  AdjustOptions options;
  options.free_warp = false;
  options.free_centre = false;
  options.free_distortion = 2;
  options.max_iterations = 50;
  start.ok = AdjustRobustly(board, own, options, &estimate).usable;
  options.free_centre = true;
  start.ok = start.ok && AdjustRobustly(board, own, options, &estimate).usable;
  start.lens = estimate.lenses[0];
  for (int v = 0; v < num_views; ++v) {
    if (start.T_camera_board[v]) start.T_camera_board[v] = estimate.T_rig_board[v];
  }
  return start;
}

}  // namespace softforce::calibration
