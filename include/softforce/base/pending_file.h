#pragma once

#include <filesystem>

namespace softforce::base {

// A file that shows up under its name only once it is complete. Write to `temporary()`
// ("forces.partial.csv" beside "forces.csv"), then Commit(), which renames it. If it is destroyed
// before, the temporary is removed and an older file of the same name stays as it was.
class PendingFile {
 public:
  explicit PendingFile(std::filesystem::path path);
  ~PendingFile();
  PendingFile(PendingFile&& other) noexcept;
  PendingFile& operator=(PendingFile&&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  // Throws InputError if the file cannot be renamed (disk full, folder gone).
  void Commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool owns_ = true;
};

// Throws InputError unless a file of this name could be written, for a check before long work.
void CheckCanWrite(const std::filesystem::path& path);

}  // namespace softforce::base
