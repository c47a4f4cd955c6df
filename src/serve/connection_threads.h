#pragma once

#include <httplib.h>

#include <condition_variable>
#include <mutex>

namespace softforce::serve {

// A thread of lowest priority for every connection, and no more than so many at a time. What comes
// beyond is worked off by the caller, with refused() saying so.
class ConnectionThreads : public httplib::TaskQueue {
 public:
  explicit ConnectionThreads(int largest) : largest_(largest) {}

  void enqueue(std::function<void()> work) override;
  void shutdown() override;  // waits for all

  // Whether the calling thread works off what there was no thread for.
  static bool refused();

 private:
  void Work(const std::function<void()>& work);

  const int largest_;
  int active_ = 0;
  std::mutex mutex_;
  std::condition_variable ended_;
};

}  // namespace softforce::serve
