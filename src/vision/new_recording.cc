#include "vision/new_recording.h"

#include <fmt/format.h>

#include <fstream>
#include <set>

#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "vision/recorded_folder.h"
#include "vision/segment_writer.h"

namespace softforce::vision {

namespace fs = std::filesystem;

namespace {

std::string Quoted(const std::string& text) {
  std::string quoted;
  for (const char letter : text) quoted += letter == '\'' ? "''" : std::string(1, letter);
  return "'" + quoted + "'";
}

}  // namespace

void CheckFolderNames(const std::vector<std::string>& cameras) {
  std::set<std::string> seen;
  for (const std::string& camera : cameras) {
    const bool is_folder_name = !camera.empty() && camera != "." && camera != ".." &&
                                camera.find('/') == std::string::npos && camera[0] != '-';
    if (!is_folder_name || !seen.insert(camera).second) {
      throw base::InputError("record",
                             fmt::format(is_folder_name ? "two cameras are called \"{}\""
                                                        : "\"{}\" cannot name a camera's folder",
                                         camera),
                             "Give each camera a name of its own, of letters, digits and _.");
    }
  }
  if (cameras.empty()) {
    throw base::InputError("record", "there is no camera", "Name one with --camera NAME=SOURCE.");
  }
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return;
  throw base::InputError(folder.string(), "the folder cannot be made: " + error.message(),
                         "Choose another.");
}

void RefuseUsedFolder(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return;
  if (!fs::is_directory(folder, ignored)) {
    throw base::InputError(folder.string(), "is a file, expected a folder to record to",
                           "Choose another.");
  }
  if (fs::is_empty(folder, ignored)) return;
  throw base::InputError(folder.string(),
                         fs::exists(folder / kManifest, ignored)
                             ? "already holds a recording, which is not overwritten"
                             : "is not empty; a recording gets a folder of its own",
                         "Choose another, or remove it.");
}

void WriteManifest(const fs::path& folder, const Manifest& manifest) {
  base::PendingFile file(folder / kManifest);
  {
    const auto& [cameras, started, options, report, complete] = manifest;
    std::ofstream out(file.temporary());
    out << "softforce_recording: 1\n";
    out << "started: " << started << "\n";
    out << "codec: magicyuv, grey, lossless\n";
    out << fmt::format("segment: {} s\n", options.segment_s);
    out << "cameras:\n";
    for (size_t c = 0; c < cameras.size(); ++c) {
      const std::string source = c < options.sources.size() ? options.sources[c] : "";
      const double offset_s = c < options.time_offsets_s.size() ? options.time_offsets_s[c] : 0;
      out << fmt::format("  - {{name: {}, source: {}, {}: {}}}\n", cameras[c], Quoted(source),
                         kTimeOffsetKey, offset_s);
    }
    out << fmt::format("frames: {}\n", report.written);
    out << fmt::format("dropped: {}\n", report.dropped);
    out << (complete ? kCompleteLine : "complete: false") << "\n";
  }
  SyncToDisk(file.temporary());
  file.Commit();
  SyncToDisk(folder);
}

}  // namespace softforce::vision
