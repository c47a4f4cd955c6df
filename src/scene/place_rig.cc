#include "softforce/scene/place_rig.h"

#include <fmt/format.h>

#include <cctype>
#include <fstream>
#include <sstream>
#include <vector>

#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/scene/rig_file.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;

constexpr char kKey[] = "T_rig_robot:";

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

std::string Block(const Eigen::Isometry3d& T, const std::string& comment) {
  std::string block = std::string(kKey) + "  # metres\n";
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) block += "  # " + line + "\n";
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector4d row = T.matrix().row(i);
    block += fmt::format("  - [{}]\n", fmt::join(row, ", "));
  }
  return block;
}

std::string Placed(const std::vector<std::string>& lines, const std::string& block) {
  std::string text;
  bool inside = false, placed = false;
  for (const std::string& line : lines) {
    if (line.rfind(kKey, 0) == 0 && !placed) {
      inside = placed = true;
      text += block;
      continue;
    }
    inside = inside && GoesOn(line);
    if (!inside) text += line;
  }
  if (placed) return text;
  if (!text.empty() && text.back() != '\n') text += '\n';
  return text + block;
}

bool IsOurs(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    if (line.rfind("softforce:", 0) == 0) return true;
  }
  return false;
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

void WritePlacedRig(const fs::path& from, const Eigen::Isometry3d& T_rig_robot,
                    const std::string& comment, const fs::path& to) {
  const camera::Rig before = LoadRig(from);
  const std::vector<std::string> lines = LinesOf(from);
  // Where a link leads to: that file is replaced, and the link stays.
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(to, error);
  const fs::path target = error ? to : canonical;
  if (!IsOurs(lines)) {  // a rig of another program, which has no such key
    camera::Rig placed = before;
    placed.T_rig_robot = T_rig_robot;
    SaveRig(placed, target);
    return;
  }
  base::PendingFile pending(target);
  WriteText(Placed(lines, Block(T_rig_robot, comment)), pending.temporary(), to);
  bool good = false;
  try {
    const camera::Rig after = LoadRig(pending.temporary());
    good = SameCameras(before, after) && after.T_rig_robot &&
           after.T_rig_robot->isApprox(T_rig_robot, 1e-12);
  } catch (const base::InputError&) {  // told below, in terms of the file that is there
  }
  if (!good) {
    throw base::InputError(from.string() + ": T_rig_robot", "cannot be replaced where it stands",
                           "Write it at the start of a line, as \"T_rig_robot:\" and four rows "
                           "below, or leave it out.");
  }
  if (fs::exists(target, error)) {
    fs::permissions(pending.temporary(), fs::status(target, error).permissions(), error);
  }
  pending.Commit();
}

}  // namespace softforce::scene
