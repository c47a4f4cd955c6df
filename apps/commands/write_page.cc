#include "commands/write_page.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "softforce/base/input_error.h"
#include "softforce/base/pending_file.h"

namespace softforce::apps {

void CheckCanWritePage(const std::string& file) {
  if (std::filesystem::path(file).extension() != ".html") {
    throw base::InputError(file, "is no name of a page", "Let it end in .html.");
  }
  base::CheckCanWrite(file);
}

void WritePage(const std::string& file, const std::string& html) {
  base::PendingFile pending(file);
  std::ofstream stream(pending.temporary(), std::ios::binary);
  stream << html;
  stream.close();
  if (!stream) throw base::InputError(file, "cannot be written", "Is the disk full?");
  pending.Commit();
  fmt::print("Written: {}\n", file);
}

}  // namespace softforce::apps
