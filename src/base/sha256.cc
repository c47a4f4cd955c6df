#include "softforce/base/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cassert>
#include <cerrno>
#include <fstream>
#include <memory>
#include <system_error>

#include "softforce/base/input_error.h"

namespace softforce::base {

std::string Sha256OfFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(path.string(), "cannot be read: " + std::generic_category().message(errno));
  }

  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(),
                                                                        &EVP_MD_CTX_free);
  bool ok = EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  std::array<char, 1 << 16> block;
  while (file) {
    file.read(block.data(), block.size());
    ok = ok && EVP_DigestUpdate(context.get(), block.data(), file.gcount()) == 1;
  }
  if (file.bad()) throw InputError(path.string(), "cannot be read to its end; is it a folder?");

  std::array<unsigned char, 32> digest;
  ok = ok && EVP_DigestFinal_ex(context.get(), digest.data(), nullptr) == 1;
  if (!ok) throw std::runtime_error("OpenSSL cannot compute SHA-256");
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace softforce::base
