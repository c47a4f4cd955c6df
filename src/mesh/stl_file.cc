#include "mesh/stl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "softforce/base/input_error.h"

namespace softforce::mesh {
namespace {

using base::InputError;

constexpr std::size_t kHeader = 80, kCount = 4, kFacet = 50;  // bytes of a binary file's parts

// Words of a text and the lines that they stand in.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  // Empty at the end.
  std::string_view Next() {
    constexpr std::string_view kSpace = " \t\r\n";
    const std::size_t start = std::min(text_.find_first_not_of(kSpace), text_.size());
    line_ += std::count(text_.begin(), text_.begin() + start, '\n');
    text_.remove_prefix(start);
    const std::string_view word = text_.substr(0, text_.find_first_of(kSpace));
    text_.remove_prefix(word.size());
    return word;
  }
  void SkipLine() { text_.remove_prefix(std::min(text_.find('\n'), text_.size())); }
  std::ptrdiff_t line() const { return line_; }

 private:
  std::string_view text_;
  std::ptrdiff_t line_ = 1;
};

[[noreturn]] void RefuseText(const std::string& where, std::ptrdiff_t line, std::string_view got,
                             const std::string& expected) {
  const std::string_view shown = got.substr(0, 30);
  const bool printable =
      std::all_of(shown.begin(), shown.end(), [](char c) { return c >= ' ' && c <= '~'; });
  throw InputError(where,
                   fmt::format("line {}: got {}, expected {}", line,
                               got.empty()  ? "the end of the file"
                               : !printable ? "binary data"
                                            : fmt::format("\"{}\"", shown),
                               expected),
                   kStlAdvice);
}

std::vector<double> ReadText(const std::string& where, std::string_view text) {
  std::vector<double> coordinates;
  Words words(text);
  const auto expect = [&](const char* expected) {
    const std::string_view word = words.Next();
    if (word != expected) {
      RefuseText(where, words.line(), word, fmt::format("\"{}\"", expected));
    }
  };
  const auto number = [&] {
    std::string_view word = words.Next();
    const std::string_view shown = word;
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument || end != word.data() + word.size()) {
      RefuseText(where, words.line(), shown, "a number");
    }
    return error == std::errc::result_out_of_range ? 0 : value;  // such as 1e-320
  };

  bool closed = true;
  for (std::string_view word = words.Next(); !word.empty(); word = words.Next()) {
    if (word == "solid" && closed) {
      words.SkipLine();  // the name may be of several words
      closed = false;
    } else if (word == "endsolid" && !closed) {
      words.SkipLine();
      closed = true;
    } else if (word == "facet" && !closed) {
      expect("normal");
      for (int i = 0; i < 3; ++i) words.Next();  // not needed, and often zero or nan
      expect("outer");
      expect("loop");
      for (int corner = 0; corner < 3; ++corner) {
        expect("vertex");
        for (int i = 0; i < 3; ++i) coordinates.push_back(number());
      }
      expect("endloop");
      expect("endfacet");
    } else {
      RefuseText(where, words.line(), word, closed ? "\"solid\"" : "\"facet\" or \"endsolid\"");
    }
  }
  if (!closed) RefuseText(where, words.line(), "", "\"facet\" or \"endsolid\": it is cut off");
  return coordinates;
}

std::vector<double> ReadBinary(const std::string& where, const std::string& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader + kCount) std::memcpy(&count, bytes.data() + kHeader, kCount);
  if (bytes.size() < kHeader + kCount + kFacet * std::size_t(count)) {
    throw InputError(
        where,
        fmt::format("its {} bytes are neither STL text nor binary STL, which would "
                    "have {} bytes for the {} triangles that it announces: the file "
                    "is cut off or of another kind",
                    bytes.size(), kHeader + kCount + kFacet * std::size_t(count), count),
        kStlAdvice);
  }
  std::vector<double> coordinates;
  coordinates.reserve(9 * std::size_t(count));
  for (std::size_t facet = 0; facet < count; ++facet) {
    float corners[9];  // after the normal's three numbers
    std::memcpy(corners, bytes.data() + kHeader + kCount + kFacet * facet + 12, sizeof corners);
    coordinates.insert(coordinates.end(), std::begin(corners), std::end(corners));
  }
  return coordinates;
}

// Binary files may begin with "solid" as well: their size tells them.
bool IsText(const std::string& bytes) {
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  if (start == std::string::npos || bytes.compare(start, 5, "solid") != 0) return false;
  std::uint32_t count = 0;
  if (bytes.size() < kHeader + kCount) return true;
  std::memcpy(&count, bytes.data() + kHeader, kCount);
  return bytes.size() != kHeader + kCount + kFacet * std::size_t(count);
}

}  // namespace

Eigen::Matrix3Xd ReadStlCorners(const std::filesystem::path& path) {
  const std::string where = path.string();
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw InputError(where, "cannot be read", "Check the file's permissions.");

  const std::vector<double> numbers =
      IsText(bytes) ? ReadText(where, bytes) : ReadBinary(where, bytes);
  if (numbers.empty()) throw InputError(where, "has no triangles", kStlAdvice);
  const Eigen::Matrix3Xd corners =
      Eigen::Matrix3Xd::Map(numbers.data(), 3, static_cast<Eigen::Index>(numbers.size() / 3));
  for (Eigen::Index i = 0; i < corners.cols(); ++i) {
    if (corners.col(i).allFinite()) continue;
    throw InputError(where, fmt::format("triangle {} has a corner that is not finite", i / 3 + 1),
                     kStlAdvice);
  }
  return corners;
}

}  // namespace softforce::mesh
