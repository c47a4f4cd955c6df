#include <fmt/format.h>

#include <memory>
#include <string>
#include <variant>

#include "commands/commands.h"
#include "softforce/base/entries.h"
#include "softforce/base/quantity.h"
#include "softforce/printing/target.h"

namespace softforce::apps {
namespace {

struct TargetArguments {
  std::string kind, out, orientation = "best", margin = "5 mm";
  printing::SheetOptions options;
};

int Target(const TargetArguments& arguments) {
  printing::SheetOptions options = arguments.options;
  options.orientation = printing::ParseOrientation(arguments.orientation);
  options.margin =
      base::ParseQuantity(arguments.margin, base::Dimension::kLength, 1, "--margin")[0];
  const printing::Target target = printing::ParseTarget(arguments.kind);
  const printing::Sheet sheet = printing::DrawTarget(target, options);
  std::string out = arguments.out;
  if (out.empty()) {
    const std::string text = printing::TextOf(target);
    out = text.substr(0, text.find(':')) + ".pdf";
  }
  printing::WriteSheet(out, sheet);
  fmt::print("{}\n", printing::TextOf(target));
  fmt::print(
      "Written: {}, {:.4g} x {:.4g} mm. Print it at 100 % (\"actual size\", no fitting to the "
      "page), then measure its ruler.\n",
      out, 1e3 * sheet.width, 1e3 * sheet.height);
  if (const auto* board = std::get_if<printing::BoardTarget>(&target)) {
    fmt::print("Then: softforce calibrate INPUTS --board {} -o rig.yaml\n", board->board.Text());
  }
  return 0;
}

}  // namespace

Command AddTarget(CLI::App* program) {
  auto arguments = std::make_shared<TargetArguments>();
  CLI::App* app = program->add_subcommand(
      "target", "Print calibration boards, tags and body markers in true size (PDF, SVG)");
  app->add_option("kind", arguments->kind,
                  "chessboard, charuco, aprilgrid, circles, tags or markers, with sizes as below")
      ->required();
  app->add_option("-o,--out", arguments->out,
                  "File to write, .pdf or .svg; default: the kind with .pdf");
  app->add_option("--paper", arguments->options.paper, "A4, A3 or Letter")->capture_default_str();
  app->add_option("--orientation", arguments->orientation,
                  "portrait, landscape, or best: whichever the target fits on")
      ->capture_default_str();
  app->add_option("--margin", arguments->margin, "What the printer leaves white along each edge")
      ->capture_default_str();
  app->footer(printing::kTargetHelp);
  return {app, [arguments] { return Target(*arguments); }};
}

}  // namespace softforce::apps
