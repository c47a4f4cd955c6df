#pragma once

#include <filesystem>
#include <string>

namespace softforce::base {

// The SHA-256 of a file's bytes in lower-case hexadecimal, as `sha256sum` prints it.
// Throws InputError if the file cannot be read.
std::string Sha256OfFile(const std::filesystem::path& path);

}  // namespace softforce::base
