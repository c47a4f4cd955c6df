#include "mesh/gmsh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <string_view>

#include "mesh/gmsh_text.h"
#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

using base::InputError;
constexpr auto& kAdvice = kGmshFileAdvice;

struct Format {
  std::string version;
  bool binary;
};

// Sections by name ("Nodes", "Elements", …): what stands between $Name and $EndName.
std::map<std::string, std::string_view> SplitSections(const std::string& where,
                                                      std::string_view text) {
  std::map<std::string, std::string_view> sections;
  std::size_t at = text.find_first_not_of(" \t\r\n");
  while (at != std::string_view::npos) {
    const std::size_t line_end = std::min(text.find_first_of("\r\n", at), text.size());
    const std::string_view title = text.substr(at, line_end - at);
    if (title.empty() || title[0] != '$') {
      const std::string_view shown = title.substr(0, 30);
      const bool printable =
          std::all_of(shown.begin(), shown.end(), [](char c) { return c >= ' ' && c <= '~'; });
      throw InputError(where,
                       fmt::format("byte {}: expected a section such as $MeshFormat, got {}", at,
                                   printable ? fmt::format("\"{}\"", shown) : "binary data"),
                       kAdvice);
    }
    const std::string name(title.substr(1, title.find_first_of(" \t") - 1));
    const std::string closing = "$End" + name;
    const std::size_t end = text.find(closing, line_end);
    if (end == std::string_view::npos) {
      throw InputError(
          where, fmt::format("section ${} is not closed by {}: the file is cut off", name, closing),
          kAdvice);
    }
    sections.emplace(name, text.substr(line_end, end - line_end));
    at = text.find_first_not_of(" \t\r\n", end + closing.size());
  }
  return sections;
}

Format ReadFormat(const std::string& where, std::string_view section) {
  std::istringstream stream{std::string(section)};
  Format format;
  int kind = -1, size_of_numbers = -1;
  stream >> format.version >> kind >> size_of_numbers;
  const bool known = format.version == "4.1" || format.version.substr(0, 1) == "2";
  if (!stream || !known || (kind != 0 && kind != 1) || size_of_numbers != 8) {
    throw InputError(where,
                     fmt::format("$MeshFormat is \"{} {} {}\", must be version 2.2 or 4.1, "
                                 "0 (text) or 1 (binary), 8-byte numbers",
                                 format.version, kind, size_of_numbers),
                     kAdvice);
  }
  format.binary = kind == 1;
  if (format.binary) {
    std::int32_t one = 0;
    stream.ignore(4, '\n');
    stream.read(reinterpret_cast<char*>(&one), sizeof one);
    if (one != 1) {
      throw InputError(where, "its binary numbers have another byte order than this machine's",
                       kAdvice);
    }
  }
  return format;
}

// The number of nodes or elements that a section announces at its start.
std::size_t ReadCount(const std::string& where, const std::string& name, std::string_view section,
                      const Format& format) {
  const bool version_4 = format.version == "4.1";
  std::uint64_t count = 0;
  bool read = false;
  if (version_4 && format.binary) {  // blocks, nodes, least tag, greatest tag
    std::array<std::uint64_t, 4> numbers{};
    const std::size_t start = section.find('\n') + 1;  // npos + 1 = 0: then it is too short anyway
    read = section.size() >= start + sizeof numbers;
    if (read) std::memcpy(numbers.data(), section.data() + start, sizeof numbers);
    count = numbers[1];
  } else {
    std::istringstream stream{std::string(section.substr(0, 200))};
    std::uint64_t blocks = 0;
    if (version_4) stream >> blocks;
    stream >> count;
    read = static_cast<bool>(stream);
  }
  if (!read || count > section.size()) {  // each takes more than a byte
    throw InputError(where,
                     fmt::format("${} announces {} of them in {} bytes: the file is damaged", name,
                                 count, section.size()),
                     kAdvice);
  }
  return count;
}

// Each line "dimension tag "name""; the SDK counts on dimensions up to 3.
void CheckPhysicalNames(const std::string& where, std::string_view section) {
  std::istringstream stream{std::string(section)};
  int count = 0;
  stream >> count;
  for (int i = 0; i < count; ++i) {
    int dimension = -1, tag = -1;
    std::string name;
    stream >> dimension >> tag;
    std::getline(stream, name);
    if (!stream || dimension < 0 || dimension > 3 || name.find('"') == name.npos) {
      throw InputError(where,
                       fmt::format("$PhysicalNames, entry {} of {}: expected a dimension from 0 to "
                                   "3, a tag and a name in quotation marks",
                                   i + 1, count),
                       kAdvice);
    }
  }
}

}  // namespace

GmshFileCounts InspectGmshFile(const std::filesystem::path& path) {
  const std::string where = path.string();
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw InputError(where, "cannot be read", "Check the file's permissions.");
  if (text.empty()) throw InputError(where, "the file is empty", kAdvice);

  const auto sections = SplitSections(where, text);
  for (const std::string name : {"MeshFormat", "Nodes", "Elements"}) {
    if (sections.count(name) == 0) {
      throw InputError(where, fmt::format("has no section ${}", name), kAdvice);
    }
  }
  const Format format = ReadFormat(where, sections.at("MeshFormat"));
  const std::string_view nodes = sections.at("Nodes");
  const std::string_view elements = sections.at("Elements");
  const GmshFileCounts counts{ReadCount(where, "Nodes", nodes, format),
                              ReadCount(where, "Elements", elements, format)};
  if (!format.binary) CheckGmshText(where, format.version == "4.1", nodes, elements, counts);
  if (sections.count("PhysicalNames") > 0) {
    CheckPhysicalNames(where, sections.at("PhysicalNames"));
  }
  return counts;
}

}  // namespace softforce::mesh
