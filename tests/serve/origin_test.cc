#include "serve/origin.h"

#include <gtest/gtest.h>

namespace softforce::serve {
namespace {

TEST(Origin, HostMustBeThisMachineAndPort) {
  EXPECT_TRUE(IsOwnHost("127.0.0.1:8080", 8080));
  EXPECT_TRUE(IsOwnHost("localhost:8080", 8080));
  EXPECT_FALSE(IsOwnHost("localhost:8081", 8080));
  EXPECT_FALSE(IsOwnHost("localhost", 8080));
  EXPECT_FALSE(IsOwnHost("", 8080));
  EXPECT_FALSE(IsOwnHost("evil.example:8080", 8080));
  EXPECT_FALSE(IsOwnHost("127.0.0.1.evil.example:8080", 8080));
}

TEST(Origin, PortOfHttpMayBeLeftOut) { EXPECT_TRUE(IsOwnHost("localhost", 80)); }

TEST(Origin, OtherSitesAreRefused) {
  EXPECT_TRUE(IsOwnOrigin("", 8080));
  EXPECT_TRUE(IsOwnOrigin("http://localhost:8080", 8080));
  EXPECT_FALSE(IsOwnOrigin("http://evil.example", 8080));
  EXPECT_FALSE(IsOwnOrigin("https://localhost:8080", 8080));
  EXPECT_FALSE(IsOwnOrigin("null", 8080));
}

}  // namespace
}  // namespace softforce::serve
