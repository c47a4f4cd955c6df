#include "softforce/serve/broadcast.h"

namespace softforce::serve {

void Broadcast::Publish(std::shared_ptr<const PageState> state) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    // The old one is let go after the lock: it may be the last hold on many bytes.
    newest_.state.swap(state);
    ++newest_.number;
  }
  changed_.notify_all();
}

Broadcast::Newest Broadcast::Read() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return newest_;
}

Broadcast::Newest Broadcast::WaitNewer(uint64_t than, std::chrono::milliseconds longest) const {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, longest, [&] { return newest_.number > than || closed_; });
  return newest_;
}

void Broadcast::Close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

}  // namespace softforce::serve
