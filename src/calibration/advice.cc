#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/stages.h"
#include "calibration/start.h"

namespace softforce::calibration {
namespace {

// Below these a calibration is usually worse than it could easily be.
constexpr int kGoodViews = 8;
constexpr int kGoodSharedViews = 3;
constexpr double kGoodTilt = 20 * M_PI / 180;  // rad, the widest tilt of a camera's pictures
constexpr double kGoodDistances = 1.2;         // farthest over nearest
constexpr double kUncoveredEdge = 0.1;         // of the picture's side
constexpr double kGoodRelativeSd = 0.005;      // of focal length and principal point
constexpr double kManyOutliers = 0.02;         // of all points
constexpr double kLargeNoise = 0.5;            // px per axis
constexpr double kLargeWarp = 0.003;           // of the board's diagonal
constexpr double kMuchWorse = 1.5;             // held-out over fitted error

class Adviser {
 public:
  Adviser(const CalibrationInput& input, Calibration* calibration)
      : input_(input), calibration_(*calibration) {}

  void AdviseOnCamera(int c) {
    AdviseOnViews(c);
    AdviseOnEdges(c);
    AdviseOnCertainty(c);
  }

  void AdviseOnPairs() {
    std::vector<Sighting> sightings;
    for (const PointResidual& residual : calibration_.residuals) {
      if (residual.outlier) continue;
      sightings.push_back({residual.view, residual.camera, residual.id, residual.pixel, {}, {}});
    }
    const int n = static_cast<int>(input_.cameras.size());
    auto shared = SharedViews(sightings, n, static_cast<int>(input_.views.size()));
    for (auto& row : shared) {
      for (int& views : row) views = views < kGoodSharedViews ? 0 : views;
    }
    const auto groups = ConnectedCameras(shared);
    for (size_t g = 1; g < groups.size(); ++g) {
      Say(Advice::Kind::kFewSharedViews, groups[g][0],
          fmt::format("{} sees the board together with the other cameras in fewer than {} views",
                      input_.cameras[groups[g][0]].name, kGoodSharedViews),
          "Hold the board where the cameras see it at the same time.");
    }
  }

  void AdviseOnPoints() {
    const double share =
        static_cast<double>(calibration_.outliers) / (calibration_.points + calibration_.outliers);
    if (share > kManyOutliers) {
      Say(Advice::Kind::kManyOutliers, -1,
          fmt::format("{:.1f} % of the points do not fit and were left out", 100 * share),
          "Look at the pictures with most outliers: blur, glare, or a board that moved between the "
          "cameras' moments.");
    }
    for (const ViewFit& view : calibration_.views) {
      for (const PictureFit& picture : view.pictures) {
        if (!picture.left_out) continue;
        Say(Advice::Kind::kPictureLeftOut, picture.camera,
            fmt::format("{}: the picture of {} does not fit the others and was left out", view.name,
                        input_.cameras[picture.camera].name),
            "Look at it: blur, too few points, another board, or not of this moment.");
      }
    }
    if (calibration_.noise_px > kLargeNoise) {
      Say(Advice::Kind::kLargeError, -1,
          fmt::format("the points miss the board by {:.2f} px per axis", calibration_.noise_px),
          "Check the board's counts and proportions, that it is stiff and flat, and try a lens "
          "model with more parameters.");
    }
  }

  void AdviseOnWarp() {
    Eigen::Vector3d low = input_.board[0], high = input_.board[0];
    for (const Eigen::Vector3d& p : input_.board) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const double bend = calibration_.warp.cwiseAbs().maxCoeff();
    if (bend > kLargeWarp * (high - low).norm()) {
      Say(Advice::Kind::kLargeWarp, -1,
          fmt::format("the board bends by {:.2f} mm over {:.0f} mm", 1e3 * bend,
                      1e3 * (high - low).norm()),
          "The bend is fitted, but only to its simplest form: glue the print to something stiff "
          "and "
          "flat, such as glass or aluminium.");
    }
  }

  void AdviseOnHoldOut() {
    if (calibration_.hold_out.rms_px > kMuchWorse * calibration_.rms_px) {
      Say(Advice::Kind::kHoldOut, -1,
          fmt::format("views that were held out miss by {:.2f} px, those used by {:.2f} px",
                      calibration_.hold_out.rms_px, calibration_.rms_px),
          "Take more views, or a lens model with fewer parameters.");
    }
  }

 private:
  void Say(Advice::Kind kind, int camera, const std::string& finding, const std::string& to_do) {
    calibration_.advice.push_back({kind, camera, finding, to_do});
  }

  const std::string& NameOf(int c) const { return input_.cameras[c].name; }

  void AdviseOnViews(int c) {
    double tilt = 0, nearest = std::numeric_limits<double>::infinity(), farthest = 0;
    for (const ViewFit& view : calibration_.views) {
      for (const PictureFit& picture : view.pictures) {
        if (picture.camera != c || picture.left_out) continue;
        tilt = std::max(tilt, picture.tilt);
        nearest = std::min(nearest, picture.distance);
        farthest = std::max(farthest, picture.distance);
      }
    }
    if (calibration_.cameras[c].pictures < kGoodViews) {
      Say(Advice::Kind::kFewViews, c,
          fmt::format("{}: {} pictures of the board", NameOf(c), calibration_.cameras[c].pictures),
          "Take 15 to 30.");
    }
    if (tilt < kGoodTilt) {
      Say(Advice::Kind::kLittleTilt, c,
          fmt::format("{}: the board was never tilted by more than {:.0f} degrees", NameOf(c),
                      tilt * 180 / M_PI),
          "Tilt it by 30 to 45 degrees, to all sides: only tilted views tell the focal length.");
    }
    if (farthest < kGoodDistances * nearest) {
      Say(Advice::Kind::kOneDistance, c,
          fmt::format("{}: the board was always {:.2f} to {:.2f} m away", NameOf(c), nearest,
                      farthest),
          "Hold it nearer and farther too, over the distances at which you will measure.");
    }
  }

  void AdviseOnEdges(int c) {
    const CameraToCalibrate& camera = input_.cameras[c];
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector2d high = -low;
    for (const PointResidual& residual : calibration_.residuals) {
      if (residual.camera != c || residual.outlier) continue;
      low = low.cwiseMin(residual.pixel);
      high = high.cwiseMax(residual.pixel);
    }
    const auto look = [&](const char* edge, double gap, int side) {
      if (gap < kUncoveredEdge * side) return;
      Say(Advice::Kind::kEdgeNotCovered, c,
          fmt::format("{}: no board near the {} edge, none within {:.0f} px of it", NameOf(c), edge,
                      gap),
          "Hold the board there: the lens is only known where it was seen.");
    };
    look("left", low.x(), camera.width);
    look("right", camera.width - 1 - high.x(), camera.width);
    look("top", low.y(), camera.height);
    look("bottom", camera.height - 1 - high.y(), camera.height);
  }

  void AdviseOnCertainty(int c) {
    const double focal = calibration_.rig.cameras[c].lens.fx;
    for (const CalibratedValue& value : calibration_.values) {
      if (value.camera != c || value.kind != CalibratedValue::Kind::kIntrinsics) continue;
      if (value.sd <= kGoodRelativeSd * focal) continue;
      Say(Advice::Kind::kUncertainFocal, c,
          fmt::format("{}: {} is uncertain, {:.1f} px with a standard deviation of {:.1f} px",
                      NameOf(c), value.name, value.value, value.sd),
          "Take views with the board tilted by 30 to 45 degrees, to all sides.");
    }
  }

  const CalibrationInput& input_;
  Calibration& calibration_;
};

}  // namespace

void Advise(const CalibrationInput& input, Calibration* calibration) {
  Adviser adviser(input, calibration);
  for (int c = 0; c < static_cast<int>(input.cameras.size()); ++c) adviser.AdviseOnCamera(c);
  adviser.AdviseOnPairs();
  adviser.AdviseOnPoints();
  adviser.AdviseOnWarp();
  adviser.AdviseOnHoldOut();
}

}  // namespace softforce::calibration
