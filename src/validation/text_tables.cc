#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "softforce/validation/tables.h"

namespace softforce::validation {
namespace {

constexpr int kLabel = 40;  // characters
constexpr int kCell = 9;

std::string Number(double value) {
  if (!std::isfinite(value)) return "-";
  if (value != 0 && std::abs(value) < 1e-2) return fmt::format("{:.0e}", value);
  return fmt::format(std::abs(value) < 10 ? "{:.2f}" : "{:.1f}", value);
}

// A row of figures of one kind, one for each layout of a table.
struct Row {
  std::string error, how;
  double size;
  std::vector<const Figure*> cells;
};

std::vector<Row> RowsOf(const std::vector<Figure>& figures, const std::string& table, char body) {
  std::vector<Row> rows;
  for (const Figure& figure : figures) {
    if (figure.table != table || figure.layout.front() != body) continue;
    Row* row = nullptr;
    for (Row& known : rows) {
      if (known.error == figure.error && known.how == figure.how && known.size == figure.size) {
        row = &known;
      }
    }
    if (row == nullptr) {
      rows.push_back({figure.error, figure.how, figure.size, {}});
      row = &rows.back();
    }
    row->cells.push_back(&figure);
  }
  return rows;
}

void PrintCells(const std::string& label, const std::vector<std::string>& cells,
                std::string* text) {
  auto out = std::back_inserter(*text);
  fmt::format_to(out, "{:<{}}", label, kLabel);
  for (const std::string& cell : cells) fmt::format_to(out, "{:>{}}", cell, kCell);
  *text += '\n';
}

void PrintRow(const std::string& label, const Row& row, double Figure::*value, std::string* text) {
  std::vector<std::string> cells;
  for (const Figure* figure : row.cells) cells.push_back(Number(figure->*value));
  PrintCells(label, cells, text);
}

void PrintHead(const std::string& title, const Row& row, std::string* text) {
  std::vector<std::string> names;
  for (const Figure* figure : row.cells) names.push_back(figure->layout);
  PrintCells(title, names, text);
}

std::string LabelOf(const Row& row) {
  if (row.error == "modulus") return fmt::format("A  E = {:.0f} kPa", row.size);
  if (row.error == "markers") return fmt::format("B  markers {:.2f} mm off along z", row.size);
  if (row.error == "tension") return fmt::format("C  tension {:.2f} N off", row.size);
  return "nothing wrong but the discretisation";
}

void PrintExact(const std::vector<Figure>& figures, char body, std::string* text) {
  const std::vector<Row> rows = RowsOf(figures, "I", body);
  if (rows.empty()) return;
  PrintHead(fmt::format("Table I, {}", body == 's' ? "soft sheet" : "soft robot"), rows[0], text);
  PrintRow("I_w, N/mm: paper", rows[0], &Figure::paper, text);
  PrintRow("           ours", rows[0], &Figure::value, text);
  PrintRow("I_e, mN:   paper", rows[1], &Figure::paper, text);
  PrintRow("           ours, linear steps", rows[2], &Figure::value, text);
  PrintRow("           ours, converged", rows[1], &Figure::value, text);
  *text += '\n';
}

// The rows of one error stand together: those of the same size, the paper's first.
void PrintInexact(const std::vector<Figure>& figures, const std::string& table, std::string* text) {
  const std::vector<Row> rows = RowsOf(figures, table, table == "II" ? 's' : 'r');
  if (rows.empty()) return;
  PrintHead(fmt::format("Table {}, I_e in mN", table), rows[0], text);
  for (const Row& first : rows) {
    if (first.how != "least squares") continue;
    *text += LabelOf(first) + '\n';
    if (first.error != "none") PrintRow("     paper", first, &Figure::paper, text);
    for (const Row& row : rows) {
      if (row.error != first.error || row.size != first.size) continue;
      PrintRow("     ours, " + row.how, row, &Figure::value, text);
    }
  }
  *text += '\n';
}

}  // namespace

std::string TextTables(const Study& study) {
  const std::vector<Figure> figures = Figures(study);
  std::string text;
  PrintExact(figures, 's', &text);
  PrintExact(figures, 'r', &text);
  PrintInexact(figures, "II", &text);
  PrintInexact(figures, "III", &text);
  for (const Study::BodyMeshes& meshes : study.meshes) {
    text += fmt::format(
        "{}: least squares on {} cells, remedied on {}, truth of Tables II and III on {}\n",
        Name(meshes.body), meshes.given, meshes.inverse, meshes.truth);
  }
  for (const InexactCase& c : study.inexact) {
    text += fmt::format("{}: Young's modulus as identified with the remedied model {:.2f} kPa\n",
                        c.layout.name, 1e-3 * c.youngs_modulus);
  }
  return text;
}

}  // namespace softforce::validation
