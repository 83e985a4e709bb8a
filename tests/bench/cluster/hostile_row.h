// A cluster in virtual time that receives hostile messages on chosen channels, one a millisecond on each.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/cluster/hostile_source.h"
#include "tests/bench/cluster/output_limits.h"

namespace tactus::bench {

// Outputs of the cluster that are compared with those of an undisturbed one.
inline constexpr unsigned kWorld = 1, kTouch = 2, kWarmth = 4, kSound = 8, kAllOutputs = kWorld | kTouch | kWarmth | kSound;

struct HostileRow {
  const char* name;
  std::vector<std::string> channels;
  Hostility kind = Hostility::kMalformed;
  unsigned same = 0;  // outputs that do not change, to the bit
  bool returns = true;  // the hand feels a force again when the hostile messages have ended
  bool alone = false;   // all genuine messages of these channels are lost meanwhile
};
std::vector<HostileRow> hostile_rows();

// Hashes of all outputs until the hostile messages end, by output, and of the whole sound file.
using Hashes = std::map<unsigned, std::int64_t>;

struct HostileResult {
  std::int64_t ticks = 0, messages = 0;
  Hashes hashes;
  double peak_N = 0, dose_s = 0, cold_s = 0;
  double growth_kB = 0;  // of the allocated memory, from the median of the second quarter to that of the last
  std::string faults;    // limits that were passed, in words; empty: none
};

// Runs one row for this number of milliseconds. hostile: false: the same cluster for the same time, undisturbed. Throws
// std::runtime_error with one sentence when the cluster does not come up or a program ends.
HostileResult run_row(const HostileRow& row, int milliseconds, unsigned seed, bool hostile);

}  // namespace tactus::bench
