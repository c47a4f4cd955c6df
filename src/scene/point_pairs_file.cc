#include "softforce/scene/point_pairs_file.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <sstream>

#include "scene/yaml_reader.h"
#include "softforce/base/input_error.h"

namespace softforce::scene {
namespace {

using base::InputError;

const std::vector<std::string> kColumns = {"x_mm", "y_mm", "z_mm", "camera", "u_px", "v_px"};

std::string Trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(Trimmed(cell));
  return cells;
}

int CameraCalled(const std::string& name, const camera::Rig& rig, const std::string& where) {
  if (const auto camera = rig.Find(name)) return *camera;
  std::vector<std::string> known;
  for (const camera::Camera& camera : rig.cameras) known.push_back(camera.name);
  throw InputError(where,
                   fmt::format("the rig has no camera \"{}\", expected {}", name, Join(known)),
                   DidYouMean(name, known));
}

// Where each of our columns stands in the file's.
std::array<size_t, 6> Order(const std::vector<std::string>& header, const std::string& where) {
  std::array<size_t, 6> order{};
  for (size_t c = 0; c < kColumns.size(); ++c) {
    size_t found = header.size();
    for (size_t h = 0; h < header.size(); ++h) {
      if (header[h] == kColumns[c]) found = h;
    }
    if (found == header.size() || header.size() != kColumns.size()) {
      throw InputError(where,
                       fmt::format("got the columns {}; expected {}", Join(header), Join(kColumns)),
                       "The first line is: x_mm,y_mm,z_mm,camera,u_px,v_px");
    }
    order[c] = found;
  }
  return order;
}

std::vector<TypedPair> ReadTable(const std::filesystem::path& file, const camera::Rig& rig) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file.string(), "cannot be read", "Check its name.");
  std::vector<TypedPair> pairs;
  std::array<size_t, 6> order{};
  bool header = true;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (number == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);
    const std::string text = Trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    const std::string where = fmt::format("{}:{}", file.string(), number);
    const std::vector<std::string> cells = Cells(text);
    if (header) {
      order = Order(cells, where);
      header = false;
      continue;
    }
    if (cells.size() != kColumns.size()) {
      throw InputError(where, fmt::format("got {} cells, expected {} as in the header",
                                          cells.size(), kColumns.size()));
    }
    const auto cell = [&](size_t c) {
      return base::ParseQuantity(cells[order[c]], base::Dimension::kNumber, 1,
                                 fmt::format("{}: column \"{}\"", where, kColumns[c]))[0];
    };
    pairs.push_back({1e-3 * Eigen::Vector3d(cell(0), cell(1), cell(2)),
                     CameraCalled(cells[order[3]], rig, where),
                     {cell(4), cell(5)},
                     number});
  }
  if (pairs.empty()) throw InputError(file.string(), "got no pairs, expected at least four");
  return pairs;
}

std::vector<TypedPair> ReadList(const std::filesystem::path& file, const camera::Rig& rig) {
  int item = 0;
  return YamlValue::FromFile(file).ReadMap([&](YamlMap& root) {
    root.Optional("softforce");
    return root.Required("pairs").ReadMaps([&](YamlMap& map) {
      TypedPair pair;
      pair.line = ++item;
      pair.p_robot = map.Required("position").Vector(base::Dimension::kLength);
      const YamlValue camera = map.Required("camera");
      pair.camera = CameraCalled(camera.Text(), rig, camera.where());
      pair.pixel = Eigen::Vector2d(map.Required("pixel").Numbers({2}).data());
      return pair;
    });
  });
}

}  // namespace

std::vector<TypedPair> ReadPointPairs(const std::filesystem::path& file, const camera::Rig& rig) {
  const std::string extension = file.extension().string();
  return extension == ".yaml" || extension == ".yml" ? ReadList(file, rig) : ReadTable(file, rig);
}

}  // namespace softforce::scene
