// Parses small hand-written tables: rooms, layouts of loudspeakers, materials; writes cells. Pure, except read_small_file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::sync {

// The cells of a line (RFC 4180, section 2, without line breaks inside of cells): a cell in double quotes may contain commas,
// and a double quote written twice. A leading byte order mark and a trailing carriage return are ignored.
std::vector<std::string> csv_cells(std::string_view line);

// Whether all cells are empty or white space: a blank line, or one of a spreadsheet that holds only separators.
bool is_blank(const std::vector<std::string>& cells);

// One cell of a table (RFC 4180). A text from the bus or from a user that a spreadsheet would run as a formula gets an apostrophe in
// front; scripts/python/tactus/tables.py removes it.
std::string csv_cell(std::string_view text);

// A finite number and nothing else.
std::optional<double> csv_number(std::string_view cell);

// The text of a regular file of at most this number of bytes: endless files (a device, a pipe) are not read. nullopt when it
// is no such file or cannot be read.
std::optional<std::string> read_small_file(const std::filesystem::path& file, std::uintmax_t max_bytes);

}  // namespace tactus::sync
