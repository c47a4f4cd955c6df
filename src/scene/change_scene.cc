#include "softforce/scene/change_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "scene/text_edits.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/base/quantity.h"
#include "softforce/scene/scene.h"

namespace softforce::scene {
namespace {

namespace fs = std::filesystem;

// Six digits, in the unit that was there.
std::string InUnitOf(const std::string& old, double value, base::Dimension dimension) {
  const size_t last = old.find_last_not_of(" \t");
  const size_t space = old.find_last_of(" \t0123456789", last);
  const std::string unit = old.substr(space + 1, last - space);
  return fmt::format("{:.6g} {}", value / base::UnitInSi(unit, dimension, "unit"), unit);
}

// The file itself, where a link leads to it: that is replaced, and the link stays.
fs::path Behind(const fs::path& file) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(file, error);
  return error ? fs::absolute(file).lexically_normal() : canonical;
}

// A scene being changed.
class Change {
 public:
  Change(const fs::path& from, const fs::path& to);

  void SetMaterials(const SceneChanges& changes);
  void SetCableOffset(const std::string& actuator, double offset);
  void MovePaths();
  void Write(const SceneChanges& changes) const;

 private:
  [[noreturn]] void Refuse(const YAML::Node& node, const std::string& what,
                           const std::string& value) const;
  void SetScalar(const YAML::Node& node, const std::string& what, const std::string& value);
  void MovePath(const YAML::Node& node, const std::string& what, const fs::path& absolute);
  void CheckReadsBack(const Scene& written, const SceneChanges& changes) const;

  const fs::path from_, to_;
  const Scene scene_;  // as it was
  std::string text_;
  YAML::Node root_;
  TextEdits edits_;
};

std::string TextOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

Change::Change(const fs::path& from, const fs::path& to)
    : from_(from),
      to_(Behind(to)),
      // Paths in a scene that is changed in place stay, from whichever folder a link leads to it.
      scene_(LoadScene(Behind(from) == to_ ? to_ : from, SceneFiles::kNone)),
      text_(TextOf(from)),
      root_(YAML::Load(text_)),
      edits_(text_) {}

void Change::Refuse(const YAML::Node& node, const std::string& what,
                    const std::string& value) const {
  throw base::InputError(
      fmt::format("{}:{}: {}", from_.string(), node.Mark().line + 1, what),
      "cannot be replaced where it stands: it is an anchor, an alias, or broken over lines",
      fmt::format("Write it out as a plain value, or enter by hand: {}", value));
}

void Change::SetScalar(const YAML::Node& node, const std::string& what, const std::string& value) {
  const auto place = edits_.Find(node);
  if (!place) Refuse(node, what, value);
  edits_.Replace(*place, value);
}

void Change::SetMaterials(const SceneChanges& changes) {
  const YAML::Node materials = root_["body"]["material"];
  const auto material = [&](const std::string& region) {
    return region.empty() ? materials : materials[region];
  };
  for (const auto& [region, modulus] : changes.youngs_modulus) {
    const YAML::Node node = material(region)["youngs_modulus"];
    SetScalar(node, "youngs_modulus", InUnitOf(node.Scalar(), modulus, base::Dimension::kPressure));
  }
  for (const auto& [region, ratio] : changes.poissons_ratio) {
    SetScalar(material(region)["poissons_ratio"], "poissons_ratio", fmt::format("{:.6g}", ratio));
  }
}

void Change::SetCableOffset(const std::string& actuator, double offset) {
  for (const Actuator& described : scene_.actuators) {
    if (described.name != actuator) continue;
    const auto index = &described - scene_.actuators.data();
    const YAML::Node map = root_["actuators"][static_cast<size_t>(index)];
    const bool tension = described.input == ActuatorInput::kTension;
    if (const YAML::Node old = map["offset"]) {
      const auto dimension = tension ? base::Dimension::kForce : base::Dimension::kLength;
      SetScalar(old, actuator + ": offset", InUnitOf(old.Scalar(), offset, dimension));
      return;
    }
    const std::string entry = tension ? fmt::format("offset: {:.6g} N", offset)
                                      : fmt::format("offset: {:.6g} mm", 1e3 * offset);
    for (const auto& input : map) {
      if (input.first.Scalar() != "input") continue;
      const auto place = edits_.Find(input.second);
      if (!place) Refuse(input.second, actuator + ": offset", entry);
      edits_.AddAfter(map, input.first, *place, entry);
    }
    return;
  }
}

void Change::MovePath(const YAML::Node& node, const std::string& what, const fs::path& absolute) {
  if (fs::path(node.Scalar()).is_absolute() || !absolute.is_absolute()) return;  // or an address
  SetScalar(node, what, fs::relative(absolute, to_.parent_path()).generic_string());
}

void Change::MovePaths() {
  if (fs::weakly_canonical(scene_.file.parent_path()) == fs::weakly_canonical(to_.parent_path())) {
    return;
  }
  MovePath(root_["body"]["mesh"]["file"], "mesh: file", scene_.mesh.file);
  if (scene_.actuation_file) MovePath(root_["actuation"], "actuation", *scene_.actuation_file);
  if (scene_.measured) {
    const YAML::Node measured = root_["measured"];
    MovePath(measured.IsMap() ? measured["file"] : measured, "measured", scene_.measured->file);
    if (!scene_.measured->rig.empty()) {
      MovePath(measured["rig"], "measured: rig", scene_.measured->rig);
    }
  } else {
    MovePath(root_["cameras"]["rig"], "rig", scene_.cameras.rig);
  }
  for (const auto& [camera, source] : scene_.cameras.sources) {
    MovePath(root_["cameras"]["sources"][camera], "sources: " + camera, source);
  }
  if (!scene_.simulation) return;
  const YAML::Node simulation = root_["simulation"];
  const Simulation& old = *scene_.simulation;
  if (old.mesh_file) MovePath(simulation["mesh"]["file"], "simulation: mesh: file", *old.mesh_file);
  if (old.forces_file) MovePath(simulation["forces"], "simulation: forces", *old.forces_file);
  if (old.actuation_file) {
    MovePath(simulation["actuation"], "simulation: actuation", *old.actuation_file);
  }
}

void Change::CheckReadsBack(const Scene& written, const SceneChanges& changes) const {
  const auto near = [](double a, double b) {
    return std::abs(a - b) <= 1e-5 * std::abs(b) + 1e-9;  // six digits are written
  };
  const auto same_file = [](const fs::path& a, const fs::path& b) {
    return a == b || fs::weakly_canonical(a) == fs::weakly_canonical(b);
  };
  bool good = same_file(written.mesh.file, scene_.mesh.file) &&
              same_file(written.cameras.rig, scene_.cameras.rig);
  for (const auto& [region, old] : scene_.materials) {
    const auto modulus = changes.youngs_modulus.find(region);
    const auto ratio = changes.poissons_ratio.find(region);
    const fem::Material& now = written.materials.at(region);
    good &= near(now.youngs_modulus,
                 modulus == changes.youngs_modulus.end() ? old.youngs_modulus : modulus->second);
    good &= near(now.poissons_ratio,
                 ratio == changes.poissons_ratio.end() ? old.poissons_ratio : ratio->second);
  }
  for (size_t a = 0; a < scene_.actuators.size(); ++a) {
    const Actuator& old = scene_.actuators[a];
    const auto offset = changes.cable_offset.find(old.name);
    good &= near(written.actuators[a].offset,
                 offset == changes.cable_offset.end() ? old.offset : offset->second);
  }
  for (const auto& [camera, source] : scene_.cameras.sources) {
    const std::string& now = written.cameras.sources.at(camera);
    good &= now == source || same_file(now, source);
  }
  const auto same_or_none = [&](const std::optional<fs::path>& a,
                                const std::optional<fs::path>& b) {
    return a.has_value() == b.has_value() && (!a || same_file(*a, *b));
  };
  good &= same_or_none(written.actuation_file, scene_.actuation_file);
  good &= written.measured.has_value() == scene_.measured.has_value();
  if (good && scene_.measured) {
    good &= same_file(written.measured->file, scene_.measured->file) &&
            same_file(written.measured->rig, scene_.measured->rig);
  }
  if (scene_.simulation) {
    good &= same_or_none(written.simulation->mesh_file, scene_.simulation->mesh_file) &&
            same_or_none(written.simulation->forces_file, scene_.simulation->forces_file) &&
            same_or_none(written.simulation->actuation_file, scene_.simulation->actuation_file);
  }
  if (good) return;
  throw base::InputError(from_.string(),
                         "its values cannot be replaced one by one: some stand in two places",
                         "Write out what is an alias (*name), or enter the values by hand.");
}

void Change::Write(const SceneChanges& changes) const {
  base::PendingFile file(to_);
  {
    std::ofstream stream(file.temporary(), std::ios::binary);
    stream << edits_.Result();
    stream.close();
    if (!stream) {
      throw base::InputError(to_.string(), "cannot be written",
                             "Check that the folder is there, and the space on the disk.");
    }
  }
  CheckReadsBack(LoadScene(file.temporary(), SceneFiles::kNone), changes);
  std::error_code ignored;  // rights that cannot be kept are no reason to lose the values
  if (fs::exists(to_, ignored)) {
    fs::permissions(file.temporary(), fs::status(to_, ignored).permissions(), ignored);
  }
  file.Commit();
}

}  // namespace

void WriteChangedScene(const fs::path& from, const SceneChanges& changes, const fs::path& to) {
  Change change(from, to);
  change.SetMaterials(changes);
  for (const auto& [actuator, offset] : changes.cable_offset) {
    change.SetCableOffset(actuator, offset);
  }
  change.MovePaths();
  change.Write(changes);
}

}  // namespace softforce::scene
