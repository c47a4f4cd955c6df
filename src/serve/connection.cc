#include "serve/connection.h"

#include <sys/poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>

namespace softforce::serve {
namespace {

constexpr std::chrono::milliseconds kSlice{100};  // after which it is looked whether all closes
constexpr size_t kBytesPerMs = 1000;  // that a reader of a large file must take at the least

constexpr size_t kLongestRequest = 32'768;  // bytes, with its headers

}  // namespace

Connection::Connection(int socket, const ConnectionLimits& limits)
    : socket_(socket), limits_(limits), deadline_(Clock::now() + limits.longest_request) {}

bool Connection::Wait(short event, Clock::time_point until) const {
  while (!*limits_.closing) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now());
    if (left.count() <= 0) return false;
    pollfd one{socket_, event, 0};
    const int ready = poll(&one, 1, static_cast<int>(std::min(left, kSlice).count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
  return false;
}

bool Connection::is_readable() const { return at_ < filled_ || Wait(POLLIN, deadline_); }

bool Connection::is_writable() const { return Wait(POLLOUT, Clock::now() + limits_.longest_write); }

ssize_t Connection::read(char* to, size_t size) {
  if (at_ == filled_) {
    if (!Wait(POLLIN, deadline_)) return -1;
    if (received_ > kLongestRequest) return -1;
    const ssize_t got = recv(socket_, buffer_, sizeof buffer_, 0);
    if (got <= 0) return got;
    at_ = 0;
    filled_ = static_cast<size_t>(got);
    received_ += filled_;
  }
  const size_t given = std::min(size, filled_ - at_);
  std::memcpy(to, buffer_ + at_, given);
  at_ += given;
  return static_cast<ssize_t>(given);
}

ssize_t Connection::write(const char* from, size_t size) {
  const Clock::time_point until =
      Clock::now() + limits_.longest_write + std::chrono::milliseconds(size / kBytesPerMs);
  size_t sent = 0;
  while (sent < size) {
    if (!Wait(POLLOUT, until)) return -1;
    const ssize_t taken = send(socket_, from + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (taken < 0 && errno != EAGAIN && errno != EINTR) return -1;
    if (taken > 0) sent += static_cast<size_t>(taken);
  }
  return static_cast<ssize_t>(size);
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip = "127.0.0.1";  // there are no others
  port = 0;
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  get_remote_ip_and_port(ip, port);
}

}  // namespace softforce::serve
