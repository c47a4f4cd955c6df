#pragma once

#include <filesystem>
#include <fstream>
#include <optional>

#include "softforce/base/pending_file.h"
#include "softforce/pipeline/frame_result.h"

namespace softforce::pipeline {

// A text file that shows up under its name only once it is complete.
class PendingTable {
 public:
  // Throws InputError if the file cannot be written.
  PendingTable(const std::filesystem::path& path, const std::string& header);

  std::ostream& stream() { return stream_; }
  void Flush() { stream_.flush(); }  // what was written survives the end of the program

  // Throws InputError if anything could not be written (disk full).
  void Commit();

 private:
  base::PendingFile file_;
  std::ofstream stream_;
};

// The kinds of actuators that a scene has: each has columns of its own.
struct ActuatorKinds {
  bool cables = false;
  bool chambers = false;
};

// forces.csv, markers.csv, information.csv and, for a scene with actuators, actuation.csv.
class ResultTables {
 public:
  ResultTables(const std::filesystem::path& folder, ActuatorKinds kinds);

  // The rows are in the partial files when it returns: a run that is killed loses none of them.
  void Add(const FrameResult& result);
  void Commit();

 private:
  void AddActuation(const FrameResult& result, const std::string& moment);

  PendingTable forces_;
  PendingTable markers_;
  PendingTable information_;
  ActuatorKinds kinds_;
  std::optional<PendingTable> actuation_;
};

}  // namespace softforce::pipeline
