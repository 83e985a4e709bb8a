#include "lcmtypes/spelling_suggestions.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace tactus {
namespace {

constexpr std::size_t kMax = 5;
constexpr std::size_t kMaxCompared = 64;  // limit of the compared text: names are not longer

std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, changed}));
    }
  }
  return row.back();
}

}  // namespace

std::string spelling_suggestions(std::string_view written, const std::vector<std::string>& names) {
  written = written.substr(0, kMaxCompared);
  std::vector<std::pair<std::size_t, std::string_view>> near;
  for (const std::string& name : names) {
    const bool holds = !written.empty() && name.find(written) != std::string::npos;
    near.emplace_back(holds ? 0 : distance(written, std::string_view(name).substr(0, kMaxCompared)), name);
  }
  std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  near.resize(std::min(near.size(), kMax));
  std::string text;
  for (std::size_t i = 0; i < near.size(); ++i)
    text += (i == 0 ? "" : i + 1 == near.size() ? " or " : ", ") + std::string(near[i].second);
  return text;
}

}  // namespace tactus
