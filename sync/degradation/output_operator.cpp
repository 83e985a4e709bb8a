#include "sync/degradation/output_operator.h"

#include <algorithm>

namespace tactus::sync {
namespace {

double combined(Combine combine, double a, double b) {
  switch (combine) {
    case Combine::kMin: return std::min(a, b);
    case Combine::kMax: return std::max(a, b);
    case Combine::kSum: return a + b;
    case Combine::kNewest: break;
  }
  return b;
}

}  // namespace

double OutputValues::value(std::string_view name) const {
  for (const Entry& e : entries_)
    if (e.name == name) return e.value;
  return 0;
}

void OutputValues::set(std::string_view name, double value, Combine combine) {
  for (Entry& e : entries_)
    if (e.name == name) {
      e.value = value;
      return;
    }
  entries_.push_back({std::string(name), value, combine});
}

void OutputValues::add(const OutputValues& other) {
  for (const Entry& e : other.entries_) {
    const auto same = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& x) { return x.name == e.name; });
    if (same == entries_.end())
      entries_.push_back(e);
    else
      same->value = combined(e.combine, same->value, e.value);
  }
}

std::vector<std::string> OutputValues::operators() const {
  std::vector<std::string> names;
  for (const Entry& e : entries_)
    if (e.name.find('.') == std::string::npos) names.push_back(e.name);
  return names;
}

}  // namespace tactus::sync
