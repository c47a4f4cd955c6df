#include "scene/text_edits.h"

#include <algorithm>

namespace softforce::scene {
namespace {

constexpr char kByteOrderMark[] = "\xEF\xBB\xBF";

// Whether a text means itself without quotes, also within { } and [ ].
bool IsPlain(const std::string& text) {
  const auto harmless = [](unsigned char c) {
    return std::isalnum(c) || c >= 0x80 ||
           std::string("/._-+ ").find(static_cast<char>(c)) != std::string::npos;
  };
  return !text.empty() && text.front() != ' ' && text.back() != ' ' && text.front() != '-' &&
         std::all_of(text.begin(), text.end(), harmless);
}

std::string Quoted(const std::string& text, char quote) {
  std::string quoted(1, quote);
  for (const char c : text) {
    if (quote == '\'' && c == '\'') quoted += '\'';
    if (quote == '"' && (c == '"' || c == '\\')) quoted += '\\';
    quoted += c;
  }
  return quoted + quote;
}

}  // namespace

TextEdits::TextEdits(std::string text) : text_(std::move(text)) {}

// The parser counts bytes, but not those of a byte order mark.
size_t TextEdits::Position(const YAML::Mark& mark) const {
  const size_t skipped = text_.rfind(kByteOrderMark, 0) == 0 ? 3 : 0;
  return skipped + static_cast<size_t>(mark.pos);
}

std::optional<ScalarPlace> TextEdits::Find(const YAML::Node& scalar) const {
  const std::string& value = scalar.Scalar();
  ScalarPlace place{Position(scalar.Mark()), value.size(), 0};
  if (place.at >= text_.size()) return std::nullopt;
  const char first = text_[place.at];
  if (first == '"' || first == '\'') {
    place.quote = first;
    place.length += 2;
    const size_t closing = place.at + place.length - 1;
    const bool written_out = text_.compare(place.at + 1, value.size(), value) == 0 &&
                             closing < text_.size() && text_[closing] == first;
    return written_out ? std::optional(place) : std::nullopt;
  }
  return text_.compare(place.at, value.size(), value) == 0 ? std::optional(place) : std::nullopt;
}

void TextEdits::Replace(const ScalarPlace& place, const std::string& value) {
  std::string text = value;
  if (place.quote != 0) {
    text = Quoted(value, place.quote);
  } else if (!IsPlain(value)) {
    text = Quoted(value, '"');
  }
  edits_.push_back({place.at, place.length, text});
}

void TextEdits::AddAfter(const YAML::Node& map, const YAML::Node& key, const ScalarPlace& place,
                         const std::string& entry) {
  const size_t end = place.at + place.length;
  if (map.Style() == YAML::EmitterStyle::Flow) {
    edits_.push_back({end, 0, ", " + entry});
    return;
  }
  // A line of its own, after what else is on this one, such as a comment.
  const size_t line_end = std::min(text_.find('\n', end), text_.size());
  const std::string indentation(static_cast<size_t>(key.Mark().column), ' ');
  const bool carriage_return = line_end > 0 && text_[line_end - 1] == '\r';
  if (line_end == text_.size()) {
    edits_.push_back({line_end, 0, "\n" + indentation + entry});
  } else {
    edits_.push_back({line_end + 1, 0, indentation + entry + (carriage_return ? "\r\n" : "\n")});
  }
}

std::string TextEdits::Result() const {
  std::vector<Edit> edits = edits_;
  std::stable_sort(edits.begin(), edits.end(),
                   [](const Edit& a, const Edit& b) { return a.at > b.at; });
  std::string text = text_;
  for (const Edit& edit : edits) text.replace(edit.at, edit.length, edit.text);
  return text;
}

}  // namespace softforce::scene
