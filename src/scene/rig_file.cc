#include "softforce/scene/rig_file.h"

#include <algorithm>
#include <fstream>

#include "scene/rig_formats.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"

namespace softforce::scene {

namespace fs = std::filesystem;

namespace {

RigFormat FormatOf(const YamlValue& file) {
  if (!file.IsMap()) file.Fail("got no keys, expected a rig of softforce, OpenCV, Kalibr or ROS");
  const std::vector<std::string> keys = YamlMap(file).Keys();
  const auto has = [&](const std::string& key) {
    return std::count(keys.begin(), keys.end(), key) > 0;
  };
  const auto has_any = [&](const std::vector<std::string>& some) {
    return std::any_of(some.begin(), some.end(), has);
  };
  if (has_any({"softforce", "cameras"})) return RigFormat::kSoftforce;
  if (has("cam0")) return RigFormat::kKalibr;
  if (has("distortion_model")) return RigFormat::kRos;
  const bool extrinsics = has("R") && has("T");
  if (extrinsics || has_any({"M1", "K1", "cameraMatrix1", "camera_matrix1", "cameraMatrix",
                             "camera_matrix", "Camera_Matrix", "K"})) {
    return RigFormat::kOpenCv;
  }
  file.Fail("got only the keys " + Join(keys) +
            ", expected \"softforce\" (rig.yaml), \"cam0\" (Kalibr), \"distortion_model\" "
            "(ROS) or \"M1\" or \"cameraMatrix\" (OpenCV)");
}

// One format for all; several files only where a rig has several.
RigFormat CommonFormat(const std::vector<YamlValue>& values) {
  const RigFormat format = FormatOf(values[0]);
  for (size_t i = 1; i < values.size(); ++i) {
    const RigFormat other = FormatOf(values[i]);
    if (other != format) {
      values[i].Fail(fmt::format("is a file of {}, expected one of {} as the first is",
                                 NameOf(other), NameOf(format)));
    }
    if (format == RigFormat::kSoftforce || format == RigFormat::kKalibr) {
      values[i].Fail(
          fmt::format("is a second file, expected one: {} has a rig in one file", NameOf(format)));
    }
  }
  return format;
}

void WriteFile(const fs::path& file, const std::string& text) {
  base::PendingFile pending(file);
  std::ofstream stream(pending.temporary(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) {
    throw base::InputError(file.string(), "cannot be written",
                           "Check that its folder exists, may be written to, and has room.");
  }
  pending.Commit();
}

void SaveRosRig(const camera::Rig& rig, const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) {
    throw base::InputError(folder.string(), "the folder cannot be made: " + failed.message());
  }
  const std::vector<std::string> texts = RosTexts(rig);
  for (size_t c = 0; c < texts.size(); ++c) {
    std::string stem = rig.cameras[c].name;
    std::replace(stem.begin(), stem.end(), '/', '_');  // ROS calls them stereo/left
    WriteFile(folder / (stem + ".yaml"), texts[c]);
  }
}

}  // namespace

std::string NameOf(RigFormat format) {
  switch (format) {
    case RigFormat::kSoftforce:
      return "softforce";
    case RigFormat::kOpenCv:
      return "OpenCV";
    case RigFormat::kKalibr:
      return "Kalibr";
    case RigFormat::kRos:
      return "ROS";
  }
  return "";
}

RigFormat FormatOfRig(const fs::path& file) { return FormatOf(YamlValue::FromFile(file)); }

camera::Rig LoadRig(const fs::path& file) { return LoadRig(std::vector<fs::path>{file}, {}); }

camera::Rig LoadRig(const std::vector<fs::path>& files, const RigReadOptions& options) {
  if (files.empty()) throw base::InputError("rig", "got no file, expected at least one");
  std::vector<YamlValue> values;
  for (const fs::path& file : files) values.push_back(YamlValue::FromFile(file));
  switch (CommonFormat(values)) {
    case RigFormat::kSoftforce:
      break;
    case RigFormat::kOpenCv:
      return ReadOpenCvRig(values, options);
    case RigFormat::kKalibr:
      return ReadKalibrRig(values[0]);
    case RigFormat::kRos:
      return ReadRosRig(values);
  }
  return ReadSoftforceRig(files[0]);
}

std::optional<RigStatistics> LoadRigStatistics(const fs::path& file) {
  std::optional<RigStatistics> statistics;
  if (FormatOfRig(file) == RigFormat::kSoftforce) {
    ReadSoftforceRig(file, &statistics);
  }
  return statistics;
}

void SaveRig(const camera::Rig& rig, const fs::path& file,
             const std::optional<RigStatistics>& statistics) {
  WriteFile(file, SoftforceText(rig, statistics));
}

void SaveRigAs(const camera::Rig& rig, RigFormat format, const fs::path& path) {
  switch (format) {
    case RigFormat::kSoftforce:
      return SaveRig(rig, path);
    case RigFormat::kOpenCv:
      return WriteFile(path, OpenCvText(rig, path.string()));
    case RigFormat::kKalibr:
      return WriteFile(path, KalibrText(rig, path.string()));
    case RigFormat::kRos:
      return SaveRosRig(rig, path);
  }
}

RigFormat ParseRigFormat(const std::string& word, const std::string& where) {
  const std::vector<std::pair<std::string, RigFormat>> formats = {
      {"softforce", RigFormat::kSoftforce},
      {"opencv", RigFormat::kOpenCv},
      {"kalibr", RigFormat::kKalibr},
      {"ros", RigFormat::kRos}};
  std::vector<std::string> words;
  for (const auto& [known, format] : formats) {
    if (known == word) return format;
    words.push_back(known);
  }
  throw base::InputError(where, "got \"" + word + "\", expected one of " + Join(words),
                         DidYouMean(word, words));
}

}  // namespace softforce::scene
