#include "softforce/calibration/point_pairs.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "softforce/base/input_error.h"

namespace softforce::calibration {
namespace {

using Status = PairRegistration::Status;
using Pairs = std::vector<vision::PointSighting>;

constexpr double kMinWidth = 0.02;   // of a set of places, across its longest axis, as a share
constexpr double kSamePlace = 1e-6;  // m
constexpr double kClearlyWorse = 2;  // as often the misfit of another set

// Places that differ.
std::vector<Eigen::Vector3d> PlacesOf(const Pairs& pairs) {
  std::vector<Eigen::Vector3d> places;
  for (const vision::PointSighting& pair : pairs) {
    const bool known = std::any_of(places.begin(), places.end(), [&](const Eigen::Vector3d& p) {
      return (p - pair.p_robot).norm() < kSamePlace;
    });
    if (!known) places.push_back(pair.p_robot);
  }
  return places;
}

bool OnALine(const Pairs& pairs) {
  const std::vector<Eigen::Vector3d> places = PlacesOf(pairs);
  Eigen::Matrix3Xd cloud(3, places.size());
  for (size_t i = 0; i < places.size(); ++i) cloud.col(static_cast<Eigen::Index>(i)) = places[i];
  cloud.colwise() -= cloud.rowwise().mean().eval();
  const Eigen::VectorXd spread = Eigen::JacobiSVD<Eigen::Matrix3Xd>(cloud).singularValues();
  return !(spread(1) > kMinWidth * spread(0));
}

// A set of pairs that agree on a pose.
struct Consensus {
  vision::RigPose pose;
  std::vector<char> agrees;
  int count = 0;
};

class Search {
 public:
  Search(const camera::Rig& rig, Pairs pairs, const PairOptions& options)
      : rig_(rig), pairs_(std::move(pairs)), reach_px_(options.max_misfit * options.pixel_sd) {}

  double Misfit(const vision::PointSighting& pair, const Eigen::Isometry3d& T_rig_robot) const {
    const camera::Camera& camera = rig_.cameras[pair.camera];
    const camera::Projection at =
        camera::Project(camera.lens, camera.T_camera_rig * (T_rig_robot * pair.p_robot));
    return at.visible ? (at.pixel - pair.pixel).norm() : INFINITY;
  }

  // The pairs that agree with a pose, and the pose that these give, until they stay the same.
  Consensus Agree(const vision::RigPose& start) const {
    Consensus consensus;
    consensus.pose = start;
    for (int round = 0; round < 10 && consensus.pose.ok(); ++round) {
      std::vector<char> agrees(pairs_.size());
      Pairs kept;
      for (size_t i = 0; i < pairs_.size(); ++i) {
        agrees[i] = Misfit(pairs_[i], consensus.pose.T_rig_robot) < reach_px_;
        if (agrees[i]) kept.push_back(pairs_[i]);
      }
      if (agrees == consensus.agrees) return consensus;
      consensus.agrees = std::move(agrees);
      consensus.count = static_cast<int>(kept.size());
      if (kept.size() < 4) break;
      consensus.pose = vision::RefineRigPose(rig_, kept, consensus.pose.T_rig_robot);
    }
    consensus.count = 0;  // it never settled
    return consensus;
  }

  std::vector<Consensus> All(const std::vector<std::array<size_t, 4>>& starts) const {
    std::vector<Consensus> found;
    const auto add = [&](const Pairs& start) {
      const vision::RigPose pose = vision::EstimateRigPose(rig_, start);
      if (!pose.ok()) return;
      const Consensus consensus = Agree(pose);
      const bool known = std::any_of(found.begin(), found.end(), [&](const Consensus& other) {
        return other.agrees == consensus.agrees;
      });
      if (consensus.count >= 4 && !known) found.push_back(consensus);
    };
    add(pairs_);
    if (!found.empty() && found[0].count == static_cast<int>(pairs_.size())) return found;
    for (const auto& start : starts) {
      add({pairs_[start[0]], pairs_[start[1]], pairs_[start[2]], pairs_[start[3]]});
    }
    std::stable_sort(found.begin(), found.end(), [](const Consensus& a, const Consensus& b) {
      return a.count != b.count ? a.count > b.count : a.pose.rms_px < b.pose.rms_px;
    });
    return found;
  }

 private:
  const camera::Rig& rig_;
  const Pairs pairs_;
  const double reach_px_;
};

// Sets of four pairs of one camera that are not on a line.
std::vector<std::array<size_t, 4>> Starts(const Pairs& pairs, int most) {
  std::vector<std::array<size_t, 4>> starts;
  const size_t n = pairs.size();
  const auto add = [&](size_t a, size_t b, size_t c, size_t d) {
    const Pairs set{pairs[a], pairs[b], pairs[c], pairs[d]};
    for (const vision::PointSighting& pair : set) {
      if (pair.camera != set[0].camera) return;
    }
    if (PlacesOf(set).size() == 4 && !OnALine(set)) starts.push_back({a, b, c, d});
  };
  if (n <= 12) {
    for (size_t a = 0; a < n; ++a) {
      for (size_t b = a + 1; b < n; ++b) {
        for (size_t c = b + 1; c < n; ++c) {
          for (size_t d = c + 1; d < n; ++d) add(a, b, c, d);
        }
      }
    }
    return starts;
  }
  std::mt19937 random(1);
  for (int trial = 0; trial < 100 * most && static_cast<int>(starts.size()) < most; ++trial) {
    std::array<size_t, 4> at{random() % n, random() % n, random() % n, random() % n};
    std::sort(at.begin(), at.end());
    if (std::adjacent_find(at.begin(), at.end()) == at.end()) add(at[0], at[1], at[2], at[3]);
  }
  return starts;
}

bool EnoughPlaces(const camera::Rig& rig, const Pairs& pairs) {
  for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
    Pairs of_camera;
    for (const vision::PointSighting& pair : pairs) {
      if (pair.camera == c) of_camera.push_back(pair);
    }
    if (PlacesOf(of_camera).size() >= 4) return true;
  }
  return false;
}

}  // namespace

void PairOptions::Check() const {
  if (!(pixel_sd > 0)) throw base::InputError("pair option pixel_sd", "must be greater than 0 px");
  if (!(max_misfit > 1)) throw base::InputError("pair option max_misfit", "must be greater than 1");
  if (max_trials < 1) throw base::InputError("pair option max_trials", "must be 1 or more");
}

int PairRegistration::num_wrong() const {
  return static_cast<int>(std::count(wrong.begin(), wrong.end(), 1));
}

PairRegistration RegisterByPairs(const camera::Rig& rig, const Pairs& given,
                                 const PairOptions& options) {
  options.Check();
  PairRegistration result;
  result.wrong.assign(given.size(), 0);
  result.misfit_px.assign(given.size(), NAN);
  Pairs pairs = given;
  for (vision::PointSighting& pair : pairs) {
    pair.covariance = options.pixel_sd * options.pixel_sd * Eigen::Matrix2d::Identity();
  }
  result.status = Status::kTooFewPoints;
  if (!EnoughPlaces(rig, pairs)) return result;
  result.status = Status::kCollinear;
  if (OnALine(pairs)) return result;

  const Search search(rig, pairs, options);
  const std::vector<Consensus> found = search.All(Starts(pairs, options.max_trials));
  result.status = Status::kInconsistent;
  if (found.empty()) return result;
  const Consensus& best = found.front();
  const int wrong = static_cast<int>(pairs.size()) - best.count;
  if (2 * best.count <= static_cast<int>(pairs.size())) return result;
  Pairs kept;
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (best.agrees[i]) kept.push_back(pairs[i]);
  }
  if (OnALine(kept)) {
    result.status = Status::kCollinear;
    return result;
  }
  // Where leaving out another pair does as well, none can be blamed.
  result.status = Status::kCannotTell;
  for (size_t f = 1; f < found.size() && wrong > 0; ++f) {
    if (found[f].count < best.count) break;
    if (found[f].pose.rms_px < kClearlyWorse * best.pose.rms_px) return result;
  }
  result.status = Status::kOk;
  result.pose = best.pose;
  for (size_t i = 0; i < pairs.size(); ++i) {
    result.misfit_px[i] = search.Misfit(pairs[i], best.pose.T_rig_robot);
    result.wrong[i] = best.agrees[i] ? 0 : 1;
  }
  return result;
}

}  // namespace softforce::calibration
