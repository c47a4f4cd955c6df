#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/spelling.h"
#include "softforce/base/quantity.h"

namespace softforce::scene {

// Of scene.yaml and rig.yaml: the number after the key "softforce".
inline constexpr int kFormatVersion = 1;

class YamlMap;

// A value of a YAML file that knows where it stands, so that every message can say so. Each reader
// throws InputError if the value is not of the kind asked for.
class YamlValue {
 public:
  // The whole file. Throws InputError if it cannot be read or is not YAML.
  static YamlValue FromFile(const std::filesystem::path& file);

  // "scene.yaml:12: markers: points[3]: position"
  std::string where() const;
  const std::filesystem::path& file() const { return file_; }

  std::string Text() const;  // not empty
  int Integer(int at_least) const;
  double Number() const;                                              // without unit, finite
  std::vector<double> Numbers(const std::vector<int>& counts) const;  // a list of those
  double Quantity(base::Dimension dimension) const;                   // "290 kPa"
  double PositiveQuantity(base::Dimension dimension) const;
  Eigen::Vector3d Vector(base::Dimension dimension) const;  // "65 130 10 mm"
  std::filesystem::path Path() const;  // absolute; in the file, relative to the file's folder
  std::filesystem::path ExistingFile() const;  // the same, and there is such a file

  // One of several words, each standing for a value.
  template <class T>
  T Choice(const std::vector<std::pair<std::string, T>>& choices) const;

  bool IsList() const { return node_.IsSequence(); }
  bool IsMap() const { return node_.IsMap(); }

  // The items of a list; `counts`: how many there may be, or empty for any number.
  std::vector<YamlValue> Items(const std::vector<int>& counts = {}) const;
  void RefuseEmptyList(const std::string& advice) const;

  // What `read` makes of a map. Keys that it did not ask for are refused.
  template <class Read>
  auto ReadMap(Read read) const;

  // What `read` makes of each item of a list of maps.
  template <class Read>
  auto ReadMaps(Read read) const;

  // Throws InputError at this place.
  [[noreturn]] void Fail(const std::string& problem, const std::string& advice = "") const;

 private:
  friend class YamlMap;
  YamlValue(YAML::Node node, std::filesystem::path file, int line, std::string key_path);
  YamlValue Child(const YAML::Node& node, const std::string& key_path) const;
  std::string Scalar(const std::string& expected) const;
  std::string Found() const;

  YAML::Node node_;
  std::filesystem::path file_;
  int line_;              // counted from 1
  std::string key_path_;  // "markers: points[3]: position"
};

// The keys of a map. It remembers which ones were asked for: these are the known ones.
class YamlMap {
 public:
  explicit YamlMap(const YamlValue& value);  // throws if it is no map, or has a key twice

  // `why`: advice for those who left it out.
  YamlValue Required(const std::string& key, const std::string& why = "");
  std::optional<YamlValue> Optional(const std::string& key);

  std::vector<std::string> Keys() const;  // in the file's order
  const YamlValue& value() const { return value_; }

  // Throws InputError on the first key that was not asked for.
  void RefuseOtherKeys() const;

 private:
  std::vector<std::string> UnaskedKeys() const;

  YamlValue value_;
  std::vector<std::pair<std::string, YamlValue>> entries_;
  std::set<std::string> asked_;
};

// Refuses a list in which two items bear the same label; `label` gives that of what was read from
// one.
template <class T, class Label>
void RefuseRepeated(const YamlValue& list, const std::vector<T>& read, Label label) {
  std::set<std::string> seen;
  for (size_t i = 0; i < read.size(); ++i) {
    const std::string text = label(read[i]);
    if (!seen.insert(text).second) list.Items()[i].Fail(text + " is given twice, expected once");
  }
}

template <class T>
T YamlValue::Choice(const std::vector<std::pair<std::string, T>>& choices) const {
  std::vector<std::string> words;
  for (const auto& [word, meaning] : choices) words.push_back(word);
  const std::string expected = "expected " + Join(words);
  const std::string text = Scalar(expected);
  for (const auto& [word, meaning] : choices) {
    if (word == text) return meaning;
  }
  Fail("got \"" + text + "\", " + expected, DidYouMean(text, words));
}

template <class Read>
auto YamlValue::ReadMap(Read read) const {
  YamlMap map(*this);
  auto result = read(map);
  map.RefuseOtherKeys();
  return result;
}

template <class Read>
auto YamlValue::ReadMaps(Read read) const {
  std::vector<decltype(ReadMap(read))> results;
  for (const YamlValue& item : Items()) results.push_back(item.ReadMap(read));
  return results;
}

// Throws InputError if the key "softforce" does not announce the format version that is read here.
void CheckFormatVersion(YamlMap& root);

// What `read` makes of the keys of a file of ours.
template <class Read>
auto ReadYamlFile(const std::filesystem::path& file, Read read) {
  return YamlValue::FromFile(file).ReadMap([&](YamlMap& root) {
    CheckFormatVersion(root);
    return read(root);
  });
}

}  // namespace softforce::scene
