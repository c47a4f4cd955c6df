#pragma once

#include <sys/types.h>

#include <string>

namespace softforce::testing {

// A port of this computer that nothing listens to.
int FreePort();

// A camera that is served over loopback by the program ffmpeg, which ends with this object. All
// take picture n at the same moment, and paint n into it: see paint_frames.cc.
class CameraServer {
 public:
  // `serve`: what ffmpeg does with the pictures, as "-c:v mjpeg -f mjpeg tcp://…".
  CameraServer(int width, int height, double rate_hz, const std::string& serve,
               double jitter_ms = 0, double drop_share = 0);
  ~CameraServer() { Kill(); }
  CameraServer(const CameraServer&) = delete;
  CameraServer& operator=(const CameraServer&) = delete;

  void Kill();    // at once, by SIGKILL
  void Start();   // again
  void Freeze();  // it stalls, with its connection open
  void Unfreeze();

 private:
  std::string command_;
  pid_t group_ = -1;
};

}  // namespace softforce::testing
