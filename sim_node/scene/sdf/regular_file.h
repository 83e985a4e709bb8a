// Reads a file that somebody else named: it may be a pipe, a device or larger than memory.
#pragma once

#include <filesystem>

#include "sync/assets/scene_exchange.h"

namespace tactus::sim {

// Throws std::runtime_error with one clause when it is no regular file, or larger.
void check_regular_file(const std::filesystem::path& file, std::uintmax_t max_bytes);

// As that, and its bytes.
sync::Bytes read_regular_file(const std::filesystem::path& file, std::uintmax_t max_bytes);

}  // namespace tactus::sim
