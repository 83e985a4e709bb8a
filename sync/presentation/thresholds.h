// Published thresholds of asynchrony between two modalities: sync/presentation/thresholds.csv, a row per pair, direction and
// source. The sources disagree, so measurements are compared with both the least and the largest threshold of a direction.
// Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sync/presentation/presentation_matcher_soa.h"
#include "sync/time/time.h"

namespace tactus::sync {

struct Threshold {
  std::string earlier, later;  // modalities
  Nanoseconds at{0};
  std::string what, situation, source;
};

const std::vector<Threshold>& published_thresholds();

struct ThresholdRange {
  Nanoseconds least{0}, largest{0};
};
// The range over all sources for one modality presented after the other; nullopt when there is no source.
std::optional<ThresholdRange> thresholds_of(const std::string& earlier, const std::string& later);

// Number of asynchronies of a pair beyond them, to 0.1 ms; -1: no source for either direction.
struct BeyondThresholds {
  std::int64_t least = -1, all = -1;
};
BeyondThresholds count_beyond_thresholds(const std::string& a, const std::string& b, const SoaHistogram& soa);

}  // namespace tactus::sync
