#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace softforce::report {

// The lowest and highest of the values that were added; NaN before the first.
struct Extent {
  double low = NAN, high = NAN;

  bool known() const { return std::isfinite(low); }
  void Add(double value);  // a value that is not finite adds nothing
  void Add(const Extent& other);
};

// One force in the frames of a column.
struct ForceExtent {
  // x, y, z and norm, N: the values, and the 95 % bands around them.
  std::array<Extent, 4> value, band;

  void Add(const ForceExtent& other);
};

// What a chart over time shows at one place: one frame, or several in a row of a long run.
struct RunColumn {
  int first_frame = -1, last_frame = -1;  // numbers of the recording
  double first_s = NAN, last_s = NAN;
  int frames = 0;
  Extent reduced_chi2;              // chi2 per degree of freedom
  std::vector<ForceExtent> forces;  // may be shorter than the list of the run's forces
  // Of each marker the gravest status: the greatest index into RunRecord::marker_statuses.
  std::vector<unsigned char> markers;

  void Add(const RunColumn& later);
};

// All frames of a run, in no more than kMaxColumns columns whatever their number: whenever those
// are full, neighbours are joined, so that the extremes of every frame are kept.
class RunColumns {
 public:
  static constexpr int kMaxColumns = 1000;

  void Add(const RunColumn& frame);

  const std::vector<RunColumn>& columns() const { return columns_; }
  int frames_per_column() const { return frames_per_column_; }

 private:
  std::vector<RunColumn> columns_;
  int frames_per_column_ = 1;
};

}  // namespace softforce::report
