#include "vision/disk_sync.h"

#include "vision/segment_writer.h"

namespace softforce::vision {

void DiskSync::Add(const std::filesystem::path& path) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(path);
  }
  more_.notify_one();
}

void DiskSync::Finish() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  more_.notify_one();
  if (worker_.joinable()) worker_.join();
}

void DiskSync::Work() {
  while (true) {
    std::filesystem::path next;
    {
      std::unique_lock lock(mutex_);
      more_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      next = std::move(waiting_.front());
      waiting_.pop_front();
    }
    SyncToDisk(next);
  }
}

}  // namespace softforce::vision
