#include "serve/origin.h"

namespace softforce::serve {

bool IsOwnHost(const std::string& host, int port) {
  const std::string end = ":" + std::to_string(port);
  for (const char* const name : {"127.0.0.1", "localhost"}) {
    if (host == name + end) return true;
    if (port == 80 && host == name) return true;  // browsers leave it out
  }
  return false;
}

bool IsOwnOrigin(const std::string& origin, int port) {
  const std::string scheme = "http://";
  if (origin.empty()) return true;
  return origin.rfind(scheme, 0) == 0 && IsOwnHost(origin.substr(scheme.size()), port);
}

}  // namespace softforce::serve
