#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <thread>

namespace softforce::vision {

// Brings files and folders to the disk, one after another, on a thread of its own: a disk that is
// busy takes a second for that, in which pictures come all the same.
class DiskSync {
 public:
  DiskSync() : worker_([this] { Work(); }) {}
  ~DiskSync() { Finish(); }

  void Add(const std::filesystem::path& path);
  void Finish();  // waits until all are there; nothing can be added after

 private:
  void Work();

  std::mutex mutex_;
  std::condition_variable more_;
  std::deque<std::filesystem::path> waiting_;
  bool ending_ = false;
  std::thread worker_;
};

}  // namespace softforce::vision
