#include "sim_node/scene/meshes/obj_text.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::sim {
namespace {

constexpr std::string_view kMark = "\xEF\xBB\xBF";
// Words that begin a line of numbers; other lines hold names, which keep their points.
constexpr std::array<std::string_view, 14> kNumbersFollow = {"v", "vt", "vn", "vp", "Ka", "Kd", "Ks", "Ke", "Tf", "Ns", "Ni", "d", "Tr", "illum"};

bool is_space(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Appends the places of the points of a line, which begins at `first`, that need a zero before them.
void find_bare_points(std::string_view line, std::size_t first, std::vector<std::size_t>& places) {
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    if (line[i] != '.' || !is_digit(line[i + 1])) continue;
    const bool is_signed = i > 1 && (line[i - 1] == '-' || line[i - 1] == '+');
    if (is_space(line[i - (is_signed ? 2 : 1)])) places.push_back(first + i);
  }
}

}  // namespace

bool complete_obj_text(std::string& text) {
  const std::string_view all = text;
  const std::size_t start = all.starts_with(kMark) ? kMark.size() : 0;
  std::vector<std::size_t> places;
  for (std::size_t first = start; first < all.size();) {
    const std::size_t end = std::min(all.find_first_of("\r\n", first), all.size() - 1) + 1;
    const std::string_view line = all.substr(first, end - first);
    const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    const std::size_t word = std::min(line.find_first_of(" \t", begin), line.size());
    if (std::ranges::find(kNumbersFollow, line.substr(begin, word - begin)) != kNumbersFollow.end()) find_bare_points(line, first, places);
    first = end;
  }
  if (start == 0 && places.empty()) return false;
  std::string out;
  out.reserve(all.size() + places.size());
  std::size_t done = start;
  for (const std::size_t place : places) {
    out.append(all.substr(done, place - done)) += '0';
    done = place;
  }
  out.append(all.substr(done));
  text = std::move(out);
  return true;
}

}  // namespace tactus::sim
