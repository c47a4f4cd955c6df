#include "softforce/base/sha256.h"

#include <gtest/gtest.h>

#include <fstream>

#include "softforce/base/input_error.h"

namespace softforce::base {
namespace {

std::filesystem::path WriteFile(const std::string& name, const std::string& bytes) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

// The expected digests are those that coreutils' sha256sum prints for the same bytes.
TEST(Sha256OfFile, AgreesWithSha256sum) {
  EXPECT_EQ(Sha256OfFile(WriteFile("sha256_short", "softforce\n")),
            "506d5a87611fc13cbc56be282168ae6402826e532a96888088003d5dea1f1ceb");
}

TEST(Sha256OfFile, HashesAnEmptyFile) {
  EXPECT_EQ(Sha256OfFile(WriteFile("sha256_empty", "")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Sha256OfFile, HashesAFileLongerThanOneBlock) {
  EXPECT_EQ(Sha256OfFile(WriteFile("sha256_long", std::string(200000, 'x'))),
            "91e3faafd322bcdf160f3f0ce886acb092b9b9e2a1e8526b40f21a8898a8700b");
}

TEST(Sha256OfFile, RefusesAMissingFile) { EXPECT_THROW(Sha256OfFile("no/such/file"), InputError); }

TEST(Sha256OfFile, RefusesAFolder) { EXPECT_THROW(Sha256OfFile(testing::TempDir()), InputError); }

}  // namespace
}  // namespace softforce::base
