#include "softforce/serve/token.h"

#include <gtest/gtest.h>

#include <set>

namespace softforce::serve {
namespace {

TEST(Token, Has128BitsInHexadecimal) {
  const std::string token = MakeToken();

  EXPECT_EQ(token.size(), 32);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST(Token, IsAnotherOneEachTime) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(MakeToken());

  EXPECT_EQ(tokens.size(), 100);
}

TEST(Token, IsTheSameOnlyAsItself) {
  EXPECT_TRUE(SameToken("abc", "abc"));
  EXPECT_FALSE(SameToken("abc", "abd"));
  EXPECT_FALSE(SameToken("abc", "ab"));
  EXPECT_FALSE(SameToken("abc", "abcd"));
}

TEST(Token, IsNeverEmpty) { EXPECT_FALSE(SameToken("", "")); }

}  // namespace
}  // namespace softforce::serve
