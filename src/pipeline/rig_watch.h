#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/blind_watch.h"
#include "pipeline/registration.h"
#include "softforce/pipeline/tracker.h"

namespace softforce::pipeline {

// What the watch noticed.
struct RigEvent {
  enum class Kind {
    kBumped,         // the rig stands elsewhere; it was placed anew
    kCamerasMoved,   // against each other: no place of the rig explains what they see
    kFiducialMoved,  // by itself; it is not used any more
    kPerhapsBumped,  // all markers are off alike, and there are no fiducials to tell by
    kBack            // after that no forces explained the frames; now they do again
  };

  Kind kind = Kind::kBumped;
  int frame = -1;                       // the first that shows it
  int told = -1;                        // in which it was sure
  std::string text;                     // for a person
  std::optional<vision::RigPose> pose;  // of kBumped
};

const char* Name(RigEvent::Kind kind);

// Watches over where the rig stands while a run goes on. For one thread, frames in order.
//
// Fiducials are compared with where the same camera saw them when the rig was placed, so that what
// is always off (lens, print) does not count. A fiducial is off if all its corners together are
// further from there than noise explains, and by more than a floor; a camera, if most of its
// fiducials are. Frames in which a camera is off are not trusted. If it stays so, and the fiducials
// stand still, over some frames, then the rig was bumped: it is placed anew by those frames. If
// that does not explain them, the cameras moved against each other.
class RigWatch {
 public:
  struct Verdict {
    bool trusted = true;
    std::string reason;        // why not
    bool placed_anew = false;  // read standing()
  };
  using Tell = std::function<void(const std::string& message)>;

  // Scene and rig must outlive it. `frames`: that the rig is placed by at the most after a bump.
  RigWatch(const scene::Scene& scene, const camera::Rig& rig, const Standing& standing, int frames,
           Tell tell);

  // Where to look for fiducials; always the same.
  const std::vector<std::vector<Detector::FiducialPlace>>& places() const { return places_; }

  // Per camera what it sees; empty if nobody looked.
  Verdict Look(int frame, const std::vector<std::vector<vision::Tag>>& fiducials);

  // After the estimate of a frame in which no fiducials are seen; see BlindWatch.
  void LookAtMarkers(const BlindWatch::Estimated& estimated);

  // Whether forces should be looked for in a frame that is trusted.
  bool WorthATry(const std::vector<CameraDetections>& detections) {
    return saw_fiducials_ || blind_.WorthATry(detections);
  }

  const Standing& standing() const { return standing_; }
  const std::vector<RigEvent>& events() const { return events_; }

 private:
  struct Sighting {
    const calibration::MeanTag* reference = nullptr;
    const vision::Tag* tag = nullptr;
    double shift_px = 0;  // root mean square over the corners
    bool off = false;
  };
  using Tags = std::vector<std::vector<vision::Tag>>;

  void SetPlaces();
  std::vector<Sighting> Compare(const Tags& fiducials) const;
  bool IsOff(const std::vector<Sighting>& seen) const;
  void WatchSingleFiducials(int frame, const std::vector<Sighting>& seen);
  Verdict Suspect(int frame, const Tags& fiducials, double shift_px);
  Verdict PlaceAnew(int frame, double shift_px);
  bool StandsStill(const Tags& fiducials) const;
  void Improve(const Tags& fiducials);
  void Report(RigEvent event);

  const scene::Scene& scene_;
  const camera::Rig& rig_;
  Standing standing_;
  const int frames_;
  const Tell tell_;
  std::vector<std::vector<Detector::FiducialPlace>> places_;
  std::vector<RigEvent> events_;

  int suspected_since_ = -1;      // frame; −1: not suspected
  std::vector<Tags> suspicious_;  // frames, in which the fiducials stand still
  bool given_up_ = false;         // the cameras moved against each other
  std::optional<calibration::FiducialRegistration> improving_;  // after a bump
  int improved_by_ = 0;                                         // frames
  std::vector<int> off_alone_;                                  // per fiducial, frames in a row
  bool saw_fiducials_ = false;  // in the frame that Look() was last called for
  BlindWatch blind_;
};

}  // namespace softforce::pipeline
