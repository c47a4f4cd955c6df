#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>

namespace softforce::serve {

struct ConnectionLimits {
  std::chrono::milliseconds longest_request, longest_write;
  const std::atomic<bool>* closing;  // all fails from then on
};

// An open connection whose request must be complete by a deadline, however steadily its bytes
// trickle in, and each piece of whose answer must be taken within a time.
class Connection : public httplib::Stream {
 public:
  Connection(int socket, const ConnectionLimits& limits);

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* to, size_t size) override;
  ssize_t write(const char* from, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool Wait(short event, Clock::time_point until) const;

  int socket_;
  ConnectionLimits limits_;
  Clock::time_point deadline_;  // of the request
  char buffer_[4096];
  size_t at_ = 0, filled_ = 0;  // of the buffer
  size_t received_ = 0;         // bytes, in all
};

}  // namespace softforce::serve
