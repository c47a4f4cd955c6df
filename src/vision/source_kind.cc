#include <algorithm>
#include <cctype>
#include <filesystem>

#include "softforce/vision/live_cameras.h"

namespace softforce::vision {

SourceKind KindOf(const std::string& source) {
  std::error_code ignored;  // a text that is no path is no file
  if (source.rfind("/dev/", 0) == 0) return SourceKind::kDevice;
  if (std::filesystem::exists(source, ignored)) return SourceKind::kFile;
  if (source.find(" ! ") != std::string::npos) return SourceKind::kPipeline;
  if (source.find("://") != std::string::npos && source.rfind("file:", 0) != 0) {
    return SourceKind::kUrl;
  }
  const bool number = !source.empty() && std::all_of(source.begin(), source.end(), [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
  });
  return number ? SourceKind::kDevice : SourceKind::kFile;
}

}  // namespace softforce::vision
