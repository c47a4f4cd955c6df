#include "vision/live_servers.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <sstream>

namespace softforce::testing {

int FreePort() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof address;
  bind(socket, reinterpret_cast<sockaddr*>(&address), length);
  getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length);
  close(socket);
  return ntohs(address.sin_port);
}

CameraServer::CameraServer(int width, int height, double rate_hz, const std::string& serve,
                           double jitter_ms, double drop_share) {
  std::ostringstream command;
  command << "'" << SOFTFORCE_PAINT_FRAMES << "' " << width << " " << height << " " << rate_hz
          << " " << jitter_ms << " " << drop_share
          << " | ffmpeg -nostdin -loglevel error -probesize 32 -analyzeduration 0 -f nut -i - "
             "-fps_mode passthrough -flush_packets 1 -threads 1 "
          << serve << " 2>/dev/null";
  command_ = command.str();
  Start();
}

void CameraServer::Start() {
  group_ = fork();
  if (group_ != 0) return;
  setpgid(0, 0);
  execl("/bin/sh", "sh", "-c", command_.c_str(), nullptr);
  _exit(127);
}

void CameraServer::Kill() {
  if (group_ <= 0) return;
  setpgid(group_, group_);  // in case the child has not come to it
  kill(-group_, SIGKILL);
  waitpid(group_, nullptr, 0);
  group_ = -1;
}

void CameraServer::Freeze() { kill(-group_, SIGSTOP); }
void CameraServer::Unfreeze() { kill(-group_, SIGCONT); }

}  // namespace softforce::testing
