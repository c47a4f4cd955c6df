#include "serve/connection_threads.h"

#include <system_error>
#include <thread>

#include "softforce/serve/low_priority.h"

namespace softforce::serve {
namespace {

thread_local bool refused_here = false;

}  // namespace

bool ConnectionThreads::refused() { return refused_here; }

void ConnectionThreads::Work(const std::function<void()>& work) {
  RunAtLowestPriority();
  work();
  // Under the lock to the end: who waits for it may destroy this.
  const std::lock_guard<std::mutex> lock(mutex_);
  --active_;
  ended_.notify_all();
}

void ConnectionThreads::enqueue(std::function<void()> work) {
  bool room = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    room = active_ < largest_;
    if (room) ++active_;
  }
  if (room) {
    try {
      std::thread([this, work] { Work(work); }).detach();
      return;
    } catch (const std::system_error&) {  // no more threads are to be had
      const std::lock_guard<std::mutex> lock(mutex_);
      --active_;
    }
  }
  refused_here = true;
  work();
  refused_here = false;
}

void ConnectionThreads::shutdown() {
  std::unique_lock<std::mutex> lock(mutex_);
  ended_.wait(lock, [this] { return active_ == 0; });
}

}  // namespace softforce::serve
