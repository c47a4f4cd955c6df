#include "softforce/vision/choose_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "softforce/base/input_error.h"

namespace softforce::vision {
namespace {

using Status = ViewVerdict::Status;
using Sets = std::vector<std::vector<BoardDetection>>;
using Verdicts = std::vector<std::vector<ViewVerdict>>;

// Blur of the sharper quarter of a camera's views, px; NaN if none is known.
double SharpBlur(std::vector<double> blurs) {
  if (blurs.empty()) return NAN;
  std::sort(blurs.begin(), blurs.end());
  return blurs[blurs.size() / 4];
}

std::vector<double> Blurs(const Sets& sets, size_t camera) {
  std::vector<double> blurs;
  for (const auto& set : sets) {
    if (set[camera].ok() && std::isfinite(set[camera].blur)) blurs.push_back(set[camera].blur);
  }
  return blurs;
}

ViewVerdict JudgeAlone(const BoardDetection& view, double sharp_blur,
                       const ChooseOptions& options) {
  if (!view.ok()) return {Status::kNoBoard, view.reason};
  if (view.blur > options.max_blur * view.cell) {
    return {Status::kBlurred,
            fmt::format("blurred: edges are spread by {:.1f} px, {:.2f} of a cell of the board, at "
                        "most {:.2f} is taken",
                        view.blur, view.blur / view.cell, options.max_blur)};
  }
  if (view.blur > options.max_blur_ratio * sharp_blur) {
    return {Status::kBlurred,
            fmt::format("blurred: edges are spread by {:.1f} px, in the camera's sharper pictures "
                        "by {:.1f} px",
                        view.blur, sharp_blur)};
  }
  return {Status::kKept, ""};
}

// Mean motion of the common points, in cells; nothing if fewer than half are common.
std::optional<double> Motion(const BoardDetection& a, const BoardDetection& b) {
  double sum = 0;
  int common = 0;
  for (int i = 0, j = 0; i < a.view.size() && j < b.view.size();) {  // both by rising id
    if (a.view.ids[i] < b.view.ids[j]) {
      ++i;
    } else if (a.view.ids[i] > b.view.ids[j]) {
      ++j;
    } else {
      sum += (a.view.pixels[i++] - b.view.pixels[j++]).norm();
      ++common;
    }
  }
  if (2 * common < std::max(a.view.size(), b.view.size())) return std::nullopt;
  return sum / common / (0.5 * (a.cell + b.cell));
}

// How much moment a adds to b: the largest motion in any camera, in cells; infinite if it shows
// what b does not.
double Difference(const std::vector<BoardDetection>& a, const std::vector<ViewVerdict>& in_a,
                  const std::vector<BoardDetection>& b, const std::vector<ViewVerdict>& in_b) {
  double difference = 0;
  for (size_t c = 0; c < a.size(); ++c) {
    if (!in_a[c].kept()) continue;
    if (!in_b[c].kept()) return INFINITY;
    const std::optional<double> motion = Motion(a[c], b[c]);
    if (!motion) return INFINITY;
    difference = std::max(difference, *motion);
  }
  return difference;
}

double Difference(const Sets& sets, const Verdicts& verdicts, size_t a, size_t b) {
  return Difference(sets[a], verdicts[a], sets[b], verdicts[b]);
}

std::string AlikeReason(size_t moment, double difference, const ChooseOptions& options) {
  return fmt::format(
      "shows the same as moment {}: moved by {:.2f} cells of the board, at least "
      "{:.2f} make a difference",
      moment, difference, options.min_motion);
}

double WorstBlur(const std::vector<BoardDetection>& set, const std::vector<ViewVerdict>& verdicts) {
  double worst = 0;
  for (size_t c = 0; c < set.size(); ++c) {
    if (verdicts[c].kept() && std::isfinite(set[c].blur)) worst = std::max(worst, set[c].blur);
  }
  return worst;
}

void LeaveOut(Status status, const std::string& reason, std::vector<ViewVerdict>* set) {
  for (ViewVerdict& verdict : *set) {
    if (verdict.kept()) verdict = {status, reason};
  }
}

// Moments with any view left, the sharper ones first; a tenth of a pixel makes no difference.
std::vector<size_t> BySharpness(const Sets& sets, const Verdicts& verdicts) {
  std::vector<std::pair<double, size_t>> order;
  for (size_t i = 0; i < sets.size(); ++i) {
    const bool any = std::any_of(verdicts[i].begin(), verdicts[i].end(),
                                 [](const ViewVerdict& verdict) { return verdict.kept(); });
    if (any) order.emplace_back(std::floor(10 * WorstBlur(sets[i], verdicts[i])), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<size_t> moments;
  for (const auto& [blur, i] : order) moments.push_back(i);
  return moments;
}

std::vector<size_t> DropDuplicates(const Sets& sets, const ChooseOptions& options,
                                   Verdicts* verdicts) {
  std::vector<size_t> kept;
  const Verdicts alone = *verdicts;
  for (const size_t i : BySharpness(sets, alone)) {
    const auto twin = std::find_if(kept.begin(), kept.end(), [&](size_t k) {
      return Difference(sets, alone, i, k) < options.min_motion;
    });
    if (twin == kept.end()) {
      kept.push_back(i);
      continue;
    }
    const double difference = Difference(sets, alone, i, *twin);
    LeaveOut(Status::kDuplicate, AlikeReason(*twin, difference, options), &(*verdicts)[i]);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

// Farthest-point sampling: from the first on, always the one most different from those taken.
void DropSurplus(const Sets& sets, const ChooseOptions& options, const std::vector<size_t>& kept,
                 Verdicts* verdicts) {
  if (options.max_sets == 0 || static_cast<int>(kept.size()) <= options.max_sets) return;
  const Verdicts before = *verdicts;
  std::vector<double> distance(kept.size(), INFINITY);
  std::vector<bool> taken(kept.size(), false);
  size_t next = 0;
  for (int count = 0; count < options.max_sets; ++count) {
    taken[next] = true;
    size_t farthest = kept.size();
    for (size_t k = 0; k < kept.size(); ++k) {
      if (taken[k]) continue;
      distance[k] = std::min(distance[k], Difference(sets, before, kept[k], kept[next]));
      if (farthest == kept.size() || distance[k] > distance[farthest]) farthest = k;
    }
    next = farthest;
  }
  for (size_t k = 0; k < kept.size(); ++k) {
    if (taken[k]) continue;
    LeaveOut(Status::kSurplus,
             fmt::format("more than {} moments: this one is among those most like the others",
                         options.max_sets),
             &(*verdicts)[kept[k]]);
  }
}

}  // namespace

void ChooseOptions::Check() const {
  const auto require = [](bool holds, const char* option, const char* rule) {
    if (!holds) throw base::InputError(std::string("choosing views: ") + option, rule);
  };
  require(max_blur > 0, "max_blur", "must be > 0 cells");
  require(max_blur_ratio >= 1, "max_blur_ratio", "must be 1 or more");
  require(min_motion >= 0, "min_motion", "must be 0 cells or more");
  require(max_speed > 0, "max_speed", "must be > 0 cells");
  require(max_sets >= 0, "max_sets", "must be 0 or more");
}

Verdicts ChooseViews(const Sets& sets, const ChooseOptions& options) {
  options.Check();
  Verdicts verdicts(sets.size());
  const size_t cameras = sets.empty() ? 0 : sets.front().size();
  std::vector<double> sharp;
  for (size_t c = 0; c < cameras; ++c) sharp.push_back(SharpBlur(Blurs(sets, c)));
  for (size_t i = 0; i < sets.size(); ++i) {
    for (size_t c = 0; c < cameras; ++c) {
      verdicts[i].push_back(JudgeAlone(sets[i][c], sharp[c], options));
    }
  }
  const std::vector<size_t> kept = DropDuplicates(sets, options, &verdicts);
  DropSurplus(sets, options, kept, &verdicts);
  return verdicts;
}

ViewChooser::ViewChooser(const ChooseOptions& options) : options_(options) { options_.Check(); }

std::vector<ViewVerdict> ViewChooser::Add(const std::vector<BoardDetection>& set) {
  ++moment_;
  blurs_.resize(set.size());
  std::vector<ViewVerdict> verdicts;
  for (size_t c = 0; c < set.size(); ++c) {
    if (set[c].ok() && std::isfinite(set[c].blur)) blurs_[c].push_back(set[c].blur);
    ViewVerdict verdict = JudgeAlone(set[c], SharpBlur(blurs_[c]), options_);
    if (verdict.kept() && !before_.empty() && before_[c].ok()) {
      const double speed = Motion(before_[c], set[c]).value_or(INFINITY);
      if (speed > options_.max_speed) {
        verdict = {Status::kMoving,
                   fmt::format("the board moves by {:.2f} of its cells between pictures, at most "
                               "{:.2f} is taken",
                               speed, options_.max_speed)};
      }
    }
    verdicts.push_back(std::move(verdict));
  }
  before_ = set;
  for (size_t k = 0; k < kept_.size(); ++k) {
    std::vector<ViewVerdict> in_kept;
    for (const BoardDetection& view : kept_[k]) {
      in_kept.push_back({view.ok() ? Status::kKept : Status::kNoBoard, ""});
    }
    const double difference = Difference(set, verdicts, kept_[k], in_kept);
    if (difference >= options_.min_motion) continue;
    LeaveOut(Status::kDuplicate, AlikeReason(moments_[k], difference, options_), &verdicts);
    return verdicts;
  }
  std::vector<BoardDetection> views = set;
  bool any = false;
  for (size_t c = 0; c < set.size(); ++c) {
    any = any || verdicts[c].kept();
    if (!verdicts[c].kept()) views[c] = {};
  }
  if (any) {
    kept_.push_back(std::move(views));
    moments_.push_back(moment_);
  }
  return verdicts;
}

}  // namespace softforce::vision
