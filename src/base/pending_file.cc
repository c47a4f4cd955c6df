#include "softforce/base/pending_file.h"

#include <cassert>
#include <fstream>
#include <system_error>
#include <utility>

#include "softforce/base/input_error.h"

namespace softforce::base {

namespace fs = std::filesystem;

PendingFile::PendingFile(fs::path path) : path_(std::move(path)), temporary_(path_) {
  fs::path name = path_.stem();
  name += ".partial";
  name += path_.extension();
  temporary_.replace_filename(name);
}

PendingFile::~PendingFile() {
  std::error_code ignored;  // a leftover is a nuisance, not a reason to end the program
  if (owns_) fs::remove(temporary_, ignored);
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::move(other.temporary_)),
      owns_(std::exchange(other.owns_, false)) {}

void PendingFile::Commit() {
  assert(owns_);
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) {
    throw InputError(
        path_.string(),
        "cannot be written: renaming " + temporary_.string() + " failed (" + error.message() + ")",
        "Check that its folder exists, may be written to, and has room.");
  }
  owns_ = false;
}

void CheckCanWrite(const fs::path& path) {
  std::error_code ignored;  // what cannot be looked at cannot be opened either
  const bool is_folder = fs::is_directory(path, ignored);
  const PendingFile trial(path);  // removed when this ends
  if (!is_folder && std::ofstream(trial.temporary())) return;
  throw InputError(path.string(),
                   is_folder ? "cannot be written: it is a folder" : "cannot be written",
                   "Check that its folder exists and may be written to.");
}

}  // namespace softforce::base
