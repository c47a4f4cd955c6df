#include "softforce/scene/set_time_offsets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "scene/text_edits.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/scene/rig_file.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;

std::string TextOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw base::InputError(file.string(), "cannot be read");
  return text.str();
}

std::string InMs(double seconds) { return fmt::format("{:.4f} ms", 1e3 * seconds); }

// A rig as another program wrote it has no place for them.
bool IsOurs(const YAML::Node& root) { return root.IsMap() && root["softforce"]; }

class Change {
 public:
  Change(fs::path from, const std::string& text)
      : from_(std::move(from)), root_(YAML::Load(text)), edits_(text) {}

  void Set(const std::string& camera, const std::string& key, const std::string& value) {
    const YAML::Node map = root_["cameras"][camera];
    if (const YAML::Node old = map[key]) {
      edits_.Replace(Place(old, camera, key), value);
      return;
    }
    for (const auto& entry : map) {
      if (entry.first.Scalar() != "model") continue;
      edits_.AddAfter(map, entry.first, Place(entry.second, camera, key), key + ": " + value);
    }
  }

  std::string Result() const { return edits_.Result(); }

 private:
  ScalarPlace Place(const YAML::Node& node, const std::string& camera, const std::string& key) {
    const auto place = edits_.Find(node);
    if (place) return *place;
    throw base::InputError(
        fmt::format("{}: camera \"{}\": {}", from_.string(), camera, key),
        "cannot be written where it stands: it is an anchor, an alias, or broken over lines",
        "Write the camera out, one key on each line.");
  }

  const fs::path from_;
  YAML::Node root_;
  TextEdits edits_;
};

bool ReadsBack(const camera::Rig& rig, const camera::Rig& written) {
  constexpr double kRounding = 1e-7;  // s
  if (written.cameras.size() != rig.cameras.size()) return false;
  for (size_t c = 0; c < rig.cameras.size(); ++c) {
    const camera::Camera &a = rig.cameras[c], &b = written.cameras[c];
    if (a.name != b.name || std::abs(a.time_offset_s - b.time_offset_s) > kRounding) return false;
    if (!a.T_camera_rig.isApprox(b.T_camera_rig, 1e-12)) return false;
  }
  return true;
}

}  // namespace

void WriteTimeOffsets(const fs::path& from, const camera::Rig& rig, const fs::path& to) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(to, error);  // a link stays one
  const fs::path target = error ? to : canonical;
  const std::string text = TextOf(from);
  if (!IsOurs(YAML::Load(text))) return SaveRig(rig, target);
  Change change(from, text);
  for (const camera::Camera& camera : rig.cameras) {
    if (camera.time_offset_sd_s > 0) {
      change.Set(camera.name, "time_offset_sd", InMs(std::max(1e-7, camera.time_offset_sd_s)));
    }
    if (camera.time_offset_s != 0 || camera.time_offset_sd_s > 0) {
      change.Set(camera.name, "time_offset", InMs(camera.time_offset_s));
    }
  }
  base::PendingFile pending(target);
  {
    std::ofstream stream(pending.temporary(), std::ios::binary);
    stream << change.Result();
    stream.close();
    if (!stream) {
      throw base::InputError(to.string(), "cannot be written",
                             "Check that its folder exists, may be written to, and has room.");
    }
  }
  if (!ReadsBack(rig, LoadRig(pending.temporary()))) {
    throw base::InputError(from.string(), "the time offsets cannot be replaced where they stand",
                           "Write the cameras out, without aliases.");
  }
  if (fs::exists(target, error)) {
    fs::permissions(pending.temporary(), fs::status(target, error).permissions(), error);
  }
  pending.Commit();
}

}  // namespace softforce::scene
