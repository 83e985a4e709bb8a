#include "sync/presentation/thresholds.h"

#include <algorithm>
#include <sstream>

#include "sync/text/csv.h"
#include "sync/thresholds.gen.h"

namespace tactus::sync {
namespace {

std::vector<Threshold> read() {
  std::vector<Threshold> rows;
  std::istringstream lines(kThresholdsCsv);
  std::string line;
  std::getline(lines, line);  // names of the columns
  while (std::getline(lines, line)) {
    const auto f = csv_cells(line);
    if (f.size() == 6) rows.push_back({f[0], f[1], from_seconds(std::stod(f[2]) * 1e-3), f[3], f[4], f[5]});
  }
  return rows;
}

}  // namespace

const std::vector<Threshold>& published_thresholds() {
  static const std::vector<Threshold> rows = read();
  return rows;
}

std::optional<ThresholdRange> thresholds_of(const std::string& earlier, const std::string& later) {
  std::optional<ThresholdRange> range;
  for (const Threshold& t : published_thresholds()) {
    if (t.earlier != earlier || t.later != later) continue;
    if (!range) range = {t.at, t.at};
    range->least = std::min(range->least, t.at);
    range->largest = std::max(range->largest, t.at);
  }
  return range;
}

BeyondThresholds count_beyond_thresholds(const std::string& a, const std::string& b, const SoaHistogram& soa) {
  // The push and the vibration of touch belong to the same modality.
  const auto modality = [](const std::string& name) { return name.substr(0, name.rfind("_push")); };
  const auto after = thresholds_of(modality(a), modality(b)), before = thresholds_of(modality(b), modality(a));
  if (!after && !before) return {};
  const auto count = [&](auto limit) {
    return soa.beyond(before ? limit(*before) : SoaHistogram::kWideRange,
                      after ? limit(*after) : SoaHistogram::kWideRange);
  };
  return {count([](const ThresholdRange& r) { return r.least; }),
          count([](const ThresholdRange& r) { return r.largest; })};
}

}  // namespace tactus::sync
