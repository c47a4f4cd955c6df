#include "softforce/base/entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "softforce/base/input_error.h"

namespace softforce::base {

std::string Trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

Entries::Entries(const std::string& text, std::string where, std::string advice)
    : where_(std::move(where)), advice_(std::move(advice)) {
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const std::string entry = Trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (entry.empty()) continue;
    const size_t equals = entry.find('=');
    const std::string key = LowerCase(Trimmed(entry.substr(0, equals)));
    std::optional<std::string> value;
    if (equals != std::string::npos) value = Trimmed(entry.substr(equals + 1));
    if (!values_.emplace(key, value).second) {
      throw InputError(where_, fmt::format("\"{}\" is given twice", key), advice_);
    }
  }
}

std::string Entries::Take(const std::string& key, const std::string& otherwise) {
  const auto found = values_.find(key);
  if (found == values_.end()) {
    if (!otherwise.empty()) return otherwise;
    throw InputError(where_, fmt::format("\"{}\" is missing", key), advice_);
  }
  if (!found->second || found->second->empty()) {
    throw InputError(where_, fmt::format("\"{}\" has no value", key), advice_);
  }
  const std::string value = *found->second;
  values_.erase(found);
  return value;
}

double Entries::TakeQuantity(const std::string& key, Dimension dimension,
                             const std::string& otherwise) {
  return ParseQuantity(Take(key, otherwise), dimension, 1, where_ + ": " + key)[0];
}

int Entries::TakeCount(const std::string& key, const std::string& otherwise) {
  const std::string text = Take(key, otherwise);
  const std::string where = where_ + ": " + key;
  const double value = ParseQuantity(text, Dimension::kNumber, 1, where)[0];
  if (value >= 0 && value < 1e6 && value == std::floor(value)) return static_cast<int>(value);
  throw InputError(where, fmt::format("got \"{}\", expected a whole number from 0 on", text));
}

bool Entries::TakeFlag(const std::string& key) {
  const auto found = values_.find(key);
  if (found == values_.end()) return false;
  const std::string value = found->second.value_or("true");
  values_.erase(found);
  if (value == "true" || value == "false") return value == "true";
  throw InputError(where_, fmt::format("{}={}: expected true or false", key, value), advice_);
}

void Entries::RefuseRest(const std::string& known) const {
  if (values_.empty()) return;
  throw InputError(
      where_, fmt::format("\"{}\" is no entry here; expected {}", values_.begin()->first, known),
      advice_);
}

}  // namespace softforce::base
