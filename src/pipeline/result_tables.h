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

// What a scene has beside forces and markers.
struct TableKinds {
  bool cables = false;
  bool chambers = false;
  bool unknown_places = false;  // of the forces
};

// forces.csv, markers.csv, information.csv; actuation.csv for a scene with actuators, each kind
// with columns of its own; locations.csv if the places of forces are found.
class ResultTables {
 public:
  ResultTables(const std::filesystem::path& folder, TableKinds kinds);

  // The rows are in the partial files when it returns: a run that is killed loses none of them.
  void Add(const FrameResult& result);
  void Commit();

 private:
  void AddLocations(const FrameResult& result, const std::string& moment);
  void AddActuation(const FrameResult& result, const std::string& moment);

  PendingTable forces_;
  PendingTable markers_;
  PendingTable information_;
  std::optional<PendingTable> locations_;
  TableKinds kinds_;
  std::optional<PendingTable> actuation_;
};

}  // namespace softforce::pipeline
