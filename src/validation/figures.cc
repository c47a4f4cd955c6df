#include <fmt/format.h>
#include <fmt/os.h>

#include <cmath>

#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"
#include "softforce/validation/paper_figures.h"
#include "softforce/validation/tables.h"

namespace softforce::validation {
namespace {

constexpr double kMilli = 1e3;   // mN of a N
constexpr double kPerMm = 1e-3;  // N/mm of a N/m
constexpr char kCsvName[] = "validation.csv";

using Sizes = std::array<double, 3>;

// Adds what was found with the three sizes of one error.
class Adder {
 public:
  Adder(const InexactCase& inexact, std::vector<Figure>* figures)
      : inexact_(inexact),
        table_(inexact.layout.body == BodyKind::kSheet ? "II" : "III"),
        figures_(figures) {}

  void Alone() {
    Add("none", 0, "least squares", inexact_.alone, NAN);
    Add("none", 0, "remedied", inexact_.remedied_alone.all, NAN);
    Add("none", 0, "remedied, selected", inexact_.remedied_alone.selected, NAN);
  }

  void Three(const char* error, const Sizes& sizes, double unit, const std::string& how,
             const Errors& found, const std::vector<double>& paper) {
    for (size_t i = 0; i < sizes.size(); ++i) {
      Add(error, sizes[i] / unit, how, found[i], paper.empty() ? NAN : paper[i]);
    }
  }

  void Three(const char* error, const Sizes& sizes, double unit, const std::string& how,
             const std::array<ForceErrors, 3>& found, const std::vector<double>& paper) {
    Errors all, selected;
    for (size_t i = 0; i < sizes.size(); ++i) {
      all[i] = found[i].all;
      selected[i] = found[i].selected;
    }
    Three(error, sizes, unit, how, all, paper);
    Three(error, sizes, unit, how + ", selected", selected, paper);
  }

 private:
  void Add(const char* error, double size, const std::string& how, double I_e, double paper) {
    figures_->push_back(
        {table_, inexact_.layout.name, error, size, "I_e", how, kMilli * I_e, paper});
  }

  const InexactCase& inexact_;
  std::string table_;
  std::vector<Figure>* figures_;
};

std::array<ForceErrors, 3> Thrice(const ForceErrors& value) { return {value, value, value}; }

void AddInexact(const InexactCase& c, std::vector<Figure>* figures) {
  const PaperFigures& paper = FiguresOf(c.layout.name);
  constexpr double kKilopascal = 1e3, kMillimetre = 1e-3, kNewton = 1;
  Adder add(c, figures);
  add.Alone();
  add.Three("modulus", kWrongModuli, kKilopascal, "least squares", c.modulus, paper.modulus);
  add.Three("modulus", kWrongModuli, kKilopascal, "remedied", Thrice(c.modulus_remedied),
            paper.modulus);
  add.Three("markers", kMarkerShifts, kMillimetre, "least squares", c.markers, paper.markers);
  add.Three("markers", kMarkerShifts, kMillimetre, "remedied", c.markers_remedied, paper.markers);
  if (c.layout.body == BodyKind::kSheet) return;
  add.Three("markers", kMarkerShifts, kMillimetre, "not tared", c.markers_untared, paper.markers);
  add.Three("tension", kTensionErrors, kNewton, "least squares", c.tension, paper.tension);
  add.Three("tension", kTensionErrors, kNewton, "remedied", Thrice(c.tension_remedied),
            paper.tension);
}

std::string Cell(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

}  // namespace

std::vector<Figure> Figures(const Study& study) {
  std::vector<Figure> figures;
  for (const ExactCase& c : study.exact) {
    const PaperFigures& paper = FiguresOf(c.layout.name);
    const std::string& name = c.layout.name;
    figures.push_back({"I", name, "none", 0, "I_w", "at rest", kPerMm * c.I_w, paper.I_w_per_mm});
    figures.push_back(
        {"I", name, "none", 0, "I_e", "converged", kMilli * c.converged, paper.I_e_mN});
    figures.push_back({"I", name, "none", 0, "I_e", "linear", kMilli * c.linear, paper.I_e_mN});
  }
  for (const InexactCase& c : study.inexact) AddInexact(c, &figures);
  return figures;
}

void PrepareCsv(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw base::InputError(
        "--out", fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
  }
  base::CheckCanWrite(folder / kCsvName);
}

std::filesystem::path WriteCsv(const std::filesystem::path& folder, const Study& study) {
  PrepareCsv(folder);
  base::PendingFile file(folder / kCsvName);
  {
    fmt::ostream out = fmt::output_file(file.temporary().string());
    out.print("table,layout,error,size,quantity,how,value,paper\n");
    for (const Figure& f : Figures(study)) {
      out.print("{},{},{},{},{},{},{},{}\n", f.table, f.layout, f.error, Cell(f.size), f.quantity,
                f.how, Cell(f.value), Cell(f.paper));
    }
  }
  file.Commit();
  return file.path();
}

}  // namespace softforce::validation
