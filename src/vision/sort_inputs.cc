#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "softforce/base/entries.h"
#include "softforce/base/input_error.h"
#include "softforce/vision/board_pictures.h"
#include "vision/picture_names.h"

namespace softforce::vision {
namespace {

namespace fs = std::filesystem;
using base::InputError;

constexpr const char* kHowToName =
    "Name the cameras yourself, as left='cam_a*.png' right='cam_b*.png'.";

enum class Kind { kPicture, kVideo, kNeither };

Kind KindOf(const fs::path& file) {
  static const std::set<std::string> kPictures{".png",  ".jpg", ".jpeg", ".bmp",  ".tif",
                                               ".tiff", ".pgm", ".ppm",  ".webp", ".jp2"};
  static const std::set<std::string> kVideos{".mp4",  ".avi", ".mkv", ".mov",
                                             ".webm", ".m4v", ".mpg", ".ts"};
  const std::string ending = base::LowerCase(file.extension().string());
  if (kPictures.count(ending) > 0) return Kind::kPicture;
  return kVideos.count(ending) > 0 ? Kind::kVideo : Kind::kNeither;
}

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
    if (!entry.is_regular_file() || KindOf(file) == Kind::kNeither) continue;
    if (Matches(pattern.c_str(), file.filename().c_str())) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> Expanded(const std::string& input) {
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
  if (KindOf(path) == Kind::kNeither) {
    throw InputError(input, "is neither a picture nor a video, by its ending",
                     "Pictures: .png .jpg .bmp .tif .pgm .webp; videos: .mp4 .avi .mkv .mov.");
  }
  return {path};
}

void AddPictures(const std::vector<Numbered>& files, CameraInput* camera) {
  for (const Numbered& file : files) camera->pictures.push_back({file.file, file.number});
  std::stable_sort(camera->pictures.begin(), camera->pictures.end(),
                   [](const auto& a, const auto& b) { return a.number < b.number; });
}

CameraInput Named(const std::string& name, const std::vector<fs::path>& files) {
  CameraInput camera;
  camera.camera = name;
  if (KindOf(files.front()) == Kind::kVideo) {
    if (files.size() > 1) {
      throw InputError(
          files[1].string(),
          fmt::format("camera \"{}\" has a video already, {}", name, files.front().string()),
          "Give one video for each camera.");
    }
    camera.video = files.front();
    return camera;
  }
  AddPictures(Number(files), &camera);
  return camera;
}

std::vector<CameraInput> Grouped(const std::vector<fs::path>& files) {
  std::vector<std::pair<std::string, std::string>> keys;
  std::vector<std::vector<Numbered>> members;
  if (files.empty()) return {};
  const bool videos = KindOf(files.front()) == Kind::kVideo;
  for (Numbered& file : Number(files)) {
    // Each video is a camera of its own, whatever its name.
    const std::pair<std::string, std::string> key{file.folder,
                                                  videos ? file.file.stem().string() : file.key};
    const auto found = std::find(keys.begin(), keys.end(), key);
    const size_t index = found - keys.begin();
    if (found == keys.end()) {
      keys.push_back(key);
      members.emplace_back();
    }
    members[index].push_back(std::move(file));
  }
  const std::vector<std::string> names = CameraNames(keys);
  std::vector<CameraInput> cameras;
  for (size_t c = 0; c < keys.size(); ++c) {
    CameraInput camera;
    camera.camera = names[c];
    if (videos) {
      camera.video = members[c].front().file;
    } else {
      AddPictures(members[c], &camera);
    }
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

void RefuseMixedKinds(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    if (KindOf(file) == KindOf(files.front())) continue;
    throw InputError(file.string(),
                     fmt::format("pictures and videos are mixed: {} is of the other kind",
                                 files.front().string()),
                     "Give pictures for all cameras, or videos for all.");
  }
}

// Every picture needs one of the same number in every other camera.
void RefuseUnpaired(const std::vector<CameraInput>& cameras) {
  std::vector<std::map<int, fs::path>> by_number(cameras.size());
  for (size_t c = 0; c < cameras.size(); ++c) {
    for (const auto& [file, number] : cameras[c].pictures) {
      if (number < 0) {
        throw InputError(file.string(), "has no number to pair it with the other cameras' pictures",
                         "Number the pictures: left01.png and right01.png belong together.");
      }
      const auto [before, is_new] = by_number[c].emplace(number, file);
      if (is_new) continue;
      throw InputError(file.string(),
                       fmt::format("camera \"{}\" has a picture {} already, {}", cameras[c].camera,
                                   number, before->second.string()),
                       kHowToName);
    }
  }
  for (size_t a = 0; a < cameras.size(); ++a) {
    for (const auto& [number, file] : by_number[a]) {
      for (size_t b = 0; b < cameras.size(); ++b) {
        if (by_number[b].count(number) > 0) continue;
        throw InputError(
            file.string(),
            fmt::format("camera \"{}\" has no picture {} to go with it", cameras[b].camera, number),
            std::string("Pictures are paired by their numbers: leave this one out, or "
                        "add its partner. If the cameras are sorted wrongly: ") +
                kHowToName);
      }
    }
  }
}

// "left" of "left=cam*.png"; empty if the input has no name.
std::string NameOf(const std::string& input) {
  const size_t equals = input.find('=');
  if (equals == std::string::npos || fs::exists(input)) return "";
  const std::string name = input.substr(0, equals);
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  return plain ? name : "";
}

}  // namespace

std::vector<CameraInput> SortInputs(const std::vector<std::string>& inputs) {
  if (inputs.empty()) {
    throw InputError("inputs", "there are none",
                     "Give pictures or a video of each camera, as 'left*.jpg' 'right*.jpg'.");
  }
  std::vector<std::string> names;  // in the order of their first input; "" stands for the unnamed
  std::map<std::string, std::vector<fs::path>> files;
  std::vector<fs::path> all;
  for (const std::string& input : inputs) {
    const std::string name = NameOf(input);
    if (files.count(name) == 0) names.push_back(name);
    for (fs::path& file : Expanded(name.empty() ? input : input.substr(name.size() + 1))) {
      if (std::find(all.begin(), all.end(), file) != all.end()) {
        throw InputError(file.string(), "is given twice");
      }
      all.push_back(file);
      files[name].push_back(std::move(file));
    }
  }
  RefuseMixedKinds(all);
  std::vector<CameraInput> cameras;
  for (const std::string& name : names) {
    if (!name.empty()) cameras.push_back(Named(name, files[name]));
    if (!name.empty()) continue;
    for (CameraInput& camera : Grouped(files[name])) cameras.push_back(std::move(camera));
  }
  if (cameras.size() > 1 && cameras.front().video.empty()) RefuseUnpaired(cameras);
  if (cameras.size() == 1) {  // nothing to pair: the order counts
    auto& pictures = cameras.front().pictures;
    for (size_t k = 0; k < pictures.size(); ++k) {
      if (pictures[k].number < 0) pictures[k].number = static_cast<int>(k);
    }
  }
  return cameras;
}

}  // namespace softforce::vision
