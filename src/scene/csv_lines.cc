#include "scene/csv_lines.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include "softforce/base/input_error.h"

namespace softforce::scene {
namespace {

std::string Trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

// "" within quotes stands for one quote, as spreadsheets write it.
std::vector<std::string> SplitCells(const std::string& text) {
  std::vector<std::string> cells;
  std::string cell;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      if (quoted && i + 1 < text.size() && text[i + 1] == '"') {
        cell += text[++i];
      } else {
        quoted = !quoted;
      }
    } else if (text[i] == ',' && !quoted) {
      cells.push_back(Trimmed(cell));
      cell.clear();
    } else {
      cell += text[i];
    }
  }
  cells.push_back(Trimmed(cell));
  return cells;
}

}  // namespace

bool CsvLine::IsBlank() const {
  return std::all_of(cells.begin(), cells.end(), [](const auto& cell) { return cell.empty(); });
}

std::vector<CsvLine> ReadCsvLines(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) {
    throw base::InputError(file.string(), "cannot be read", "Check that you may read it.");
  }
  const std::string byte_order_mark = "\xEF\xBB\xBF";  // spreadsheets put it in front of UTF-8
  std::vector<CsvLine> lines;
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    if (number == 1 && text.rfind(byte_order_mark, 0) == 0) text.erase(0, byte_order_mark.size());
    CsvLine line{number, SplitCells(text)};
    if (!line.IsBlank()) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace softforce::scene
