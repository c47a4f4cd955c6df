#include <algorithm>
#include <limits>
#include <map>

#include "calibration/start.h"

namespace softforce::calibration {
namespace {

using PicturesOfCameras = std::vector<std::vector<std::vector<const Sighting*>>>;

// T_b_a from the views that two cameras share.
std::optional<Eigen::Isometry3d> RelativePose(
    const BoardShape& board, const CameraStart& a, const CameraStart& b,
    const std::vector<std::vector<const Sighting*>>& in_b) {
  std::vector<int> shared;
  for (int v = 0; v < static_cast<int>(in_b.size()); ++v) {
    if (a.T_camera_board[v] && b.T_camera_board[v]) shared.push_back(v);
  }
  std::optional<Eigen::Isometry3d> best;
  double least = std::numeric_limits<double>::infinity();
  for (int candidate : shared) {
    const Eigen::Isometry3d T_b_a =
        *b.T_camera_board[candidate] * a.T_camera_board[candidate]->inverse();
    std::vector<double> errors;
    for (int v : shared) {
      errors.push_back(MedianError(b.lens, board, T_b_a * *a.T_camera_board[v], in_b[v]));
    }
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    if (!best || *middle < least) {
      least = *middle;
      best = T_b_a;
    }
  }
  return best;
}

struct Link {
  int from = -1, to = -1;
};

// The links of a spanning tree from camera 0 with the most shared views (Prim).
std::vector<Link> SpanningTree(const std::vector<std::vector<int>>& shared_views) {
  const int n = static_cast<int>(shared_views.size());
  std::vector<char> reached(n, 0);
  reached[0] = 1;
  std::vector<Link> links;
  for (int round = 1; round < n; ++round) {
    Link best;
    int most = 0;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) {
        if (!reached[a] || reached[b] || shared_views[a][b] <= most) continue;
        most = shared_views[a][b];
        best = {a, b};
      }
    }
    if (best.to < 0) break;
    reached[best.to] = 1;
    links.push_back(best);
  }
  return links;
}

PicturesOfCameras Sort(const std::vector<Sighting>& sightings, size_t cameras, size_t views) {
  PicturesOfCameras pictures(cameras, std::vector<std::vector<const Sighting*>>(views));
  for (const Sighting& sighting : sightings) {
    if (sighting.used) pictures[sighting.camera][sighting.view].push_back(&sighting);
  }
  return pictures;
}

// Of what the cameras that saw the board make of its place, the one that suits all of them best.
void PlaceBoard(const BoardShape& board, const PicturesOfCameras& pictures,
                const std::vector<CameraStart>& starts, int view, Estimate* estimate) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t c = 0; c < starts.size(); ++c) {
    if (!starts[c].T_camera_board[view]) continue;
    const Eigen::Isometry3d T_rig_board =
        estimate->T_camera_rig[c].inverse() * *starts[c].T_camera_board[view];
    double worst = 0;
    for (size_t other = 0; other < starts.size(); ++other) {
      if (pictures[other][view].empty()) continue;
      worst = std::max(
          worst, MedianError(estimate->lenses[other], board,
                             estimate->T_camera_rig[other] * T_rig_board, pictures[other][view]));
    }
    if (worst < least) {
      least = worst;
      estimate->T_rig_board[view] = T_rig_board;
    }
  }
}

}  // namespace

std::vector<std::vector<int>> SharedViews(const std::vector<Sighting>& sightings, int num_cameras,
                                          int num_views) {
  std::vector<std::vector<char>> saw(num_cameras, std::vector<char>(num_views, 0));
  for (const Sighting& sighting : sightings) {
    if (sighting.used) saw[sighting.camera][sighting.view] = 1;
  }
  std::vector<std::vector<int>> shared(num_cameras, std::vector<int>(num_cameras, 0));
  for (int a = 0; a < num_cameras; ++a) {
    for (int b = 0; b < num_cameras; ++b) {
      for (int v = 0; v < num_views; ++v) shared[a][b] += saw[a][v] && saw[b][v] ? 1 : 0;
    }
  }
  return shared;
}

std::vector<std::vector<int>> ConnectedCameras(const std::vector<std::vector<int>>& shared_views) {
  const int n = static_cast<int>(shared_views.size());
  std::vector<int> group(n);
  for (int c = 0; c < n; ++c) group[c] = c;
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      if (shared_views[a][b] == 0 || group[a] == group[b]) continue;
      const int from = group[b];
      std::replace(group.begin(), group.end(), from, group[a]);
    }
  }
  std::map<int, std::vector<int>> members;
  for (int c = 0; c < n; ++c) members[group[c]].push_back(c);
  std::vector<std::vector<int>> groups;
  for (const auto& [first, cameras] : members) groups.push_back(cameras);
  return groups;
}

void PlaceCameras(const BoardShape& board, const std::vector<Sighting>& sightings,
                  const std::vector<CameraStart>& starts,
                  const std::vector<std::vector<int>>& shared_views, Estimate* estimate) {
  const PicturesOfCameras pictures = Sort(sightings, starts.size(), estimate->T_rig_board.size());
  for (size_t c = 0; c < starts.size(); ++c) estimate->lenses[c] = starts[c].lens;
  for (const Link& link : SpanningTree(shared_views)) {
    const auto T_to_from =
        RelativePose(board, starts[link.from], starts[link.to], pictures[link.to]);
    if (T_to_from) estimate->T_camera_rig[link.to] = *T_to_from * estimate->T_camera_rig[link.from];
  }
  for (int v = 0; v < static_cast<int>(estimate->T_rig_board.size()); ++v) {
    PlaceBoard(board, pictures, starts, v, estimate);
  }
}

}  // namespace softforce::calibration
