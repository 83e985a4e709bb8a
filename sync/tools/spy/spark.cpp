#include "sync/tools/spy/spark.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::sync::spy {

void Spark::add(double value, HostTime at) {
  if (!std::isfinite(value)) return;
  const std::int64_t column = number(at);
  if (!columns_.empty() && column <= columns_.back().number) {
    columns_.back().value = value;
    return;
  }
  columns_.push_back({column, value});
  if (columns_.size() > kMax) columns_.pop_front();
}

Spark::Drawn Spark::draw(HostTime now, std::size_t columns) const {
  constexpr std::array marks{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  Drawn out;
  const std::int64_t last = number(now), first = last - static_cast<std::int64_t>(columns) + 1;
  const auto seen = [&](const Column& c) { return c.number >= first && c.number <= last; };
  bool any = false;
  for (const Column& c : columns_) {
    if (!seen(c)) continue;
    out.lowest = any ? std::min(out.lowest, c.value) : c.value;
    out.highest = any ? std::max(out.highest, c.value) : c.value;
    any = true;
  }
  std::int64_t next = first;
  const double range = out.highest - out.lowest;
  for (const Column& c : columns_) {
    if (!seen(c)) continue;
    for (; next < c.number; ++next) out.text += ' ';
    const double share = range > 0 ? (c.value - out.lowest) / range : 0;
    out.text +=
        marks[std::min(marks.size() - 1, static_cast<std::size_t>(share * static_cast<double>(marks.size())))];
    ++next;
  }
  for (; next <= last; ++next) out.text += ' ';
  return out;
}

}  // namespace tactus::sync::spy
