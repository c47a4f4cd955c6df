#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "softforce/geometry/chi_square.h"
#include "softforce/pipeline/tracker.h"
#include "support/allocation_tally.h"
#include "support/dotted_sheet.h"

namespace softforce::testing {

// The dotted sheet, moved about by up to 1.5 spacings between two frames. Two cameras see it from
// 0.45 m, 150 mm apart. No pictures are made: the tracker is given the dots' projections with
// noise. It works on 300 ten-node cells; the truth is made on 546 of other proportions. The same
// seed makes the same motion, whatever is hidden.
class AllocationExperiment {
 public:
  static constexpr double kFastest = 1.5;  // spacings a frame

  AllocationExperiment(const Disturbance& disturbance, unsigned seed,
                       const pipeline::TrackerOptions& options = {})
      : disturbance_(disturbance),
        random_(seed),
        motion_(seed + 1),
        sizes_(seed + 2),
        scene_(DottedSheetScene()),
        world_(pipeline::BuildWorld(scene_, MakeDottedSheet({10, 5, 1}))),
        truth_(pipeline::BuildWorld(scene_, MakeDottedSheet({13, 7, 1}))),
        rig_(DottedSheetRig()),
        T_rig_robot_(geometry::ExpSe3(RegistrationSd().cwiseProduct(DrawMany(6)))),
        tracker_(scene_, world_, rig_, Eigen::Isometry3d::Identity(),
                 RegistrationSd().cwiseAbs2().asDiagonal(), options),
        exact_(truth_.solver.get(), truth_.sites, ExactModel()),
        state_(truth_.solver->AtRest()),
        hidden_(NumMarkers(), 0),
        was_hidden_(NumMarkers(), 0),
        awaited_(NumMarkers(), 0) {
    for (int i = 0; i < 6; ++i) phase_(i) = 0;
    positions_ = Positions();
  }

  // The next frame.
  void Step() {
    Move();
    Hide();
    std::vector<std::vector<int>> sources;
    const std::vector<pipeline::CameraDetections> detections = Detect(&sources);
    const auto start = std::chrono::steady_clock::now();
    const pipeline::FrameResult result = tracker_.Process(frame_, frame_ / 30.0, detections);
    tally_.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    Count(result, sources);
    ++frame_;
  }

  const AllocationTally& tally() const { return tally_; }

 private:
  static int NumMarkers() { return kDotColumns * kDotRows; }
  static geometry::Vector6d RegistrationSd() {
    return (geometry::Vector6d() << 1e-4, 1e-4, 1e-4, 2e-4, 2e-4, 2e-4).finished();
  }

  static constexpr double kNoise = 0.05;  // px

  static estimation::EstimatorOptions ExactModel() {
    estimation::EstimatorOptions exact;
    exact.common_model_error = exact.local_model_error = 0;
    return exact;
  }

  double Draw() { return normal_(random_); }
  double Uniform(double low = 0, double high = 1) { return low + (high - low) * uniform_(random_); }
  Eigen::VectorXd DrawMany(int n) {
    return Eigen::VectorXd::NullaryExpr(n, [&] { return Draw(); });
  }

  Eigen::Matrix3Xd Positions() const {
    const Eigen::Matrix3Xd x = truth_.mesh().nodes + state_.u;
    Eigen::Matrix3Xd positions(3, NumMarkers());
    for (int m = 0; m < NumMarkers(); ++m) {
      positions.col(m) = truth_.markers[m].weights.Apply(x) + truth_.markers[m].offset;
    }
    return positions;
  }

  // N, at a point of the path that both forces follow together.
  static Eigen::VectorXd ForcesAt(const geometry::Vector6d& phase) {
    const geometry::Vector6d amplitude =
        (geometry::Vector6d() << 0.04, 0.06, 0.1, 0, 0, 0.2).finished();
    return amplitude.array() * phase.array().sin();
  }

  double InMotion(double low, double high) { return low + (high - low) * uniform_(motion_); }

  // Moves the sheet by a speed that is kept for 15 to 40 frames, and ranges from rest to the
  // fastest.
  void Move() {
    if (frames_at_speed_-- == 0) {
      frames_at_speed_ = static_cast<int>(InMotion(15, 40));
      speed_ = InMotion(0, 1) < 0.1 ? 0.02 : InMotion(0.05, kFastest);
    }
    const geometry::Vector6d rates =
        (geometry::Vector6d() << 0.61, 1.37, 1.0, 0.83, 0.47, 1.21).finished();
    const Eigen::Matrix3Xd before = positions_;
    const geometry::Vector6d phase_before = phase_;
    // What makes the markers go that far is found by trial.
    for (int trial = 0; trial < 12; ++trial) {
      phase_ = phase_before + step_ * rates;
      force_ = ForcesAt(phase_);
      fem::LoadCase load = fem::OwnWeight(truth_.solver->body());
      for (int s = 0; s < 2; ++s) {
        const mesh::NodalWeights& at = truth_.sites[s].at;
        for (size_t i = 0; i < at.nodes.size(); ++i) {
          load.forces.col(at.nodes[i]) += at.weights[i] * force_.segment<3>(3 * s);
        }
      }
      truth_.solver->Solve(load, &state_);
      positions_ = Positions();
      const double moved = (positions_ - before).colwise().norm().maxCoeff() / kDotSpacing;
      const double factor = std::clamp(speed_ / std::max(moved, 1e-3), 0.3, 2.0);
      const bool good = moved <= kFastest && std::abs(moved - speed_) <= 0.2 * speed_;
      if (good || (trial > 3 && moved <= kFastest)) {
        tally_.motion += moved * kDotSpacing;
        tally_.fastest = std::max(tally_.fastest, moved * kDotSpacing);
        break;
      }
      step_ = std::clamp(step_ * factor, 1e-3, 1.0);
    }
  }

  void Hide() {
    was_hidden_ = hidden_;
    if (disturbance_.hiding == Hiding::kEachFrame) {
      for (char& hidden : hidden_) hidden = Uniform() < disturbance_.hidden;
    } else if (frames_of_burst_-- == 0) {
      frames_of_burst_ = static_cast<int>(Uniform(10, 20));
      // A cover comes from some side, or hides them here and there.
      const bool side = disturbance_.hiding == Hiding::kSide;
      const double angle = Uniform(0, 2 * M_PI);
      std::vector<std::pair<double, int>> order;
      for (int m = 0; m < NumMarkers(); ++m) {
        const Eigen::Vector3d& at = scene_.markers.points[m].position;
        const double along = std::cos(angle) * at.x() + std::sin(angle) * at.y();
        order.emplace_back((side ? along : 0) + 0.005 * Draw(), m);
      }
      std::sort(order.begin(), order.end());
      std::fill(hidden_.begin(), hidden_.end(), 0);
      for (int i = 0; i < std::lround(disturbance_.hidden * NumMarkers()); ++i) {
        hidden_[order[i].second] = 1;
      }
    }
    const int every = disturbance_.blackout_every;
    black_before_ = black_;
    black_ = every > 0 && frame_ % every >= every - disturbance_.blackout_length;
  }

  std::optional<vision::Dot> See(const camera::Camera& camera, const Eigen::Vector3d& p_robot,
                                 const Eigen::Vector3d& normal) {
    const Eigen::Isometry3d T_camera_robot = camera.T_camera_rig * T_rig_robot_;
    const Eigen::Vector3d p = T_camera_robot * p_robot;
    const Eigen::Vector3d n = T_camera_robot.linear() * normal;
    const double facing = -n.dot(p.normalized());
    if (facing < 0.2) return {};
    const auto centroid = camera::ProjectDiscCentroid(camera.lens, p, n, kDotDiameter);
    if (!centroid) return {};
    vision::Dot dot;
    dot.centroid = *centroid + kNoise * Eigen::Vector2d(Draw(), Draw());
    // The picture tells of a part of the noise; the rest is what the tracker adds (pixel_floor).
    const double floor = pipeline::ObserveOptions().pixel_floor;
    dot.covariance = (kNoise * kNoise - floor * floor) * Eigen::Matrix2d::Identity();
    dot.long_axis = kDotDiameter * camera.lens.fx / p.z();
    dot.short_axis = facing * dot.long_axis;
    dot.contrast = 80;
    return dot;
  }

  // `sources`: per camera and dot the marker that it is, or −1.
  std::vector<pipeline::CameraDetections> Detect(std::vector<std::vector<int>>* sources) {
    const Eigen::Matrix3Xd x = truth_.mesh().nodes + state_.u;
    std::vector<pipeline::CameraDetections> cameras(rig_.cameras.size());
    sources->assign(rig_.cameras.size(), {});
    shown_.assign(NumMarkers(), 0);
    pixels_.assign(rig_.cameras.size(), Eigen::Matrix2Xd::Constant(2, NumMarkers(), NAN));
    for (size_t c = 0; c < cameras.size(); ++c) {
      std::vector<std::pair<vision::Dot, int>> dots;
      for (int m = 0; m < NumMarkers(); ++m) {
        const auto dot = See(rig_.cameras[c], positions_.col(m),
                             mesh::Normal(truth_.surface, x, truth_.markers[m].at));
        if (!dot) continue;
        pixels_[c].col(m) = dot->centroid;
        if (hidden_[m] || black_) continue;
        dots.emplace_back(*dot, m);
        shown_[m] = 1;
      }
      if (!black_) AddClutter(c, &dots);
      std::shuffle(dots.begin(), dots.end(), random_);
      for (const auto& [dot, marker] : dots) {
        cameras[c].dots.push_back(dot);
        (*sources)[c].push_back(marker);
      }
    }
    return cameras;
  }

  // A third anywhere in the picture, a third near markers in this picture alone, and a third are
  // decoys: things beside the body that both cameras see for some frames.
  void AddClutter(size_t c, std::vector<std::pair<vision::Dot, int>>* dots) {
    const camera::Camera& camera = rig_.cameras[c];
    const int clutter =
        static_cast<int>(std::lround(disturbance_.clutter * static_cast<double>(dots->size())));
    if (c == 0) {
      for (Decoy& decoy : decoys_) --decoy.frames_left;
      decoys_.erase(std::remove_if(decoys_.begin(), decoys_.end(),
                                   [](const Decoy& decoy) { return decoy.frames_left <= 0; }),
                    decoys_.end());
      while (static_cast<int>(decoys_.size()) < clutter / 3) {
        const int near = static_cast<int>(Uniform(0, NumMarkers()));
        decoys_.push_back({positions_.col(near) + kDotSpacing * DrawMany(3),
                           static_cast<int>(Uniform(3, 15)), DrawSize()});
      }
    }
    const auto add = [&](const vision::Dot& dot) {
      // What touches a dot is not a dot of its own.
      for (const auto& other : *dots) {
        if ((other.first.centroid - dot.centroid).norm() < 0.9 * dot.long_axis) return;
      }
      dots->emplace_back(dot, -1);
    };
    for (const Decoy& decoy : decoys_) {
      if (const auto dot = See(camera, decoy.position, Eigen::Vector3d::UnitZ())) {
        add(Scaled(*dot, decoy.size));
      }
    }
    for (int i = static_cast<int>(decoys_.size()); i < clutter; ++i) {
      const int near = static_cast<int>(Uniform(0, NumMarkers()));
      auto dot = See(camera, positions_.col(near), Eigen::Vector3d::UnitZ());
      if (!dot) continue;
      if (i % 2 == 0) {
        dot->centroid = {Uniform(0, camera.width), Uniform(0, camera.height)};
      } else {
        dot->centroid += 20 * Eigen::Vector2d(Draw(), Draw());  // px
      }
      add(Scaled(*dot, DrawSize()));
    }
  }

  // Drawn apart, so that all else is the same whatever the clutter's sizes.
  double DrawSize() {
    const double most = std::log(disturbance_.clutter_sizes);
    return std::exp(most * (2 * uniform_(sizes_) - 1));
  }

  static vision::Dot Scaled(vision::Dot dot, double factor) {
    dot.long_axis *= factor;
    dot.short_axis *= factor;
    return dot;
  }

  void Count(const pipeline::FrameResult& result, const std::vector<std::vector<int>>& sources) {
    using Status = pipeline::MarkerStatus;
    if (black_) return;
    const bool usable = result.status == estimation::ForceEstimate::Status::kOk;
    ++tally_.frames;
    if (!usable) ++tally_.lost_frames;
    if (black_before_) {
      ++tally_.after_blackout;
      if (usable) ++tally_.recovered;
    }
    for (int m = 0; m < NumMarkers(); ++m) {
      const pipeline::MarkerResult& marker = result.markers[m];
      const bool used =
          usable && (marker.status == Status::kSeen || marker.status == Status::kOneCamera);
      bool swapped = false, clutter = false;
      const auto& sightings = tracker_.sightings();
      for (size_t i = 0; i < sightings.pixels[m].size(); ++i) {
        const camera::PixelObservation& pixel = sightings.pixels[m][i];
        const int source = sources[pixel.camera][sightings.dots[m][i]];
        swapped = swapped || (source >= 0 && source != m);
        clutter = clutter || source < 0;
        if (source < 0 && used) {
          tally_.clutter_distance2 += (pixel.pixel - pixels_[pixel.camera].col(m)).squaredNorm();
        }
      }
      const bool right = used && !swapped && !clutter;
      if (used && swapped) ++tally_.swapped;
      if (used && !swapped && clutter) ++tally_.clutter_taken;
      if (usable && !used && (swapped || clutter)) ++tally_.flagged_wrong;
      if (shown_[m]) {
        ++tally_.shown;
        if (right) ++tally_.right;
        if (!used) ++tally_.left_out;
      } else {
        ++tally_.hidden;
        if (!used) ++tally_.hidden_right;
        if (usable && marker.expected_covariance.allFinite()) {
          // As the cameras see it: measured and expected places are such as the rig's place is held
          // to be.
          const Eigen::Vector3d error = T_rig_robot_ * positions_.col(m) - marker.expected;
          ++tally_.regions;
          if (error.dot(marker.expected_covariance.ldlt().solve(error)) <=
              geometry::ChiSquareQuantile(0.95, 3)) {
            ++tally_.covered;
          }
          tally_.region_error2 += error.squaredNorm() / 3;
          tally_.region_sd += std::sqrt(marker.expected_covariance.trace() / 3);
        }
      }
      CountReturn(m, right);
    }
    if (usable) {
      Eigen::VectorXd intensity(4);
      intensity << force_.head<3>(), force_(5);
      exact_.StartFrom(intensity, {});
      tally_.least_variance_all += ForceVariance(false) / 2;
      tally_.least_variance += ForceVariance(true) / 2;
      for (int s = 0; s < 2; ++s) {
        tally_.reported_variance += result.forces[s].covariance.trace() / 2;
        tally_.force_error2 +=
            (result.forces[s].force - force_.segment<3>(3 * s)).squaredNorm() / 2;
      }
    }
  }

  // N², the sum over both forces' variances that noise and the rig's place leave, whoever estimates
  // them by an exact model: from all that can be seen, or from what is not hidden alone.
  double ForceVariance(bool hide) const {
    const int n = exact_.num_components();
    const Eigen::Matrix3Xd x = truth_.mesh().nodes + state_.u;
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n + 6, n + 6);
    information.bottomRightCorner<6, 6>() =
        RegistrationSd().cwiseAbs2().cwiseInverse().asDiagonal();
    for (int m = 0; m < NumMarkers(); ++m) {
      if (hide && hidden_[m]) continue;
      Eigen::MatrixXd moved(3, n + 6);
      moved << exact_.Compliance(truth_.markers[m].weights), Eigen::Matrix3d::Identity(),
          -geometry::Skew(positions_.col(m));
      for (size_t c = 0; c < rig_.cameras.size(); ++c) {
        if (!pixels_[c].col(m).allFinite()) continue;
        const camera::Camera& camera = rig_.cameras[c];
        const Eigen::Isometry3d T_camera_robot = camera.T_camera_rig * T_rig_robot_;
        const Eigen::Vector3d p = T_camera_robot * positions_.col(m);
        Eigen::Matrix<double, 2, 3> pixel;  // px/m
        pixel << camera.lens.fx, 0, -camera.lens.fx * p.x() / p.z(), 0, camera.lens.fy,
            -camera.lens.fy * p.y() / p.z();
        const Eigen::MatrixXd J = pixel / p.z() * T_camera_robot.linear() * moved / kNoise;
        information += J.transpose() * J;
      }
    }
    return information.inverse().topLeftCorner(n, n).trace();
  }

  void CountReturn(int m, bool right) {
    const bool returns = was_hidden_[m] && shown_[m];
    if (returns) {
      ++tally_.returns;
      if (right) ++tally_.returned_at_once;
    } else if (awaited_[m] && shown_[m] && right) {
      ++tally_.returned_next;
    }
    awaited_[m] = returns && !right;
  }

  struct Decoy {
    Eigen::Vector3d position;  // m
    int frames_left;
    double size;  // of a marker's
  };

  Disturbance disturbance_;
  std::mt19937 random_, motion_, sizes_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
  scene::Scene scene_;
  pipeline::World world_, truth_;
  camera::Rig rig_;
  Eigen::Isometry3d T_rig_robot_;  // really; the tracker believes the identity
  pipeline::Tracker tracker_;
  estimation::ForceEstimator exact_;  // the truth's model
  fem::Equilibrium state_;
  Eigen::Matrix3Xd positions_;  // m, of the markers, really
  geometry::Vector6d phase_;
  Eigen::VectorXd force_;  // N
  double step_ = 0.05, speed_ = 0;
  int frames_at_speed_ = 0, frames_of_burst_ = 0, frame_ = 0;
  std::vector<char> hidden_, was_hidden_, awaited_, shown_;
  bool black_ = false, black_before_ = false;
  std::vector<Decoy> decoys_;
  std::vector<Eigen::Matrix2Xd> pixels_;  // px, per camera, of the markers
  AllocationTally tally_;
};

}  // namespace softforce::testing
