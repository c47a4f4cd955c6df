#include "softforce/serve/token.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>

#include "softforce/base/input_error.h"

namespace softforce::serve {

std::string MakeToken() {
  std::array<unsigned char, 16> bytes{};
  // So few bytes come at once or not at all.
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw base::InputError("--serve", "the system gives no random numbers for the token");
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool SameToken(const std::string& a, const std::string& b) {
  if (a.size() != b.size() || a.empty()) return false;
  unsigned char different = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    different = static_cast<unsigned char>(different | (a[i] ^ b[i]));
  }
  return different == 0;
}

}  // namespace softforce::serve
