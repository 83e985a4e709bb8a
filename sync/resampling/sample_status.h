// The status of a sampled value: exact, interpolated, extrapolated, held or stale.
#pragma once

#include <cstdint>

namespace tactus::sync {

enum class SampleStatus : std::int8_t {
  kNone = 0,      // nothing has arrived yet
  kExact,         // a sample of exactly this instant
  kInterpolated,  // between two samples
  kExtrapolated,  // past the newest sample, within the bound
  kHeld,          // the newest sample, past the bound
  kStale,         // the newest sample, too old to rely on
};

const char* to_string(SampleStatus);

template <class T>
struct Sample {
  T value{};
  SampleStatus status = SampleStatus::kNone;
};

}  // namespace tactus::sync
