#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "calibration/start.h"
#include "softforce/calibration/hold_out.h"
#include "softforce/camera/triangulate.h"

namespace softforce::calibration {
namespace {

struct Placed {
  int id = -1;
  Eigen::Vector3d p_rig;  // m, triangulated
};

std::vector<Sighting> SightingsOf(const std::vector<vision::BoardView>& seen) {
  std::vector<Sighting> sightings;
  for (int c = 0; c < static_cast<int>(seen.size()); ++c) {
    for (int i = 0; i < seen[c].size(); ++i) {
      sightings.push_back({0, c, seen[c].ids[i], seen[c].pixels[i], seen[c].covariances[i], {}});
    }
  }
  SetFloor(0, &sightings);
  return sightings;
}

std::vector<Placed> Triangulated(const camera::Rig& rig,
                                 const std::vector<vision::BoardView>& seen) {
  std::map<int, std::vector<camera::PixelObservation>> pixels_of;
  for (int c = 0; c < static_cast<int>(seen.size()); ++c) {
    for (int i = 0; i < seen[c].size(); ++i) {
      pixels_of[seen[c].ids[i]].push_back({c, seen[c].pixels[i], seen[c].covariances[i]});
    }
  }
  std::vector<Placed> placed;
  for (const auto& [id, pixels] : pixels_of) {
    const camera::Triangulation found = camera::Triangulate(rig, pixels);
    // An inconsistent point is a measured one too: how far it is off is what is asked.
    if (found.ok() || found.status == camera::Triangulation::Status::kInconsistent) {
      placed.push_back({id, found.p_rig});
    }
  }
  return placed;
}

// Pairs of points that are as close as a point of the board ever is to its nearest.
void MeasureSquares(const std::vector<Eigen::Vector3d>& board, const std::vector<Placed>& placed,
                    HoldOutView* view) {
  double spacing = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < board.size(); ++i) {
    for (size_t j = i + 1; j < board.size(); ++j) {
      spacing = std::min(spacing, (board[i] - board[j]).norm());
    }
  }
  double sum = 0;
  for (size_t i = 0; i < placed.size(); ++i) {
    for (size_t j = i + 1; j < placed.size(); ++j) {
      const double length = (board[placed[i].id] - board[placed[j].id]).norm();
      if (length > 1.001 * spacing) continue;  // the bend makes lengths differ by less
      sum += std::pow((placed[i].p_rig - placed[j].p_rig).norm() - length, 2);
      ++view->neighbours;
    }
  }
  if (view->neighbours > 0) view->squared_square = sum / view->neighbours;
}

void MeasureShape(const std::vector<Eigen::Vector3d>& board, const std::vector<Placed>& placed,
                  HoldOutView* view) {
  const auto n = static_cast<Eigen::Index>(placed.size());
  if (n < 4) return;
  Eigen::Matrix3Xd from(3, n), to(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    from.col(i) = board[placed[i].id];
    to.col(i) = placed[i].p_rig;
  }
  const Eigen::Matrix4d T = Eigen::umeyama(from, to, false);
  const Eigen::Matrix3Xd left =
      to - ((T.topLeftCorner<3, 3>() * from).colwise() + T.topRightCorner<3, 1>());
  view->squared_board = left.squaredNorm() / static_cast<double>(n);
}

// Where the camera that sees most of the board has it.
std::optional<Eigen::Isometry3d> StartBoard(const BoardShape& shape, const camera::Rig& rig,
                                            const std::vector<Sighting>& sightings) {
  std::vector<std::vector<const Sighting*>> pictures(rig.cameras.size());
  for (const Sighting& sighting : sightings) pictures[sighting.camera].push_back(&sighting);
  const auto most =
      std::max_element(pictures.begin(), pictures.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  const camera::Camera& first = rig.cameras[most - pictures.begin()];
  const auto T_camera_board = PoseOfBoard(first.lens, shape, *most);
  if (!T_camera_board) return std::nullopt;
  return first.T_camera_rig.inverse() * *T_camera_board;
}

// The pose of the board in the rig's frame by least squares over all cameras.
std::optional<Eigen::Isometry3d> FitBoard(const BoardShape& shape, const camera::Rig& rig,
                                          const std::vector<Sighting>& sightings,
                                          Eigen::Isometry3d T) {
  for (int iteration = 0; iteration < 50; ++iteration) {
    geometry::Matrix6d A = geometry::Matrix6d::Zero();
    geometry::Vector6d b = geometry::Vector6d::Zero();
    for (const Sighting& sighting : sightings) {
      const camera::Camera& camera = rig.cameras[sighting.camera];
      const Linearised at = Linearise(camera.lens, camera.T_camera_rig, T,
                                      shape.points[sighting.id], Eigen::Vector2d::Zero());
      if (!at.visible) return std::nullopt;
      const Eigen::Matrix<double, 2, 6> J = sighting.whitening * at.by_board;
      A += J.transpose() * J;
      b += J.transpose() * (sighting.whitening * (sighting.pixel - at.pixel));
    }
    const geometry::Vector6d step = A.ldlt().solve(b);
    if (!step.allFinite()) return std::nullopt;
    T = Moved(T, step);
    if (step.norm() < 1e-10) break;
  }
  return T;
}

}  // namespace

HoldOutView MeasureBoard(const camera::Rig& rig, const std::vector<Eigen::Vector3d>& board,
                         const std::vector<vision::BoardView>& seen,
                         const std::optional<Eigen::Isometry3d>& start) {
  HoldOutView view;
  const std::vector<Sighting> sightings = SightingsOf(seen);
  view.points = static_cast<int>(sightings.size());
  BoardShape shape;
  shape.points = board;
  view.squared_px = std::numeric_limits<double>::infinity();
  auto T_rig_board = start ? start : StartBoard(shape, rig, sightings);
  if (T_rig_board) T_rig_board = FitBoard(shape, rig, sightings, *T_rig_board);
  if (T_rig_board) {
    view.squared_px = 0;
    for (const Sighting& sighting : sightings) {
      const camera::Camera& camera = rig.cameras[sighting.camera];
      const auto at =
          camera::Project(camera.lens, camera.T_camera_rig * (*T_rig_board * board[sighting.id]));
      view.squared_px += (sighting.pixel - at.pixel).squaredNorm() / view.points;
    }
  }
  const std::vector<Placed> placed = Triangulated(rig, seen);
  view.triangulated = static_cast<int>(placed.size());
  MeasureSquares(board, placed, &view);
  MeasureShape(board, placed, &view);
  return view;
}

}  // namespace softforce::calibration
