#include "softforce/vision/tags.h"

#include <apriltag.h>

#include <algorithm>
#include <array>

#include "softforce/base/input_error.h"
#include "vision/tag_edges.h"
#include "vision/tag_family.h"

namespace softforce::vision {
namespace {

// AprilTag 3 has the pixel CORNER at (0, 0); the project, like OpenCV, the pixel CENTRE.
constexpr double kHalfPixel = 0.5;

}  // namespace

void TagOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("tags: ") + option, rule);
  };
  require(decimate >= 1 && decimate <= 8, "decimate", "must lie between 1 and 8");
  require(max_corrected_bits >= 0 && max_corrected_bits <= 3, "max_corrected_bits",
          "must lie between 0 and 3");
  require(min_decision_margin >= 0, "min_decision_margin", "must be 0 or more");
  require(black_border == 1 || black_border == 2, "black_border", "must be 1 or 2 cells");
  require(border >= 0, "border", "must be 0 px or more");
}

struct TagDetector::State {
  const FamilyMaker& maker;
  TagOptions options;
  apriltag_family_t* family;
  apriltag_detector_t* detector;

  State(const std::string& name, const TagOptions& options_in)
      : maker(MakerOf(name)), options(options_in) {
    options.Check();
    family = CreateFamily(maker, options.black_border);
    detector = apriltag_detector_create();
    apriltag_detector_add_family_bits(detector, family, options.max_corrected_bits);
    detector->quad_decimate = static_cast<float>(options.decimate);
    detector->nthreads = 1;
    detector->refine_edges = true;
  }
  ~State() {
    apriltag_detector_destroy(detector);
    maker.destroy(family);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  std::optional<Tag> Accept(const cv::Mat& grey, const apriltag_detection_t& found,
                            const cv::Point& origin, const camera::Lens* lens) const;
};

std::optional<Tag> TagDetector::State::Accept(const cv::Mat& grey,
                                              const apriltag_detection_t& found,
                                              const cv::Point& origin,
                                              const camera::Lens* lens) const {
  if (found.decision_margin < options.min_decision_margin) return std::nullopt;
  Tag tag;
  tag.family = maker.name;
  tag.id = found.id;
  tag.decision_margin = found.decision_margin;
  // AprilTag lists bottom left, bottom right, top right, top left of the tag as it draws it.
  for (int i = 0; i < 4; ++i) {
    const double* p = found.p[(maker.turned_by_opencv ? 5 - i : 3 - i) % 4];
    tag.corners[i] = Eigen::Vector2d(p[0] + origin.x, p[1] + origin.y).array() - kHalfPixel;
  }
  const std::optional<RefinedCorners> refined = RefineCorners(
      grey, tag.corners, {CellsOf(maker, family, found.id), family->reversed_border, lens});
  if (!refined) return std::nullopt;
  tag.corners = refined->corners;
  tag.corner_covariances = refined->covariances;
  for (const Eigen::Vector2d& corner : tag.corners) {
    if (corner.minCoeff() < options.border || corner.x() > grey.cols - 1 - options.border ||
        corner.y() > grey.rows - 1 - options.border) {
      return std::nullopt;
    }
  }
  return tag;
}

TagDetector::TagDetector(const std::string& family, const TagOptions& options)
    : state_(std::make_unique<State>(family, options)) {}
TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;

std::vector<Tag> TagDetector::Detect(const cv::Mat& grey, const camera::Lens* lens) const {
  return DetectIn(grey, cv::Rect(0, 0, grey.cols, grey.rows), state_->options.decimate, lens);
}

std::vector<Tag> TagDetector::DetectIn(const cv::Mat& grey, const cv::Rect& area, double decimate,
                                       const camera::Lens* lens) const {
  CV_Assert(grey.type() == CV_8UC1);
  if (area.empty()) return {};
  const cv::Mat part = grey(area);
  // AprilTag only reads the picture; its interface wants it writable all the same.
  image_u8_t view{part.cols, part.rows, static_cast<int>(part.step), const_cast<uchar*>(part.data)};
  state_->detector->quad_decimate = static_cast<float>(decimate);
  zarray_t* found = apriltag_detector_detect(state_->detector, &view);
  std::vector<Tag> tags;
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(found, i, &detection);
    if (auto tag = state_->Accept(grey, *detection, area.tl(), lens)) {
      tags.push_back(std::move(*tag));
    }
  }
  apriltag_detections_destroy(found);
  std::sort(tags.begin(), tags.end(), [](const Tag& a, const Tag& b) {
    return std::make_pair(a.id, a.corners[0].y()) < std::make_pair(b.id, b.corners[0].y());
  });
  return tags;
}

}  // namespace softforce::vision
