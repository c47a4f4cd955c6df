#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "commands/commands.h"
#include "commands/write_page.h"
#include "softforce/report/study_page.h"
#include "softforce/validation/study.h"
#include "softforce/validation/tables.h"

namespace softforce::apps {
namespace {

struct ValidateArguments {
  std::string meshes = SOFTFORCE_MESHES_DIR;
  std::string out;
  validation::StudyOptions options;
};

int Validate(ValidateArguments* arguments) {
  arguments->options.meshes = arguments->meshes;
  const std::string page = std::filesystem::path(arguments->out) / "validation.html";
  if (!arguments->out.empty()) {
    validation::PrepareCsv(arguments->out);
    CheckCanWritePage(page);
  }
  const validation::Study study = validation::RunStudy(arguments->options);
  fmt::print("{}", validation::TextTables(study));
  if (!arguments->out.empty()) {
    fmt::print("\nWritten: {}\n", validation::WriteCsv(arguments->out, study).string());
    WritePage(page, report::StudyPage(study));
  }
  return 0;
}

}  // namespace

Command AddValidate(CLI::App* program) {
  auto arguments = std::make_shared<ValidateArguments>();
  validation::StudyOptions& options = arguments->options;
  CLI::App* app = program->add_subcommand(
      "validate", "Repeat the simulated study of the paper, beside the paper's figures");
  app->add_option("--meshes", arguments->meshes,
                  "Folder of sheet.msh, robot.msh and their .geo scripts")
      ->capture_default_str();
  app->add_option(
      "--out", arguments->out,
      "Folder for validation.csv, a line per figure, and validation.html, the same as charts");
  app->add_option("--cases", options.layouts, "Only these of s1 … s8, r1 … r8; default: all")
      ->delimiter(',');
  app->add_option("--frames", options.frames,
                  "Frames in which the loads grow for the paper's linear steps (its sheet was "
                  "sampled at 16 per second)")
      ->capture_default_str();
  app->add_option("--threads", options.threads, "Cases computed at a time")->capture_default_str();
  return {app, [arguments] { return Validate(arguments.get()); }};
}

}  // namespace softforce::apps
