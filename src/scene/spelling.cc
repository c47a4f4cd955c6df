#include "scene/spelling.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace softforce::scene {
namespace {

int EditDistance(const std::string& a, const std::string& b) {
  // row[j]: the distance between the letters of `a` read so far and the first j letters of `b`.
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (size_t i = 0; i < a.size(); ++i) {
    int diagonal = row[0]++;
    for (size_t j = 0; j < b.size(); ++j) {
      const int replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string Join(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

std::optional<std::string> Nearest(const std::string& word, const std::vector<std::string>& known) {
  const auto nearest = std::min_element(
      known.begin(), known.end(),
      [&](const auto& a, const auto& b) { return EditDistance(word, a) < EditDistance(word, b); });
  if (nearest == known.end()) return std::nullopt;
  if (2 * EditDistance(word, *nearest) > static_cast<int>(word.size())) return std::nullopt;
  return *nearest;
}

std::string DidYouMean(const std::string& word, const std::vector<std::string>& known) {
  const std::optional<std::string> nearest = Nearest(word, known);
  return nearest ? fmt::format("Did you mean \"{}\"?", *nearest) : "";
}

}  // namespace softforce::scene
