#include "sync/text/csv.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "sync/sandbox/regular_file.h"

namespace tactus::sync {

std::vector<std::string> csv_cells(std::string_view line) {
  if (constexpr std::string_view kMark = "\xef\xbb\xbf"; line.starts_with(kMark)) line.remove_prefix(kMark.size());
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

std::optional<double> csv_number(std::string_view cell) {
  double value = 0;
  const char* end = cell.data() + cell.size();
  const auto read = std::from_chars(cell.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::string> read_small_file(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  try {
    return read_regular_text(file, max_bytes);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

}  // namespace tactus::sync
