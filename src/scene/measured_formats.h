#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/csv_lines.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {

// Which marker a point is by what the file calls it.
class PointLabels {
 public:
  PointLabels(const Measured& measured, const Markers& markers);

  struct Meaning {
    bool used = true;  // false: to be ignored
    int marker = -1;   // number in the scene's list; −1: without a label
  };

  // Labels of Motive may have their asset in front, "Sheet:Marker 1". Throws InputError, naming
  // `where`, for a label of no marker.
  Meaning Of(const std::string& label, const std::string& where) const;

 private:
  const Measured& measured_;
  std::vector<std::string> labels_;  // of the markers
};

// Puts frames together from the rows of a file, and refuses what cannot be.
class FrameCollector {
 public:
  // From the next call of Add on. Throws InputError, naming `where`, if number or time do not
  // ascend.
  void Begin(int frame, double time_s, const std::string& where);

  // Throws InputError if the frame has the point's marker already.
  void Add(const MeasuredPoint& point, const std::string& label, const std::string& where);

  const std::vector<MeasuredFrame>& frames() const { return frames_; }

 private:
  std::vector<MeasuredFrame> frames_;
};

// Three cells of a point; nothing if all are empty. Throws InputError if only some are, or are no
// numbers.
std::optional<Eigen::Vector3d> ReadCoordinates(const CsvLine& line,
                                               const std::array<size_t, 3>& columns,
                                               double metres_per_unit, const std::string& label,
                                               const std::string& file);

double ReadNumber(const CsvLine& line, size_t column, const std::string& name,
                  const std::string& file);
int ReadFrameNumber(const CsvLine& line, size_t column, const std::string& file);

// A row must have as many cells as the header.
void CheckCells(const CsvLine& line, const CsvLine& header, const std::string& file);

bool IsMotiveExport(const std::vector<CsvLine>& lines);
MeasuredPoints ReadMotiveExport(const std::vector<CsvLine>& lines, const Measured& measured,
                                const Markers& markers);
MeasuredPoints ReadPointTable(const std::vector<CsvLine>& lines, const Measured& measured,
                              const Markers& markers);

}  // namespace softforce::scene
