#include "softforce/scene/place_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <vector>

#include "scene/rig_formats.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/scene/rig_file.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;

// All that a rig file says about its place.
constexpr std::array<const char*, 2> kKeys = {"T_rig_robot:", "T_rig_robot_covariance:"};

std::vector<std::string> LinesOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw base::InputError(file.string(), "cannot be read");
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line + "\n");
  return lines;
}

// Whether a line goes on with the value of the key before it.
bool GoesOn(const std::string& line) {
  const char first = line.empty() ? '\n' : line.front();
  return first == ' ' || first == '\t' || first == '-' || first == '[' || first == ']';
}

bool StartsPlace(const std::string& line) {
  return std::any_of(kKeys.begin(), kKeys.end(),
                     [&](const char* key) { return line.rfind(key, 0) == 0; });
}

// The lines with `block` where the first of the keys stood, or at the end.
std::string Placed(const std::vector<std::string>& lines, const std::string& block) {
  std::string text;
  bool inside = false, placed = false;
  for (const std::string& line : lines) {
    if (StartsPlace(line)) {
      inside = true;
      if (!placed) text += block;
      placed = true;
      continue;
    }
    inside = inside && GoesOn(line);
    if (!inside) text += line;
  }
  if (placed) return text;
  if (!text.empty() && text.back() != '\n') text += '\n';
  return text + block;
}

bool SameCameras(const camera::Rig& a, const camera::Rig& b) {
  if (a.cameras.size() != b.cameras.size()) return false;
  for (size_t c = 0; c < a.cameras.size(); ++c) {
    if (a.cameras[c].name != b.cameras[c].name ||
        !a.cameras[c].T_camera_rig.isApprox(b.cameras[c].T_camera_rig, 1e-12)) {
      return false;
    }
  }
  return true;
}

bool Stands(const camera::Rig& rig, const RigPlace& place) {
  return rig.T_rig_robot && rig.T_rig_robot->isApprox(place.T_rig_robot, 1e-12) &&
         (rig.T_rig_robot_covariance - place.covariance).isZero(0);
}

// Where a link leads to: that file is replaced, and the link stays.
fs::path LedTo(const fs::path& file) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(file, error);
  return error ? file : canonical;
}

// Written to a temporary file beside `to`.
void WriteText(const std::string& text, const fs::path& temporary, const fs::path& to) {
  std::ofstream stream(temporary, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) {
    throw base::InputError(to.string(), "cannot be written",
                           "Check that its folder exists, may be written to, and has room.");
  }
}

}  // namespace

void CheckCanHoldPlace(const fs::path& from, const fs::path& to) {
  if (FormatOfRig(from) == RigFormat::kSoftforce || LedTo(from) != LedTo(to)) return;
  throw base::InputError(
      to.string(),
      fmt::format("is a file of {}, which has no place for T_rig_robot, expected a rig.yaml",
                  NameOf(FormatOfRig(from))),
      "Write another file with -o rig.yaml, and name that one in the scene.");
}

void WritePlacedRig(const fs::path& from, const RigPlace& place, const fs::path& to) {
  const camera::Rig before = LoadRig(from);
  const fs::path target = LedTo(to);
  if (FormatOfRig(from) != RigFormat::kSoftforce) {
    CheckCanHoldPlace(from, to);
    camera::Rig placed = before;
    placed.T_rig_robot = place.T_rig_robot;
    placed.T_rig_robot_covariance = place.covariance;
    SaveRig(placed, target);
    return;
  }
  base::PendingFile pending(target);
  const std::string block = PlaceText(place.T_rig_robot, place.covariance, place.comment);
  WriteText(Placed(LinesOf(from), block), pending.temporary(), to);
  bool good = false;
  try {
    const camera::Rig after = LoadRig(pending.temporary());
    good = SameCameras(before, after) && Stands(after, place);
  } catch (const base::InputError&) {  // told below, in terms of the file that is there
  }
  if (!good) {
    throw base::InputError(from.string() + ": T_rig_robot", "cannot be replaced where it stands",
                           "Write it at the start of a line, as \"T_rig_robot:\" and four rows "
                           "below, or leave it out.");
  }
  std::error_code ignored;
  if (fs::exists(target, ignored)) {
    fs::permissions(pending.temporary(), fs::status(target, ignored).permissions(), ignored);
  }
  pending.Commit();
}

}  // namespace softforce::scene
