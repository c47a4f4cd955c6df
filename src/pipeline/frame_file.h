#pragma once

#include <filesystem>
#include <fstream>
#include <optional>

#include "pipeline/frame_pipeline.h"
#include "softforce/base/pending_file.h"

namespace softforce::pipeline {

inline constexpr char kFrameFile[] = "frames.bin";

// frames.bin: what the overlay shows of every frame, pictures apart. The displacements of the nodes
// are kept as 16-bit numbers, in steps of a power of two that suits the frame's largest component:
// 30 mm are then told within 0.5 µm, and never less than to 1/32767, which no picture shows. All
// else is kept as it is. To have the shapes is what lets `render` go at the speed of the pictures,
// and without the mechanics: a mesh that was corrected in the run need not be solved for again. The
// run draws what is kept, so the bytes that `render` draws are those of the run.
//
//   "softforce frames 2\n", int32 nodes; then per frame one record, little-endian throughout.
// Displacements (m) as the file gives them back: of these it keeps every bit.
Eigen::Matrix3Xd AsKept(const Eigen::Matrix3Xd& u);

class FrameFileWriter {
 public:
  // Throws InputError if the file cannot be written.
  FrameFileWriter(const std::filesystem::path& path, int num_nodes);

  void Add(const FrameInWork& frame);

  // Throws InputError if anything could not be written (disk full).
  void Commit();

 private:
  base::PendingFile file_;
  std::ofstream stream_;
};

class FrameFileReader {
 public:
  // Throws InputError for a file that is none, or of a body of another number of nodes.
  FrameFileReader(const std::filesystem::path& path, int num_nodes);

  // The next frame: everything but its pictures and detections; nothing at the end. Throws
  // InputError for a file that was cut off or holds numbers that cannot be.
  std::optional<FrameInWork> Next();

 private:
  std::filesystem::path path_;
  std::ifstream stream_;
  int num_nodes_;
};

}  // namespace softforce::pipeline
