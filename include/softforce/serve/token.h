#pragma once

#include <string>

namespace softforce::serve {

// 128 random bits of the system's generator, as 32 hexadecimal digits.
std::string MakeToken();

// Whether two tokens are the same, in a time that does not tell how far they agree.
bool SameToken(const std::string& a, const std::string& b);

}  // namespace softforce::serve
