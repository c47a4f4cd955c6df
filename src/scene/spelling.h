#pragma once

#include <optional>
#include <string>
#include <vector>

namespace softforce::scene {

// "frame, mesh, unit"
std::string Join(const std::vector<std::string>& words);

// The word among `known` that is reached with the fewest letters inserted, deleted or replaced;
// nothing if more than half of `word` would have to change.
std::optional<std::string> Nearest(const std::string& word, const std::vector<std::string>& known);

// `Did you mean "mesh"?` for "mehs", or an empty text.
std::string DidYouMean(const std::string& word, const std::vector<std::string>& known);

}  // namespace softforce::scene
