#include "vision/input_files.h"

#include <algorithm>
#include <set>

#include "softforce/base/entries.h"
#include "softforce/base/input_error.h"

namespace softforce::vision {

namespace fs = std::filesystem;
using base::InputError;

InputKind KindOf(const fs::path& file) {
  static const std::set<std::string> kPictures{".png",  ".jpg", ".jpeg", ".bmp",  ".tif",
                                               ".tiff", ".pgm", ".ppm",  ".webp", ".jp2"};
  static const std::set<std::string> kVideos{".mp4",  ".avi", ".mkv", ".mov",
                                             ".webm", ".m4v", ".mpg", ".ts"};
  const std::string ending = base::LowerCase(file.extension().string());
  if (kPictures.count(ending) > 0) return InputKind::kPicture;
  return kVideos.count(ending) > 0 ? InputKind::kVideo : InputKind::kNeither;
}

namespace {

bool Matches(const char* pattern, const char* name) {
  if (*pattern == 0) return *name == 0;
  if (*pattern == '*')
    return Matches(pattern + 1, name) || (*name != 0 && Matches(pattern, name + 1));
  return *name != 0 && (*pattern == '?' || *pattern == *name) && Matches(pattern + 1, name + 1);
}

// Files of a folder whose names match, in their order.
std::vector<fs::path> Listed(const fs::path& folder, const std::string& pattern) {
  std::vector<fs::path> files;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(folder, unreadable)) {
    const fs::path& file = entry.path();
    if (!entry.is_regular_file() || KindOf(file) == InputKind::kNeither) continue;
    if (Matches(pattern.c_str(), file.filename().c_str())) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<fs::path> InputFiles(const std::string& input) {
  const fs::path path = input;
  if (fs::is_directory(path)) {
    std::vector<fs::path> files = Listed(path, "*");
    if (files.empty()) throw InputError(input, "is a folder without pictures or videos");
    return files;
  }
  const std::string name = path.filename().string();
  if (name.find_first_of("*?") != std::string::npos && !fs::exists(path)) {
    std::vector<fs::path> files =
        Listed(path.has_parent_path() ? path.parent_path() : fs::path("."), name);
    if (files.empty()) {
      throw InputError(input, "matches no picture or video",
                       "Check the folder and the pattern; * and ? work in the file's name.");
    }
    if (!path.has_parent_path()) {
      for (fs::path& file : files) file = file.filename();
    }
    return files;
  }
  if (!fs::is_regular_file(path)) throw InputError(input, "there is no such file or folder");
  if (KindOf(path) == InputKind::kNeither) {
    throw InputError(input, "is neither a picture nor a video, by its ending",
                     "Pictures: .png .jpg .bmp .tif .pgm .webp; videos: .mp4 .avi .mkv .mov.");
  }
  return {path};
}

}  // namespace softforce::vision
