#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "softforce/estimation/location_estimator.h"
#include "softforce/pipeline/features.h"
#include "softforce/pipeline/frame_result.h"
#include "softforce/pipeline/world.h"

namespace softforce::pipeline {

struct TrackerOptions {
  estimation::EstimatorOptions estimator;
  // For scenes whose places of forces are not known; its estimator and patch play no part.
  estimation::LocationOptions location;
  ObserveOptions observe;
  // How far the marker that moves most may go between two frames by a change of one force (standard
  // deviation), as a share of the smallest marker spacing: sets the forces' random walk, and
  // through the compliance the gates, which are long where the body is soft. Two of them are the
  // 1.5 spacings that a marker may go between two frames.
  double motion_share = 0.75;
  int max_markers = 0;  // that forces are estimated from, the most informative ones; 0: all
  // How far off the body's linear answer is over such a motion, as a share of it.
  double nonlinearity = 0.1;
  double prediction_floor = 0.3e-3;  // m, standard deviation of a prediction at the least
  // m, the same for the region of a hidden marker once the frame's forces are known; it is larger
  // by as much as these forces leave of what was seen unexplained, over some frames.
  double region_floor = 0.002e-3;
  // The paper's threshold, as a share of the smallest marker spacing; more than a marker may go.
  double threshold_displacement = 2;

  void Check() const;  // throws InputError naming the option
};

// Where a feature of a marker was measured.
struct MarkerObservation {
  int feature = -1;  // the same in all frames
  estimation::Observation seen;
};

// The covariance of the rig's place as the estimator takes it, of a twist in the robot frame, from
// that of one in the rig frame (see Tracker).
geometry::Matrix6d InRobotFrame(const geometry::Matrix6d& rig_covariance,
                                const Eigen::Isometry3d& T_rig_robot);

class ForceLocator;
class ShapeMemory;

// From detections to forces, frame after frame: predicts the features from the body's last state
// and the new actuation, allocates detections to them, locates them, and estimates the forces.
// Where the forces' places are not known, the markers are followed by forces on all candidates,
// and the forces are then found from what was allocated.
class Tracker {
 public:
  // `rig_covariance`: of a twist xi in the rig frame, T_rig_robot = ExpSe3(xi) · estimate. Scene,
  // world and rig must outlive the tracker. The rig has no cameras if motion capture measures.
  Tracker(const scene::Scene& scene, const World& world, const camera::Rig& rig,
          const Eigen::Isometry3d& T_rig_robot, const geometry::Matrix6d& rig_covariance,
          const TrackerOptions& options = {});
  ~Tracker();

  FrameResult Process(int frame, double time_s, const std::vector<CameraDetections>& detections);

  // A frame that is not to be relied on, for this reason: the body only follows its actuators.
  FrameResult Skip(int frame, double time_s, const std::string& reason);

  // The rig stands elsewhere from the next frame on.
  void PlaceRig(const Eigen::Isometry3d& T_rig_robot, const geometry::Matrix6d& rig_covariance);

  const fem::Equilibrium& state() const;

  // What the last frame's forces were estimated from, rejected ones included.
  const std::vector<MarkerObservation>& observations() const { return observations_; }

  // Which detections the last frame's features were given.
  const FeatureSightings& sightings() const { return sightings_; }

 private:
  // Which marker is which, and what was known before that was found out.
  struct Allocated {
    FeatureSightings sightings;
    std::vector<FeatureObservation> located;
    // Of the forces and the rig's place, for moving dots only.
    allocation::Belief prior, delta;
    Eigen::VectorXd intensity;  // N, that the prior is about

    bool joint() const { return prior.mean.size() > 0; }
    int held() const;  // features that were located
  };
  // A way to understand a frame.
  struct Attempt {
    Allocated allocated;
    estimation::ForceEstimate estimate;
    std::vector<char> chosen;                     // per feature, see Choose
    std::vector<MarkerObservation> observations;  // that it was estimated from

    int used() const;
    int rejected() const;
  };
  // Where a wide search looks about.
  struct Beginning {
    enum class At { kLastState, kUnloaded, kShape };

    At at;
    const estimation::ForceEstimator::Memory* state = nullptr;  // kShape
  };
  struct Proposal {
    Allocated allocated;
    std::shared_ptr<const estimation::ForceEstimator::Memory> start;  // where it was proposed
  };

  // The features at the body's state, by changes of the forces and of the rig's place.
  std::vector<MovingFeature> Linearise() const;
  // N² per frame, of each component: how far forces may go.
  Eigen::VectorXd Walk(const std::vector<MovingFeature>& features) const;
  Eigen::MatrixXd SharedCovariance(const Eigen::MatrixXd& intensities) const;
  // m², of each feature's own error.
  double OwnVariance() const;
  Allocated Allocate(const std::vector<CameraDetections>& detections, double threshold);
  // Anew where the body was found to be: false if nothing changes.
  bool AllocateAgain(const std::vector<CameraDetections>& detections, double threshold,
                     const Eigen::MatrixXd& covariance, Allocated* allocated);
  // Estimates the forces and allocates again where they bring the body, until that is settled.
  // `again`: not the first attempt at this frame.
  Attempt Settle(Allocated allocated, const std::vector<CameraDetections>& detections,
                 double threshold, const fem::Actuation& actuation, bool again);
  // Where the markers were not found near where they should be.
  std::optional<Attempt> SearchWidely(const std::vector<CameraDetections>& detections,
                                      const fem::Actuation& actuation);
  // Takes the body to where a wide search may begin: false if it cannot be there.
  bool Begin(const Beginning& beginning, const fem::Actuation& actuation);
  std::vector<Beginning> Beginnings(const std::vector<CameraDetections>& detections) const;
  std::vector<Proposal> ProposeAll(const std::vector<CameraDetections>& detections,
                                   const fem::Actuation& actuation);
  bool MaySearch();
  Eigen::Matrix3Xd MarkersNow() const;
  std::vector<Allocated> Propose(const std::vector<CameraDetections>& detections,
                                 const Eigen::MatrixXd& intensities) const;
  // A dot that comes back in one camera alone, while another should see it too, is believed when
  // that camera sees it a second time: it may be something else.
  void LeaveOutUnconfirmed(const std::vector<MovingFeature>& features, FeatureSightings* sightings);
  // How the dots look that the forces explain, for the next frame.
  void LearnLooks(const std::vector<CameraDetections>& detections,
                  const std::vector<char>& rejected);
  // The features at the body's state, without their uncertainties.
  std::vector<PredictedFeature> PlacedFeatures() const;
  // Whether no camera could see the features of each marker.
  void TellWhatIsAbsent(std::vector<MarkerResult>* markers) const;
  std::vector<MarkerObservation> ObservationsOf(const Allocated& allocated,
                                                const std::vector<char>& chosen) const;
  void ExpectMarkers(const std::vector<FeatureObservation>& located,
                     const std::vector<char>& rejected, std::vector<MarkerResult>* markers);
  std::vector<MarkerResult> MarkerResults(const std::vector<FeatureObservation>& observations,
                                          const std::vector<char>& rejected) const;
  // Which of the located features to estimate from, and what their markers tell about the forces.
  std::vector<char> Choose(const std::vector<FeatureObservation>& located);
  void TellWhatWasUsed(const std::vector<char>& chosen, const std::vector<char>& rejected,
                       std::vector<MarkerResult>* markers) const;
  void AddActuators(const fem::Actuation& actuation, FrameResult* result) const;
  std::vector<ForceResult> ForceResults(const estimation::ForceEstimate& estimate) const;
  // Forces of unknown place, from what was allocated and not rejected; rejects more of it.
  void LocateForces(const fem::Actuation& actuation, FrameResult* result,
                    std::vector<char>* rejected);

  const scene::Scene& scene_;
  const World& world_;
  const camera::Rig& rig_;
  Eigen::Isometry3d T_rig_robot_;
  TrackerOptions options_;
  MarkerFeatures features_;
  estimation::ForceEstimator estimator_;
  std::unique_ptr<ForceLocator> locator_;       // null if places are known
  std::unique_ptr<ShapeMemory> shapes_;         // that usable frames had
  geometry::Matrix6d registration_covariance_;  // as the estimator takes it
  std::vector<MarkerObservation> observations_;
  FeatureSightings sightings_;
  std::vector<DotLook> looks_;  // of the last frame with forces; they outlast a blackout
  // Per feature and camera, whether it was sighted there in the last frame, believed or not, and in
  // this one; empty if the last frame is not to be relied on.
  std::vector<std::vector<char>> sighted_before_, sighted_;
  double own_variance_;              // m², of hidden markers' own errors, as the last frames say
  std::vector<double> information_;  // per marker, of the last frame
  Eigen::MatrixXd intensity_covariance_;  // N²; grows by the random walk from frame to frame
  // Of wide searches: after one in vain the next few frames go without, then more and more.
  struct {
    int frames_to_wait = 0, next_wait = 0;
  } search_;
  int frames_without_forces_ = 0;  // since the last usable one
};

}  // namespace softforce::pipeline
