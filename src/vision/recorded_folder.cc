#include "vision/recorded_folder.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <fstream>
#include <sstream>

#include "softforce/base/input_error.h"

namespace softforce::vision {

namespace {

// Reads a number and the character after it; false if there is none.
template <class T>
bool Take(const char** from, const char* end, char after, T* value) {
  const auto [next, error] = std::from_chars(*from, end, *value);
  if (error != std::errc() || (after == '\0' ? next != end : next == end || *next != after)) {
    return false;
  }
  *from = next + (after == '\0' ? 0 : 1);
  return true;
}

std::optional<RecordedTime> ParseTime(const std::string& line) {
  RecordedTime time;
  const char* at = line.data();
  const char* end = at + line.size();
  if (Take(&at, end, ',', &time.frame) && Take(&at, end, ',', &time.time_s) &&
      Take(&at, end, ',', &time.camera_time_s) && Take(&at, end, '\0', &time.segment)) {
    return time;
  }
  return std::nullopt;
}

}  // namespace

std::filesystem::path SegmentFile(const std::filesystem::path& camera_folder, int segment) {
  return camera_folder / fmt::format("{:06}.mkv", segment);
}

std::string FormatTime(const RecordedTime& time) {
  return fmt::format("{},{},{},{}", time.frame, time.time_s, time.camera_time_s, time.segment);
}

std::vector<RecordedTime> ReadTimes(const std::filesystem::path& camera_folder) {
  const std::filesystem::path file = camera_folder / kTimesFile;
  std::ifstream stream(file);
  std::stringstream content;
  content << stream.rdbuf();
  const std::string text = content.str();
  std::vector<RecordedTime> times;
  size_t from = text.find('\n');
  if (!stream || text.substr(0, from) != kTimesHeader) {
    throw base::InputError(camera_folder.string(),
                           fmt::format("is a folder without {}", kTimesFile),
                           "Give a video file, or the folder of one camera in what 'softforce "
                           "record' wrote, as DIR/left.");
  }
  while (from != std::string::npos) {
    const size_t to = text.find('\n', from + 1);
    if (to == std::string::npos) break;  // cut off while it was written
    const auto time = ParseTime(text.substr(from + 1, to - from - 1));
    const bool follows = time && time->frame == static_cast<int>(times.size()) &&
                         time->segment >= (times.empty() ? 0 : times.back().segment);
    if (!follows) {
      throw base::InputError(fmt::format("{}: line {}", file.string(), times.size() + 2),
                             fmt::format("got \"{}\", expected {} that follows the line before",
                                         text.substr(from + 1, to - from - 1), kTimesHeader),
                             "Put the file back as it was recorded.");
    }
    times.push_back(*time);
    from = to;
  }
  return times;
}

double RecordedTimeOffset(const std::filesystem::path& camera_folder) {
  const auto folder = camera_folder.lexically_normal();  // "take1/left/" has no file name
  const std::string name = (folder.has_filename() ? folder : folder.parent_path()).filename();
  try {
    const YAML::Node manifest = YAML::LoadFile((camera_folder / ".." / kManifest).string());
    for (const YAML::Node& camera : manifest["cameras"]) {
      if (camera["name"].as<std::string>("") == name) return camera[kTimeOffsetKey].as<double>(0);
    }
  } catch (const YAML::Exception&) {  // as a folder that was copied without it
  }
  return 0;
}

bool IsComplete(const std::filesystem::path& recording_folder) {
  std::ifstream stream(recording_folder / kManifest);
  std::string line;
  while (std::getline(stream, line)) {
    if (line == kCompleteLine) return true;
  }
  return false;
}

}  // namespace softforce::vision
