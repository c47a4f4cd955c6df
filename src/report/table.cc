#include "report/table.h"

#include <fmt/format.h>

#include "report/format.h"

namespace softforce::report {

Table::Table(const std::vector<std::string>& heads, size_t words) : words_(words) {
  text_ = "<table>\n";
  if (!heads.empty()) text_ += Row(heads, "th");
}

void Table::Add(const std::vector<std::string>& cells) { text_ += Row(cells, "td"); }

std::string Table::Row(const std::vector<std::string>& cells, const char* tag) const {
  std::string row = "<tr>";
  for (size_t i = 0; i < cells.size(); ++i) {
    row += fmt::format("<{}{}>{}</{}>", tag, i < words_ ? "" : " class=\"number\"",
                       Escape(cells[i]), tag);
  }
  return row + "</tr>\n";
}

}  // namespace softforce::report
