#pragma once

#include <string>
#include <string_view>

namespace softforce::report {

// A string of JSON that cannot end the element <script> it stands in.
std::string JsonText(const std::string& text);

// Five significant digits; null for what is not known.
std::string JsonNumber(double value);

std::string Base64(std::string_view bytes);

// "[a,b,c]" of what `Text` makes of every item.
template <typename List, typename Text>
std::string JsonList(const List& list, Text&& text) {
  std::string json = "[";
  for (const auto& item : list) {
    if (json.size() > 1) json += ',';
    json += text(item);
  }
  return json + "]";
}

}  // namespace softforce::report
