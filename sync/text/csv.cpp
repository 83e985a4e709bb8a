#include "sync/text/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "sync/sandbox/regular_file.h"

namespace tactus::sync {
namespace {

// A decimal number with a sign, such as -5 or +1.5e-3.
bool is_signed_number(std::string_view text) {
  const auto digits = [&] {
    const std::size_t n = std::min(text.find_first_not_of("0123456789"), text.size());
    text.remove_prefix(n);
    return n > 0;
  };
  const auto take = [&](std::string_view any) {
    const bool found = !text.empty() && any.find(text[0]) != std::string_view::npos;
    if (found) text.remove_prefix(1);
    return found;
  };
  if (!take("+-") || !digits()) return false;
  if (take(".")) digits();
  if (take("eE")) {
    take("+-");
    if (!digits()) return false;
  }
  return text.empty();
}

// Spreadsheets run a cell that begins so as a formula (OWASP, CSV injection), except a number. Apostrophes in front count, so that the
// escape can be undone: scripts/python/tactus/tables.py.
bool is_formula(std::string_view text) {
  const std::size_t at = text.find_first_not_of('\'');
  if (at == std::string_view::npos || at + 1 >= text.size() || std::string_view("=+-@\t\r").find(text[at]) == std::string_view::npos)
    return false;
  return at > 0 || !is_signed_number(text);
}

}  // namespace

std::string csv_cell(std::string_view text) {
  const std::string prefix = is_formula(text) ? "'" : "";
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return prefix + std::string(text);
  std::string cell = "\"" + prefix;
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

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

bool is_blank(const std::vector<std::string>& cells) {
  return std::ranges::all_of(cells, [](const std::string& cell) { return cell.find_first_not_of(" \t\r") == std::string::npos; });
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
