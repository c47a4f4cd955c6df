#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace softforce::serve::testing {

// A TCP connection to a port of this machine that sends whatever it is given.
class RawClient {
 public:
  explicit RawClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool connected() const { return connected_; }

  // False once the other side has closed.
  bool Send(const std::string& bytes) {
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes.size());
  }

  void EndSending() { ::shutdown(socket_, SHUT_WR); }

  // Closes so that the other side gets a reset, not an end.
  void Reset() {
    const linger at_once{1, 0};
    setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    ::close(socket_);
    socket_ = -1;
  }

  // Until the other side closes, `enough` shows up, or nothing comes for `seconds`.
  std::string Receive(const std::string& enough = "", int seconds = 20) {
    std::string all;
    char buffer[4096];
    pollfd one{socket_, POLLIN, 0};
    while ((enough.empty() || all.find(enough) == std::string::npos) &&
           ::poll(&one, 1, 1000 * seconds) > 0) {
      const ssize_t got = ::recv(socket_, buffer, sizeof buffer, 0);
      if (got <= 0) {
        closed_ = true;
        break;
      }
      all.append(buffer, static_cast<size_t>(got));
    }
    return all;
  }
  bool closed() const { return closed_; }  // by the other side, as Receive saw

 private:
  int socket_;
  bool connected_ = false, closed_ = false;
};

// What comes back for a whole request.
inline std::string Ask(int port, const std::string& request) {
  RawClient client(port);
  client.Send(request);
  return client.Receive();
}

}  // namespace softforce::serve::testing
