#pragma once

#include <string>
#include <vector>

namespace softforce::report {

// A table for an HTML page whose columns after the first `words` are numbers.
class Table {
 public:
  Table(const std::vector<std::string>& heads, size_t words);

  void Add(const std::vector<std::string>& cells);  // texts, not HTML
  std::string str() const { return text_ + "</table>\n"; }

 private:
  std::string Row(const std::vector<std::string>& cells, const char* tag) const;

  std::string text_;
  size_t words_;
};

}  // namespace softforce::report
