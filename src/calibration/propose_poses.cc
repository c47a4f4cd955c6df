#include "calibration/propose_poses.h"

#include <algorithm>
#include <array>
#include <map>
#include <random>

namespace softforce::calibration {
namespace {

using Triple = std::array<int, 3>;

constexpr double kMinSide = 5;   // shortest height of a triple, in max_misplacement
constexpr size_t kMaxKept = 40;  // proposals
constexpr int kMinCount = 4;     // three always fit
constexpr double kFacing = 0.6;  // share of a proposal's dots that must face a camera

// The height of a triangle over its longest side: how well it fixes a pose.
double Height(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return longest > 0 ? (b - a).cross(c - a).norm() / longest : 0;
}

std::vector<Triple> TriplesOf(const std::vector<KnownDot>& dots, const MatchOptions& options) {
  std::vector<Triple> triples;
  const int n = static_cast<int>(dots.size());
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      for (int c = b + 1; c < n; ++c) {
        if (Height(dots[a].p_robot, dots[b].p_robot, dots[c].p_robot) >
            kMinSide * options.max_misplacement) {
          triples.push_back({a, b, c});
        }
      }
    }
  }
  const auto wanted = static_cast<size_t>(options.max_triples);
  if (triples.size() > wanted) {
    std::mt19937 random(1);
    for (size_t i = 0; i < wanted; ++i) {
      std::swap(triples[i], triples[i + random() % (triples.size() - i)]);
    }
    triples.resize(wanted);
  }
  return triples;
}

// The dots that land on a point each, nearest first come.
Proposal Lay(const std::vector<KnownDot>& dots, const std::vector<Eigen::Vector3d>& points,
             const Eigen::Isometry3d& T_rig_robot, double reach) {
  Proposal laid;
  laid.T_rig_robot = T_rig_robot;
  laid.point_of.assign(dots.size(), -1);
  std::vector<char> taken(points.size(), 0);
  double square = 0;
  for (size_t d = 0; d < dots.size(); ++d) {
    const Eigen::Vector3d at = T_rig_robot * dots[d].p_robot;
    double nearest = reach * reach;
    for (size_t p = 0; p < points.size(); ++p) {
      const double distance = (points[p] - at).squaredNorm();
      if (taken[p] || distance >= nearest) continue;
      nearest = distance;
      laid.point_of[d] = static_cast<int>(p);
    }
    if (laid.point_of[d] < 0) continue;
    taken[laid.point_of[d]] = 1;
    square += nearest;
    ++laid.count;
  }
  laid.rms = laid.count > 0 ? std::sqrt(square / laid.count) : 0;
  return laid;
}

// Dots on the far side of the body are not seen.
bool FacesCameras(const camera::Rig& rig, const std::vector<KnownDot>& dots,
                  const Proposal& proposal) {
  int facing = 0;
  for (size_t d = 0; d < dots.size(); ++d) {
    if (proposal.point_of[d] < 0) continue;
    const Eigen::Vector3d p = proposal.T_rig_robot * dots[d].p_robot;
    const Eigen::Vector3d normal = proposal.T_rig_robot.linear() * dots[d].normal;
    for (const camera::Camera& camera : rig.cameras) {
      const Eigen::Vector3d eye = camera.T_camera_rig.inverse().translation();
      if (normal.dot(eye - p) <= 0) continue;
      ++facing;
      break;
    }
  }
  return facing >= kFacing * proposal.count;
}

class Search {
 public:
  Search(const camera::Rig& rig, const std::vector<KnownDot>& dots,
         const std::vector<Eigen::Vector3d>& points, const MatchOptions& options)
      : rig_(rig), dots_(dots), points_(points), options_(options) {
    const auto n = static_cast<Eigen::Index>(points.size());
    distance_.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) distance_(i, j) = (points[i] - points[j]).norm();
    }
  }

  void LookFor(const Triple& triple) {
    const auto side = [&](int i, int j) {
      return (dots_[triple[i]].p_robot - dots_[triple[j]].p_robot).norm();
    };
    const double ab = side(0, 1), bc = side(1, 2), ca = side(2, 0);
    const double reach = options_.max_misplacement;
    const Eigen::Index n = distance_.rows();
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = 0; b < n; ++b) {
        if (std::abs(distance_(a, b) - ab) > reach) continue;
        for (Eigen::Index c = 0; c < n; ++c) {
          if (std::abs(distance_(b, c) - bc) > reach || std::abs(distance_(c, a) - ca) > reach) {
            continue;
          }
          Propose(triple, {static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)});
        }
      }
    }
  }

  std::vector<Proposal> Best() const {
    std::vector<Proposal> best;
    for (const auto& [labels, proposal] : found_) best.push_back(proposal);
    std::stable_sort(best.begin(), best.end(), [](const Proposal& a, const Proposal& b) {
      return a.count != b.count ? a.count > b.count : a.rms < b.rms;
    });
    if (best.size() > kMaxKept) best.resize(kMaxKept);
    return best;
  }

 private:
  void Propose(const Triple& triple, const Triple& points) {
    std::vector<int> point_of(dots_.size(), -1);
    for (int i = 0; i < 3; ++i) point_of[triple[i]] = points[i];
    // A small triple turns far dots by more than its own misfit: a second look, aligned by all.
    const double reach = options_.max_misplacement;
    Proposal laid = Lay(dots_, points_, Align(dots_, points_, point_of), 2 * reach);
    if (laid.count < kMinCount) return;
    laid = Lay(dots_, points_, Align(dots_, points_, laid.point_of), reach);
    if (laid.count < kMinCount || found_.count(laid.point_of) > 0) return;
    laid.T_rig_robot = Align(dots_, points_, laid.point_of);
    if (FacesCameras(rig_, dots_, laid)) found_.emplace(laid.point_of, laid);
  }

  const camera::Rig& rig_;
  const std::vector<KnownDot>& dots_;
  const std::vector<Eigen::Vector3d>& points_;
  const MatchOptions& options_;
  Eigen::MatrixXd distance_;  // m, between points
  std::map<std::vector<int>, Proposal> found_;
};

}  // namespace

Eigen::Isometry3d Align(const std::vector<KnownDot>& dots,
                        const std::vector<Eigen::Vector3d>& points,
                        const std::vector<int>& point_of) {
  const auto count = static_cast<Eigen::Index>(
      std::count_if(point_of.begin(), point_of.end(), [](int p) { return p >= 0; }));
  Eigen::Matrix3Xd from(3, count), to(3, count);
  Eigen::Index column = 0;
  for (size_t d = 0; d < dots.size(); ++d) {
    if (point_of[d] < 0) continue;
    from.col(column) = dots[d].p_robot;
    to.col(column++) = points[point_of[d]];
  }
  return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
}

std::vector<Proposal> ProposePoses(const camera::Rig& rig, const std::vector<KnownDot>& dots,
                                   const std::vector<Eigen::Vector3d>& points,
                                   const MatchOptions& options) {
  Search search(rig, dots, points, options);
  for (const Triple& triple : TriplesOf(dots, options)) search.LookFor(triple);
  return search.Best();
}

}  // namespace softforce::calibration
