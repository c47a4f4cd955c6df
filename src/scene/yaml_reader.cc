#include "scene/yaml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "softforce/base/input_error.h"

namespace softforce::scene {

namespace fs = std::filesystem;
using base::Dimension;
using base::InputError;

namespace {

bool IsFile(const fs::path& path) {
  std::error_code ignored;  // a path that cannot be looked at is no file to us
  return fs::is_regular_file(path, ignored);
}

std::string Contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw InputError(file.string(), "cannot be read", "Check that you may read it.");
  // OpenCV's first line is "%YAML:1.0", which no version of YAML allows.
  if (text.rfind("%YAML:", 0) == 0) text.erase(0, std::min(text.find('\n'), text.size()));
  return text;
}

}  // namespace

YamlValue::YamlValue(YAML::Node node, fs::path file, int line, std::string key_path)
    : node_(std::move(node)), file_(std::move(file)), line_(line), key_path_(std::move(key_path)) {}

YamlValue YamlValue::FromFile(const fs::path& file) {
  if (!IsFile(file)) throw InputError(file.string(), "there is no such file");
  try {
    return YamlValue(YAML::Load(Contents(file)), file, 1, "");
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}", file.string(), error.mark.line + 1),
                     "is not valid YAML: " + error.msg,
                     "Often the cause is the indentation, a missing \": \" or an open bracket.");
  }
}

YamlValue YamlValue::Child(const YAML::Node& node, const std::string& key_path) const {
  return YamlValue(node, file_, node.Mark().is_null() ? line_ : node.Mark().line + 1, key_path);
}

std::string YamlValue::where() const {
  return fmt::format("{}:{}{}{}", file_.string(), line_, key_path_.empty() ? "" : ": ", key_path_);
}

void YamlValue::Fail(const std::string& problem, const std::string& advice) const {
  throw InputError(where(), problem, advice);
}

std::string YamlValue::Found() const {
  if (node_.IsScalar()) return fmt::format("\"{}\"", node_.Scalar());
  if (node_.IsSequence()) return "a list";
  return node_.IsMap() ? "a map" : "nothing";
}

std::string YamlValue::Scalar(const std::string& expected) const {
  if (!node_.IsScalar()) Fail("got " + Found() + ", " + expected);
  return node_.Scalar();
}

std::string YamlValue::Text() const {
  const std::string text = Scalar("expected a text");
  if (text.empty()) Fail("got an empty text, expected some letters");
  return text;
}

int YamlValue::Integer(int at_least) const {
  const std::string expected = fmt::format("expected a whole number, at least {}", at_least);
  const std::string text = Scalar(expected);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < at_least) {
    Fail("got " + Found() + ", " + expected);
  }
  return number;
}

double YamlValue::Number() const {
  return base::ParseQuantity(Scalar("expected a number"), Dimension::kNumber, 1, where())[0];
}

std::vector<double> YamlValue::Numbers(const std::vector<int>& counts) const {
  std::vector<double> numbers;
  for (const YamlValue& item : Items(counts)) numbers.push_back(item.Number());
  return numbers;
}

double YamlValue::Quantity(Dimension dimension) const {
  const std::string text = Scalar("expected a number and its unit");
  return base::ParseQuantity(text, dimension, 1, where())[0];
}

double YamlValue::PositiveQuantity(Dimension dimension) const {
  const double quantity = Quantity(dimension);
  if (quantity <= 0) Fail("got " + Found() + ", expected more than 0");
  return quantity;
}

Eigen::Vector3d YamlValue::Vector(Dimension dimension) const {
  const std::string text = Scalar("expected three numbers and their unit in one text, without [ ]");
  return Eigen::Vector3d(base::ParseQuantity(text, dimension, 3, where()).data());
}

fs::path YamlValue::Path() const {
  return (fs::absolute(file_).parent_path() / Text()).lexically_normal();
}

fs::path YamlValue::ExistingFile() const {
  const fs::path path = Path();
  if (!IsFile(path)) {
    Fail("there is no file " + path.string(),
         "Paths are relative to the folder of " + file_.filename().string() + ", or absolute.");
  }
  return path;
}

std::vector<YamlValue> YamlValue::Items(const std::vector<int>& counts) const {
  if (!IsList()) Fail("got " + Found() + ", expected a list");
  std::vector<YamlValue> items;
  for (const YAML::Node& item : node_) {
    items.push_back(Child(item, fmt::format("{}[{}]", key_path_, items.size())));
  }
  if (!counts.empty() && std::count(counts.begin(), counts.end(), items.size()) == 0) {
    Fail(fmt::format("got {} items, expected {}", items.size(), fmt::join(counts, " or ")));
  }
  return items;
}

void YamlValue::RefuseEmptyList(const std::string& advice) const {
  if (Items().empty()) Fail("got an empty list, expected at least one item", advice);
}

YamlMap::YamlMap(const YamlValue& value) : value_(value) {
  if (!value.IsMap()) value.Fail("got " + value.Found() + ", expected keys with values");
  for (const auto& entry : value.node_) {
    if (!entry.first.IsScalar()) value.Fail("got a key that is no text");
    const std::string key = entry.first.Scalar();
    YamlValue child =
        value.Child(entry.second, value.key_path_ + (value.key_path_.empty() ? "" : ": ") + key);
    child.line_ = entry.first.Mark().line + 1;  // the value of an alias stands elsewhere
    const std::vector<std::string> earlier = Keys();
    if (std::count(earlier.begin(), earlier.end(), key) > 0) {
      child.Fail("the key is given twice, expected once");
    }
    entries_.emplace_back(key, std::move(child));
  }
}

std::optional<YamlValue> YamlMap::Optional(const std::string& key) {
  asked_.insert(key);
  for (const auto& [name, value] : entries_) {
    if (name == key) return value;
  }
  return std::nullopt;
}

YamlValue YamlMap::Required(const std::string& key, const std::string& why) {
  if (const std::optional<YamlValue> value = Optional(key)) return *value;
  // The likeliest cause is a slip in a key that nobody has asked for.
  if (const std::optional<std::string> slip = Nearest(key, UnaskedKeys())) {
    Optional(*slip)->Fail(fmt::format("unknown key, expected \"{}\", which is missing", key),
                          fmt::format("Did you mean \"{}\"?", key));
  }
  const std::string got = entries_.empty() ? "none" : "only " + Join(Keys());
  value_.Fail(fmt::format("missing key \"{}\", got {}", key, got), why);
}

std::vector<std::string> YamlMap::Keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : entries_) keys.push_back(key);
  return keys;
}

std::vector<std::string> YamlMap::UnaskedKeys() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : entries_) {
    if (asked_.count(key) == 0) keys.push_back(key);
  }
  return keys;
}

void YamlMap::RefuseOtherKeys() const {
  const std::vector<std::string> known(asked_.begin(), asked_.end());
  for (const auto& [key, value] : entries_) {
    if (asked_.count(key) > 0) continue;
    value.Fail("unknown key, expected one of " + Join(known), DidYouMean(key, known));
  }
}

void CheckFormatVersion(YamlMap& root) {
  const YamlValue version =
      root.Required("softforce", fmt::format("Begin the file with: softforce: {}", kFormatVersion));
  const int got = version.Integer(1);
  if (got != kFormatVersion) {
    version.Fail(fmt::format("got format version {}, expected {}", got, kFormatVersion),
                 "Use the version of softforce that the file was written for.");
  }
}

}  // namespace softforce::scene
