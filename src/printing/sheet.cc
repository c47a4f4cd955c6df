#include "softforce/printing/sheet.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <regex>
#include <sstream>

#include "softforce/base/entries.h"
#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"

namespace softforce::printing {
namespace {

constexpr double kPointsPerMetre = 72 / 0.0254;

using Surface = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;
using Context = std::unique_ptr<cairo_t, void (*)(cairo_t*)>;

Surface OpenSurface(const std::filesystem::path& file, const std::string& ending,
                    const Sheet& sheet) {
  const double width = sheet.width * kPointsPerMetre, height = sheet.height * kPointsPerMetre;
  if (ending == ".svg") {
    // In points, which Cairo writes as "pt": browsers and printers keep the size.
    Surface surface(cairo_svg_surface_create(file.c_str(), width, height), cairo_surface_destroy);
    cairo_svg_surface_restrict_to_version(surface.get(), CAIRO_SVG_VERSION_1_2);
    return surface;
  }
  Surface surface(cairo_pdf_surface_create(file.c_str(), width, height), cairo_surface_destroy);
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, sheet.title.c_str());
  // Cairo would write the present: the same sheet shall give the same bytes.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                 "2000-01-01T00:00:00Z");
  return surface;
}

void DrawText(cairo_t* cairo, const Sheet::Text& text) {
  cairo_set_font_size(cairo, text.size);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo, text.text.c_str(), &extents);
  if (extents.x_advance > text.max_width) {
    cairo_set_font_size(cairo, text.size * text.max_width / extents.x_advance);
    cairo_text_extents(cairo, text.text.c_str(), &extents);
  }
  const double shift = text.anchor == Sheet::Text::Anchor::kMiddle ? 0.5 * extents.x_advance : 0;
  cairo_move_to(cairo, text.at.x() - shift, text.at.y());
  cairo_show_text(cairo, text.text.c_str());
}

void Draw(cairo_t* cairo, const Sheet& sheet) {
  cairo_scale(cairo, kPointsPerMetre, kPointsPerMetre);
  cairo_set_source_rgb(cairo, 0, 0, 0);
  for (const Eigen::AlignedBox2d& box : sheet.black) {
    cairo_rectangle(cairo, box.min().x(), box.min().y(), box.sizes().x(), box.sizes().y());
  }
  cairo_fill(cairo);
  for (const Sheet::Disc& disc : sheet.discs) {
    const double grey = disc.white ? 1 : 0;
    cairo_set_source_rgb(cairo, grey, grey, grey);
    cairo_arc(cairo, disc.centre.x(), disc.centre.y(), 0.5 * disc.diameter, 0, 2 * M_PI);
    cairo_fill(cairo);
  }
  for (const Sheet::Line& line : sheet.lines) {
    const double grey = line.light ? 0.7 : 0;
    cairo_set_source_rgb(cairo, grey, grey, grey);
    cairo_set_line_width(cairo, line.width);
    cairo_move_to(cairo, line.from.x(), line.from.y());
    cairo_line_to(cairo, line.to.x(), line.to.y());
    cairo_stroke(cairo);
  }
  cairo_set_source_rgb(cairo, 0, 0, 0);
  cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  for (const Sheet::Text& text : sheet.texts) DrawText(cairo, text);
}

// Cairo numbers its surfaces through the life of the program, and writes the number into the file.
void DropSurfaceNumber(const std::filesystem::path& svg) {
  std::ostringstream text;
  text << std::ifstream(svg).rdbuf();
  static const std::regex kNumber("id=\"surface[0-9]+\"");
  const std::string same = std::regex_replace(text.str(), kNumber, "id=\"sheet\"");
  std::ofstream(svg) << same;
}

}  // namespace

void WriteSheet(const std::filesystem::path& file, const Sheet& sheet) {
  const std::string ending = base::LowerCase(file.extension().string());
  if (ending != ".pdf" && ending != ".svg") {
    throw base::InputError(file.string(), "must end in .pdf or .svg",
                           "The ending chooses the kind of file.");
  }
  base::CheckCanWrite(file);
  base::PendingFile pending(file);
  const Surface surface = OpenSurface(pending.temporary(), ending, sheet);
  {
    const Context cairo(cairo_create(surface.get()), cairo_destroy);
    Draw(cairo.get(), sheet);
    cairo_show_page(cairo.get());
  }
  cairo_surface_finish(surface.get());
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS) {
    throw base::InputError(file.string(),
                           fmt::format("cannot be written: {}", cairo_status_to_string(status)));
  }
  if (ending == ".svg") DropSurfaceNumber(pending.temporary());
  pending.Commit();
}

}  // namespace softforce::printing
