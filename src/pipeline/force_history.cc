#include "pipeline/force_history.h"

#include <algorithm>

#include "pipeline/body_views.h"

namespace softforce::pipeline {
namespace {

constexpr double kSpan = 10;      // s
constexpr double kLeastSpan = 1;  // s
constexpr double kShare = 0.22;   // of the pictures' height
constexpr int kLeastHeight = 84;  // px, in which the numbers can be read
constexpr int kBlock = 16;        // px, of H.264

void DropOlder(double than_s, render::ChartSeries* series) {
  const auto first = std::lower_bound(series->time_s.begin(), series->time_s.end(), than_s);
  const std::ptrdiff_t old = first - series->time_s.begin();
  for (std::vector<double>* values : {&series->time_s, &series->value, &series->sd}) {
    values->erase(values->begin(), values->begin() + old);
  }
}

}  // namespace

void ForceHistory::Add(const FrameResult& result) {
  if (!std::isfinite(first_s_)) first_s_ = result.time_s;
  newest_s_ = result.time_s;
  for (const ForceResult& force : result.forces) {
    const std::string name = ForceName(force);
    const auto same = [&](const render::ChartSeries& one) { return one.label == name; };
    if (std::none_of(series_.begin(), series_.end(), same)) series_.push_back({name, {}, {}, {}});
  }
  for (render::ChartSeries& one : series_) {
    const auto force =
        std::find_if(result.forces.begin(), result.forces.end(),
                     [&](const ForceResult& f) { return ForceName(f) == one.label; });
    const bool known = force != result.forces.end();
    one.time_s.push_back(result.time_s);
    one.value.push_back(known ? force->force.norm() : NAN);
    one.sd.push_back(known ? force->NormSd() : NAN);
    DropOlder(result.time_s - kSpan, &one);
  }
}

void ForceHistory::Draw(const cv::Mat3b& strip, render::Easel* easel) const {
  const double since = std::isfinite(first_s_) ? first_s_ : 0;
  const double newest = std::isfinite(newest_s_) ? newest_s_ : 0;
  render::DrawForceChart(strip, series_, std::max(newest, since + kLeastSpan),
                         std::clamp(newest - since, kLeastSpan, kSpan), easel);
}

int ForceHistory::StripHeight(int pictures_height) {
  const int least = std::max(kLeastHeight, cvRound(kShare * pictures_height));
  const int blocks = (pictures_height + least + kBlock - 1) / kBlock;
  return kBlock * blocks - pictures_height;
}

}  // namespace softforce::pipeline
