// Small tables that people write: rooms, layouts of loudspeakers, materials. Pure but for read_small_file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::sync {

// The cells of a line (RFC 4180, section 2, without line breaks inside of cells): one in double quotes may hold
// commas, and a double quote written twice. A byte order mark before and a carriage return behind the line are no
// part of it.
std::vector<std::string> csv_cells(std::string_view line);

// A finite number and nothing else.
std::optional<double> csv_number(std::string_view cell);

// The text of a regular file of at most so many bytes: what has no end (a device, a pipe) is not read. Nothing
// when it is not that or cannot be read.
std::optional<std::string> read_small_file(const std::filesystem::path& file, std::uintmax_t most_bytes);

}  // namespace tactus::sync
