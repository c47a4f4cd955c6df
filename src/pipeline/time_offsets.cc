#include "softforce/pipeline/time_offsets.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "pipeline/frame_feed.h"
#include "pipeline/registration.h"
#include "softforce/base/input_error.h"
#include "softforce/base/progress.h"
#include "softforce/scene/rig_file.h"
#include "softforce/scene/scene.h"
#include "softforce/vision/marker_tracks.h"

namespace softforce::pipeline {
namespace {

using Link = TimeOffsetsReport::Link;

// Where the diagonals cross: a place on the tag, from wherever it is seen.
Eigen::Vector2d CentreOf(const vision::Tag& tag) {
  const Eigen::Vector2d& start = tag.corners[0];
  Eigen::Matrix2d along;
  along << tag.corners[2] - start, tag.corners[1] - tag.corners[3];
  const Eigen::Vector2d share = along.inverse() * (tag.corners[1] - start);
  return start + share(0) * (tag.corners[2] - start);
}

// What each camera followed: dots without names, or tags by their ids.
class CameraTracks {
 public:
  explicit CameraTracks(double longest_gap_s) : spots_(longest_gap_s) {}

  void Add(double time_s, const CameraDetections& seen) {
    std::vector<Eigen::Vector2d> centres;
    for (const vision::Dot& dot : seen.dots) centres.push_back(dot.centroid);
    spots_.Add(time_s, centres);
    for (const vision::Tag& tag : seen.tags) {
      tags_[tag.id].push_back(vision::TimedPixel{time_s, CentreOf(tag)});
    }
  }

  static std::vector<vision::TrackPair> Pairs(const camera::Rig& rig, int first, int second,
                                              const std::vector<CameraTracks>& cameras,
                                              const vision::TimeOffsetOptions& options) {
    const CameraTracks& a = cameras[static_cast<size_t>(first)];
    const CameraTracks& b = cameras[static_cast<size_t>(second)];
    std::vector<vision::TrackPair> pairs =
        vision::PairTracks(rig, first, second, a.spots_.Tracks(), b.spots_.Tracks(), options);
    for (const auto& [id, track] : a.tags_) {
      const auto other = b.tags_.find(id);
      if (other != b.tags_.end()) pairs.push_back({track, other->second});
    }
    return pairs;
  }

 private:
  vision::SpotFollower spots_;
  std::map<int, vision::Track> tags_;
};

scene::Scene WithCameras(scene::Scene scene) {
  if (!scene.measured) return scene;
  throw base::InputError("--clocks", "goes with cameras, but the scene has motion capture",
                         "A file of points has one clock.");
}

class Job {
 public:
  Job(const std::filesystem::path& scene_file, const TimeOffsetsOptions& options)
      : options_(options),
        scene_(WithCameras(scene::LoadScene(scene_file))),
        rig_(scene::LoadRig(scene_.cameras.rig)),
        cameras_(rig_.cameras.size(), CameraTracks(options.search.longest_gap_s)) {
    if (rig_.cameras.size() < 2) {
      throw base::InputError(scene_.cameras.rig.string(),
                             "has one camera, expected two or more whose clocks can differ");
    }
  }

  TimeOffsetsReport Finish() {
    Watch();
    for (size_t c = 0; c < corrected_s_.size(); ++c) {
      rig_.cameras[c].time_offset_s = corrected_s_[c];
    }
    rig_.cameras.front().time_offset_sd_s = 0;
    Reach();
    report_.rig_file = scene_.cameras.rig;
    report_.rig = rig_;
    return report_;
  }

 private:
  void Watch() {
    RunOptions run;
    run.out.clear();  // nothing is written
    run.sources = options_.sources;
    run.live = options_.live;
    run.time_offsets_s = options_.time_offsets_s;
    run.duration_s = options_.duration_s;
    run.stop = options_.stop;
    FrameFeed feed(scene_, rig_, run);
    feed.Start(base::TellBesideProgress);
    corrected_s_ = feed.TimeOffsets();
    const Detector detector(scene_, rig_);
    base::Progress progress("frames", feed.expected_frames());
    while (const auto set = feed.Next()) {
      const std::vector<CameraDetections> seen = detector.Markers(*set);
      for (size_t c = 0; c < seen.size(); ++c) cameras_[c].Add(set->camera_time_s[c], seen[c]);
      report_.seconds = set->time_s;
      progress.Update(++report_.frames, "");
    }
    progress.Finish();
    feed.Finish();
  }

  Link Try(int first, int second) const {
    Link link{first, second, 0, {}};
    const auto pairs = CameraTracks::Pairs(rig_, first, second, cameras_, options_.search);
    link.markers = static_cast<int>(pairs.size());
    link.found = vision::EstimateTimeOffset(rig_, first, second, pairs, options_.search);
    return link;
  }

  // From the first camera on, each time the camera that is surest against one that is known.
  void Reach() {
    const int count = static_cast<int>(rig_.cameras.size());
    std::vector<bool> known(rig_.cameras.size(), false);
    known[0] = true;
    std::vector<Link> tried;
    for (int a = 0; a < count; ++a) {
      for (int b = a + 1; b < count; ++b) tried.push_back(Try(a, b));
    }
    while (true) {
      const Link* best = nullptr;
      for (const Link& link : tried) {
        const bool reaches = known[link.first] != known[link.second];
        if (!reaches || !link.found.ok()) continue;
        if (best == nullptr || link.found.sd_s < best->found.sd_s) best = &link;
      }
      if (best == nullptr) break;
      Take(*best, known[best->first]);
      known[best->first] = known[best->second] = true;
    }
    for (const Link& link : tried) {
      if (!known[link.first] || !known[link.second]) report_.links.push_back(link);
    }
    for (size_t c = 0; c < known.size(); ++c) {
      if (!known[c]) report_.unknown.push_back(rig_.cameras[c].name);
    }
  }

  // What was found is beyond what the frames' times were corrected by already.
  void Take(const Link& link, bool forwards) {
    const int from = forwards ? link.first : link.second, to = forwards ? link.second : link.first;
    const camera::Camera& known = rig_.cameras[from];
    camera::Camera& other = rig_.cameras[to];
    const double beyond_s = known.time_offset_s - corrected_s_[static_cast<size_t>(from)];
    other.time_offset_s += beyond_s + (forwards ? 1 : -1) * link.found.offset_s;
    other.time_offset_sd_s = std::hypot(known.time_offset_sd_s, link.found.sd_s);
    report_.links.push_back(link);
  }

  const TimeOffsetsOptions& options_;
  const scene::Scene scene_;
  camera::Rig rig_;
  std::vector<CameraTracks> cameras_;
  std::vector<double> corrected_s_;  // what the frames' times are corrected by, of each camera
  TimeOffsetsReport report_;
};

}  // namespace

void TimeOffsetsOptions::Check() const {
  if (!(duration_s > 0)) throw base::InputError("--duration", "must be more than 0 s");
  live.Check();
  search.Check();
}

TimeOffsetsReport FindTimeOffsets(const std::filesystem::path& scene_file,
                                  const TimeOffsetsOptions& options) {
  options.Check();
  return Job(scene_file, options).Finish();
}

std::string TimeOffsetsReport::FullReport() const {
  std::string text = fmt::format("{} frames, {:.1f} s.\n", frames, seconds);
  for (const Link& link : links) {
    text += fmt::format("{} against {}, {} markers: {}\n", rig.cameras[link.second].name,
                        rig.cameras[link.first].name, link.markers, link.found.BriefReport());
  }
  if (usable()) {
    text += "\nBy which time stamps are late, against those of the first camera:\n";
    for (const camera::Camera& camera : rig.cameras) {
      text += fmt::format("  {:12} {:9.3f} ms, standard deviation {:.3f} ms\n", camera.name,
                          1e3 * camera.time_offset_s, 1e3 * camera.time_offset_sd_s);
    }
    return text;
  }
  text += "\nNot found of:";
  for (const std::string& name : unknown) text += " " + name;
  return text +
         "\nAll cameras must see the markers, or the whole rig, move for some seconds, to and fro "
         "and "
         "across the line between\nthe cameras: up and down for cameras side by side. An offset "
         "beyond what was searched can be\ngiven roughly: --time-offset NAME=TIME.\n";
}

}  // namespace softforce::pipeline
