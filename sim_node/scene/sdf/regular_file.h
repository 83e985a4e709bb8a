// Reads a file with an untrusted path: it may be a pipe, a device or larger than memory.
#pragma once

#include <filesystem>

#include "sync/assets/asset.h"

namespace tactus::sim {

// Throws std::runtime_error with one clause unless it is a regular file of at most max_bytes.
void check_regular_file(const std::filesystem::path& file, std::uintmax_t max_bytes);

// Checks the file in the same way, and returns its bytes.
sync::Bytes read_regular_file(const std::filesystem::path& file, std::uintmax_t max_bytes);

}  // namespace tactus::sim
