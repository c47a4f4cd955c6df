#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace softforce::serve {

// What readers see of a program at one moment. Nobody changes it once it is published.
struct PageState {
  std::string json;                              // what every reader is sent
  std::map<std::string, std::string> documents;  // more JSON, by name, for those who ask
  std::vector<std::string> pictures;             // JPEG files, likewise
};

// Hands the newest state from one writer to any number of readers. Publishing swaps a pointer: no
// reader, however slow, holds the writer up. Readers miss states rather than wait in line.
class Broadcast {
 public:
  struct Newest {
    uint64_t number = 0;  // 0: nothing was published as yet
    std::shared_ptr<const PageState> state;
  };

  void Publish(std::shared_ptr<const PageState> state);
  Newest Read() const;
  // Waits for a state newer than number `than`, though not for longer; gives the newest one.
  Newest WaitNewer(uint64_t than, std::chrono::milliseconds longest) const;

  // Readers that follow it at the moment.
  int readers() const { return readers_; }
  void AddReader() { ++readers_; }
  void RemoveReader() { --readers_; }

  // Nothing more will come; wakes all who wait.
  void Close();
  bool closed() const { return closed_; }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Newest newest_;
  std::atomic<int> readers_{0};
  std::atomic<bool> closed_{false};
};

}  // namespace softforce::serve
