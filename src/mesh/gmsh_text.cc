#include "mesh/gmsh_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

using base::InputError;

// Text sections of numbers hold nothing else.
void CheckCharacters(const std::string& where, const std::string& name, std::string_view section,
                     std::string_view allowed) {
  const std::size_t at = section.find_first_not_of(allowed);
  if (at == std::string_view::npos) return;
  const std::size_t start = section.find_last_of('\n', at) + 1;
  const auto line = 1 + std::count(section.begin(), section.begin() + at, '\n');
  const std::string_view shown = section.substr(start, section.find_first_of("\r\n", at) - start);
  throw InputError(where,
                   fmt::format("${}, line {} after its title: expected numbers, got \"{}\"", name,
                               line - 1, shown.substr(0, 60)),
                   kGmshFileAdvice);
}

// Numbers in text stand on lines of their own: one per node or element, and in format 4.1 one more
// per block and per node tag. A lost line break would make the SDK read nodes as element types.
void CheckLines(const std::string& where, const std::string& name, std::string_view section,
                std::size_t expected) {
  std::size_t lines = 0;
  for (std::size_t at = 0; (at = section.find_first_not_of(" \t\r\n", at)) != section.npos;) {
    ++lines;
    at = std::min(section.find('\n', at), section.size());
  }
  if (lines == expected) return;
  throw InputError(where,
                   fmt::format("${} has {} lines of numbers, must have {} by its first line", name,
                               lines, expected),
                   kGmshFileAdvice);
}

// The first number of a section, which in format 4.1 is the number of blocks.
std::size_t ReadBlockCount(std::string_view section) {
  std::istringstream stream{std::string(section.substr(0, 200))};
  std::size_t blocks = 0;
  stream >> blocks;
  return blocks;
}

// Number of nodes of the common kinds of element; 0 for the others.
int NodesOfType(int type) {
  static const std::map<int, int> kNodes{{1, 2}, {2, 3}, {3, 4}, {4, 4},   {5, 8}, {6, 6},
                                         {7, 5}, {8, 3}, {9, 6}, {11, 10}, {15, 1}};
  const auto found = kNodes.find(type);
  return found == kNodes.end() ? 0 : found->second;
}

// In format 2 each line is: element, type, how many tags, the tags, the nodes.
void CheckElementLines(const std::string& where, std::string_view section) {
  std::istringstream stream{std::string(section)};
  std::string line;
  while (std::getline(stream, line)) {
    std::istringstream words(line);
    int element = 0, type = 0, num_tags = 0, word = 0, num_words = 0;
    if (!(words >> element >> type >> num_tags)) continue;  // the first line, or an empty one
    while (words >> word) ++num_words;
    const int num_nodes = NodesOfType(type);
    if (num_nodes == 0 || num_words == num_tags + num_nodes) continue;
    throw InputError(where,
                     fmt::format("$Elements, element {}: {} numbers follow, must be {} tags and {} "
                                 "nodes by its type {}",
                                 element, num_words, num_tags, num_nodes, type),
                     kGmshFileAdvice);
  }
}

}  // namespace

void CheckGmshText(const std::string& where, bool version_4, std::string_view nodes,
                   std::string_view elements, const GmshFileCounts& counts) {
  CheckCharacters(where, "Nodes", nodes, "0123456789+-.eEdDnNaAiIfF \t\r\n");
  if (version_4) {
    CheckCharacters(where, "Elements", elements, "0123456789 \t\r\n");
    CheckLines(where, "Nodes", nodes, 1 + ReadBlockCount(nodes) + 2 * counts.nodes);
    CheckLines(where, "Elements", elements, 1 + ReadBlockCount(elements) + counts.elements);
  } else {
    // Ghost cells of partitioned files have negative tags.
    CheckCharacters(where, "Elements", elements, "-0123456789 \t\r\n");
    CheckLines(where, "Nodes", nodes, 1 + counts.nodes);
    CheckLines(where, "Elements", elements, 1 + counts.elements);
    CheckElementLines(where, elements);
  }
}

}  // namespace softforce::mesh
