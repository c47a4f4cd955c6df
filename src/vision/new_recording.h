#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softforce/vision/recorder.h"

namespace softforce::vision {

// Throws InputError for names of cameras that cannot name their folders.
void CheckFolderNames(const std::vector<std::string>& cameras);

// Throws InputError if it cannot be made.
void MakeFolder(const std::filesystem::path& folder);

// The recording's own description, recording.yaml. It replaces an older one at once, and is on the
// disk afterwards.
struct Manifest {
  const std::vector<std::string>& cameras;
  const std::string& started;  // UTC
  const RecorderOptions& options;
  const RecorderReport& report;
  bool complete;
};
void WriteManifest(const std::filesystem::path& folder, const Manifest& manifest);

}  // namespace softforce::vision
