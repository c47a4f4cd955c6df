#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <vector>

namespace softforce::scene {

// Where a scalar stands in the text of a YAML file.
struct ScalarPlace {
  size_t at = 0;      // of its first character, or of its opening quote
  size_t length = 0;  // with quotes
  char quote = 0;     // ' or ", or 0
};

// A YAML text that is changed here and there, and else stays byte for byte as it is.
class TextEdits {
 public:
  explicit TextEdits(std::string text);

  // Nothing for a scalar that is not written out where it is used: one with an anchor, a tag, line
  // breaks or escapes.
  std::optional<ScalarPlace> Find(const YAML::Node& scalar) const;

  // Replaces a scalar's text; quoted as it was, or if it needs to be.
  void Replace(const ScalarPlace& place, const std::string& value);

  // Puts `key: value` after another entry of the same map.
  void AddAfter(const YAML::Node& map, const YAML::Node& key, const ScalarPlace& place,
                const std::string& entry);

  std::string Result() const;

 private:
  struct Edit {
    size_t at, length;
    std::string text;
  };

  size_t Position(const YAML::Mark& mark) const;

  std::string text_;
  std::vector<Edit> edits_;
};

}  // namespace softforce::scene
