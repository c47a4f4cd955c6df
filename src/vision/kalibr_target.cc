#include "vision/kalibr_target.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::vision {
namespace {

using base::InputError;

template <typename T>
T Entry(const YAML::Node& target, const char* key, const std::string& file) {
  const YAML::Node node = target[key];
  if (!node) throw InputError(file, fmt::format("\"{}\" is missing", key));
  try {
    return node.as<T>();
  } catch (const YAML::Exception&) {
    throw InputError(file, fmt::format("{}: cannot be read as a value of its kind", key));
  }
}

Board AprilGrid(const YAML::Node& target, const std::string& file) {
  Board board;
  board.kind = Board::Kind::kAprilGrid;
  board.columns = Entry<int>(target, "tagCols", file);
  board.rows = Entry<int>(target, "tagRows", file);
  board.tag = Entry<double>(target, "tagSize", file);
  board.gap_ratio = Entry<double>(target, "tagSpacing", file);
  board.family = "tag36h11";
  return board;
}

Board Chessboard(const YAML::Node& target, const std::string& file) {
  Board board;
  board.kind = Board::Kind::kChessboard;
  board.columns = Entry<int>(target, "targetCols", file);
  board.rows = Entry<int>(target, "targetRows", file);
  board.square = Entry<double>(target, "colSpacingMeters", file);
  const double down = Entry<double>(target, "rowSpacingMeters", file);
  if (std::abs(down - board.square) > 1e-6 * board.square) {
    throw InputError(file, fmt::format("cells are {:g} x {:g} mm; expected squares",
                                       1e3 * board.square, 1e3 * down));
  }
  return board;
}

}  // namespace

Board ReadKalibrTarget(const std::filesystem::path& path) {
  const std::string file = path.string();
  YAML::Node target;
  try {
    target = YAML::LoadFile(file);
  } catch (const YAML::BadFile&) {
    throw InputError(file, "cannot be opened", "Check the path of the target file.");
  } catch (const YAML::Exception& error) {
    throw InputError(file, std::string("is not YAML: ") + error.what());
  }
  if (!target.IsMap()) throw InputError(file, "is not a target file of Kalibr");
  const auto kind = Entry<std::string>(target, "target_type", file);
  if (kind != "aprilgrid" && kind != "checkerboard") {
    throw InputError(file,
                     fmt::format("target_type is \"{}\", expected aprilgrid or checkerboard", kind),
                     "Other boards are written in words:\n" + std::string(kBoardHelp));
  }
  const Board board = kind == "aprilgrid" ? AprilGrid(target, file) : Chessboard(target, file);
  try {
    board.Check();
  } catch (const InputError& error) {
    throw InputError(file, error.what());
  }
  return board;
}

}  // namespace softforce::vision
