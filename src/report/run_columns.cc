#include "softforce/report/run_columns.h"

#include <algorithm>

namespace softforce::report {

void Extent::Add(double value) {
  if (!std::isfinite(value)) return;
  low = known() ? std::min(low, value) : value;
  high = std::isfinite(high) ? std::max(high, value) : value;
}

void Extent::Add(const Extent& other) {
  Add(other.low);
  Add(other.high);
}

void ForceExtent::Add(const ForceExtent& other) {
  for (size_t i = 0; i < value.size(); ++i) {
    value[i].Add(other.value[i]);
    band[i].Add(other.band[i]);
  }
}

void RunColumn::Add(const RunColumn& later) {
  if (frames == 0) {
    *this = later;
    return;
  }
  last_frame = later.last_frame;
  last_s = later.last_s;
  frames += later.frames;
  reduced_chi2.Add(later.reduced_chi2);
  forces.resize(std::max(forces.size(), later.forces.size()));
  for (size_t f = 0; f < later.forces.size(); ++f) forces[f].Add(later.forces[f]);
  markers.resize(std::max(markers.size(), later.markers.size()));
  for (size_t m = 0; m < later.markers.size(); ++m) {
    markers[m] = std::max(markers[m], later.markers[m]);
  }
}

void RunColumns::Add(const RunColumn& frame) {
  if (columns_.empty() || columns_.back().frames >= frames_per_column_) {
    if (columns_.size() == static_cast<size_t>(kMaxColumns)) {
      for (size_t i = 0; i < columns_.size() / 2; ++i) {
        RunColumn joined = columns_[2 * i];
        joined.Add(columns_[2 * i + 1]);
        columns_[i] = joined;
      }
      columns_.resize(columns_.size() / 2);
      frames_per_column_ *= 2;
    }
    columns_.push_back(frame);
  } else {
    columns_.back().Add(frame);
  }
}

}  // namespace softforce::report
