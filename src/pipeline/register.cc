#include "softforce/pipeline/register.h"

#include <fmt/format.h>

#include "pipeline/frame_feed.h"
#include "pipeline/register_markers.h"
#include "pipeline/register_points.h"
#include "pipeline/registration.h"
#include "softforce/base/input_error.h"
#include "softforce/scene/place_rig.h"
#include "softforce/scene/point_pairs_file.h"
#include "softforce/scene/rig_file.h"

namespace softforce::pipeline {
namespace {

using base::InputError;
using PairStatus = calibration::PairRegistration::Status;

// `before`: where it stood by the file.
void Conclude(const scene::Scene& scene, const std::optional<Eigen::Isometry3d>& before,
              RegisterReport* report) {
  // To the last bit, for the file.
  geometry::Matrix6d& covariance = report->pose.covariance;
  covariance = (0.5 * (covariance + covariance.transpose())).eval();
  for (const scene::MarkerPoint& marker : scene.markers.points) {
    report->body_centre += marker.position / static_cast<double>(scene.markers.points.size());
  }
  const Eigen::Isometry3d& T = report->pose.T_rig_robot;
  report->body_covariance = PointCovariance(T, report->pose.covariance, report->body_centre);
  if (!before) return;
  report->moved = (T * report->body_centre - *before * report->body_centre).norm();
  report->turned = Eigen::AngleAxisd(T.linear().transpose() * before->linear()).angle();
}

RegisterReport OfCapture(const scene::Scene& scene, const RegisterOptions& options) {
  if (options.from == RegisterFrom::kFiducials || options.from == RegisterFrom::kPairs ||
      !options.sources.empty()) {
    throw InputError(!options.sources.empty()                   ? "--camera"
                     : options.from == RegisterFrom::kFiducials ? "--from fiducials"
                                                                : "--pairs",
                     "goes with cameras, but the scene has motion capture",
                     "Its frame is found from the labelled markers: --from markers, or nothing.");
  }
  RegisterReport report = RegisterByPoints(scene, options);
  std::optional<Eigen::Isometry3d> before = scene.measured->T_rig_robot;
  std::error_code ignored;
  if (std::filesystem::exists(scene.measured->rig, ignored)) {
    before = scene::LoadPlace(scene.measured->rig).T_rig_robot;
  }
  Conclude(scene, before, &report);
  return report;
}

class Job {
 public:
  Job(const std::filesystem::path& scene_file, const RegisterOptions& options)
      : options_(options),
        // Typed pairs need no recording.
        scene_(scene::LoadScene(scene_file, options.from == RegisterFrom::kPairs
                                                ? scene::SceneFiles::kNone
                                                : scene::SceneFiles::kAll)),
        rig_(scene::LoadRig(scene_.cameras.rig)) {
    report_.rig_file = scene_.cameras.rig;
  }

  RegisterReport Finish() {
    switch (From()) {
      case RegisterFrom::kPairs:
        ByPairs();
        break;
      case RegisterFrom::kFiducials:
        ByFiducials();
        break;
      default:
        ByMarkers();
    }
    Conclude(scene_, rig_.T_rig_robot, &report_);
    return report_;
  }

 private:
  RegisterFrom From() const {
    if (options_.from != RegisterFrom::kAnything) return options_.from;
    return scene_.cameras.fiducials.empty() ? RegisterFrom::kMarkers : RegisterFrom::kFiducials;
  }

  // The frames to look at, of a recording or of live cameras.
  std::vector<vision::FrameSet> Frames(int count) const {
    RunOptions run;
    run.out.clear();  // nothing is written
    run.sources = options_.sources;
    run.live = options_.live;
    run.time_offsets_s = options_.time_offsets_s;
    run.stop = options_.stop;
    run.first_frame = options_.frame;
    run.end_frame = options_.frame + count;
    FrameFeed feed(scene_, rig_, run);
    feed.Start([](const std::string&) {});
    std::vector<vision::FrameSet> frames;
    while (auto frame = feed.Next()) frames.push_back(std::move(*frame));
    feed.Finish();
    if (frames.empty()) {
      throw InputError(scene_.file.string() + ": cameras: sources", "no picture came from them");
    }
    return frames;
  }

  void ByFiducials() {
    if (scene_.cameras.fiducials.empty()) {
      throw InputError(scene_.file.string() + ": cameras", "has no fiducials",
                       "List the corners of tags on the robot's base under 'fiducials', or use "
                       "--from markers or --pairs.");
    }
    const Standing standing = FindRig(scene_, rig_, Detector(scene_, rig_), [&](const auto& look) {
      for (const vision::FrameSet& frame : Frames(options_.fiducial_frames)) look(frame);
    });
    report_.pose = *standing.from_fiducials;
    report_.how = fmt::format("by {} corners of fiducials", report_.pose.num_points);
  }

  void ByMarkers() {
    const MarkerPlacement placement =
        PlaceByMarkers(scene_, rig_, Frames(1).front(), options_.match);
    report_.pose = placement.pose;
    report_.how = placement.how;
    report_.warnings = placement.warnings;
  }

  void ByPairs() {
    const auto typed = scene::ReadPointPairs(options_.pairs, rig_);
    std::vector<vision::PointSighting> pairs;
    for (const scene::TypedPair& pair : typed) {
      pairs.push_back({pair.p_robot, pair.camera, pair.pixel, Eigen::Matrix2d::Identity()});
    }
    const auto found = calibration::RegisterByPairs(rig_, pairs, options_.typed);
    if (!found.ok()) Refuse(found.status, static_cast<int>(pairs.size()));
    for (size_t i = 0; i < typed.size(); ++i) {
      if (!found.wrong[i]) continue;
      const Eigen::Vector3d p = 1e3 * typed[i].p_robot;
      report_.warnings.push_back(fmt::format(
          "{}:{}: the pair of ({:g}, {:g}, {:g}) mm in camera \"{}\" is wrong and was left out: "
          "the others put it {:.1f} px from there",
          options_.pairs.string(), typed[i].line, p.x(), p.y(), p.z(),
          rig_.cameras[typed[i].camera].name, found.misfit_px[i]));
    }
    report_.pose = found.pose;
    report_.how = fmt::format("by {} of {} typed pairs", found.pose.num_points, pairs.size());
  }

  [[noreturn]] void Refuse(PairStatus status, int pairs) const {
    const std::string where = options_.pairs.string();
    switch (status) {
      case PairStatus::kTooFewPoints:
        throw InputError(where, "no camera has four different points, expected at least four",
                         "Add points, spread over the picture, not all on one line.");
      case PairStatus::kCollinear:
        throw InputError(where,
                         "the points lie on a line, which does not fix the rig's turn "
                         "about it",
                         "Add points to the side of the line.");
      case PairStatus::kCannotTell:
        throw InputError(where,
                         fmt::format("not all of the {} pairs fit together, and it cannot be told "
                                     "which one is wrong",
                                     pairs),
                         "Check them, or add one or two more.");
      default:
        throw InputError(where,
                         fmt::format("no more than half of the {} pairs fit together", pairs),
                         "Check units (mm, px), the robot's axes, the cameras' names, and that "
                         "the rig file belongs to these cameras.");
    }
  }

  const RegisterOptions& options_;
  const scene::Scene scene_;
  const camera::Rig rig_;
  RegisterReport report_;
};

}  // namespace

void RegisterOptions::Check() const {
  if (frame < 0) throw InputError("--frame", "must be 0 or more");
  if (fiducial_frames < 1) throw InputError("--registration-frames", "must be 1 or more");
  if ((from == RegisterFrom::kPairs) != !pairs.empty()) {
    throw InputError("--pairs", "goes with --from pairs, and only with that");
  }
  match.Check();
  typed.Check();
  live.Check();
}

RegisterReport Register(const std::filesystem::path& scene_file, const RegisterOptions& options) {
  options.Check();
  // Only the type of input is looked at: a file with the place may be still to be written.
  const scene::Scene scene = scene::LoadScene(scene_file, scene::SceneFiles::kNone);
  if (scene.measured) {
    return OfCapture(scene::LoadScene(scene_file, scene::SceneFiles::kToRegister), options);
  }
  return Job(scene_file, options).Finish();
}

std::string RegisterReport::Spread() const {
  const Eigen::VectorXd sd = 1e3 * pose.covariance.diagonal().cwiseSqrt();
  const Eigen::Vector3d body = 1e3 * body_covariance.diagonal().cwiseSqrt();
  return fmt::format(
      "standard deviations along the rig's axes: {:.3f} {:.3f} {:.3f} mm, {:.3f} {:.3f} {:.3f} "
      "mrad\n"
      "of the markers' centre: {:.3f} {:.3f} {:.3f} mm\n",
      sd(0), sd(1), sd(2), sd(3), sd(4), sd(5), body.x(), body.y(), body.z());
}

std::string RegisterReport::FullReport() const {
  std::string text =
      std::isfinite(rms)
          ? fmt::format(
                "The frame of motion capture is placed {}, which fit to {:.3f} "
                "mm.\n",
                how, 1e3 * rms)
          : fmt::format("The rig is placed {}, which fit to {:.3f} px.\n", how, pose.rms_px);
  for (const std::string& warning : warnings) text += "warning: " + warning + "\n";
  text += "\nT_rig_robot, metres:\n";
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector4d row = pose.T_rig_robot.matrix().row(i);
    text += fmt::format("  {:12.9f} {:12.9f} {:12.9f} {:12.9f}\n", row(0), row(1), row(2), row(3));
  }
  text += "\n" + Spread();
  if (std::isfinite(moved)) {
    text += fmt::format(
        "Against T_rig_robot in {}: the markers' centre is {:.3f} mm from there, turned by {:.3f} "
        "mrad.\n",
        rig_file.empty() ? "the scene" : rig_file.filename().string(), 1e3 * moved, 1e3 * turned);
  }
  return text;
}

}  // namespace softforce::pipeline
