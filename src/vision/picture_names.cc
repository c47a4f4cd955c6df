#include "vision/picture_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

namespace softforce::vision {

namespace fs = std::filesystem;

namespace {

// A file's name, cut where digits begin and end.
struct Name {
  std::vector<std::string> words, numbers;  // one word more than numbers

  explicit Name(const std::string& stem) : words(1) {
    bool in_number = false;
    for (const char c : stem) {
      const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
      if (digit && !in_number) numbers.emplace_back();
      if (!digit && in_number) words.emplace_back();
      in_number = digit;
      (digit ? numbers : words).back() += c;
    }
    if (words.size() == numbers.size()) words.emplace_back();
  }
};

// Words of a folder and key, without what stands for the number.
std::vector<std::string> WordsOf(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

}  // namespace

std::vector<Numbered> Number(const std::vector<fs::path>& files) {
  std::map<std::vector<std::string>, std::vector<std::set<std::string>>> values;
  const auto likeness = [](const fs::path& file, const Name& name) {
    std::vector<std::string> words = name.words;
    words.push_back(file.extension().string());
    return words;
  };
  for (const fs::path& file : files) {
    const Name name(file.stem().string());
    auto& seen = values[likeness(file, name)];
    seen.resize(name.numbers.size());
    for (size_t k = 0; k < name.numbers.size(); ++k) seen[k].insert(name.numbers[k]);
  }
  std::vector<Numbered> numbered;
  for (const fs::path& file : files) {
    const Name name(file.stem().string());
    const auto& seen = values[likeness(file, name)];
    size_t counter = 0;
    for (size_t k = 0; k < seen.size(); ++k) {
      if (seen[k].size() >= seen[counter].size()) counter = k;
    }
    Numbered result{file, -1, file.parent_path().string(), ""};
    for (size_t k = 0; k < name.words.size(); ++k) {
      result.key += name.words[k];
      if (k < name.numbers.size()) result.key += k == counter ? "#" : name.numbers[k];
    }
    if (name.numbers.empty()) {
      result.key = "*";  // names without numbers: all of a folder belong together
    } else if (name.numbers[counter].size() < 10) {
      result.number = std::stoi(name.numbers[counter]);
    }
    numbered.push_back(std::move(result));
  }
  return numbered;
}

std::vector<std::string> CameraNames(const std::vector<std::pair<std::string, std::string>>& keys) {
  std::vector<std::vector<std::string>> words;
  for (const auto& [folder, key] : keys) {
    words.push_back(WordsOf(keys.size() > 1 ? folder + "/" + key : key));
  }
  const auto is_common = [&](const std::string& word) {
    return keys.size() > 1 && std::all_of(words.begin(), words.end(), [&](const auto& others) {
             return std::find(others.begin(), others.end(), word) != others.end();
           });
  };
  std::vector<std::string> names;
  for (const auto& own : words) {
    std::string name;
    for (const std::string& word : own) {
      if (!is_common(word)) name += (name.empty() ? "" : "_") + word;
    }
    if (name.empty()) name = keys.size() > 1 ? fmt::format("camera{}", names.size()) : "camera";
    while (std::find(names.begin(), names.end(), name) != names.end()) name += "_";
    names.push_back(name);
  }
  return names;
}

}  // namespace softforce::vision
