// How a value was obtained: a result says how good it is instead of falling back in silence.
#pragma once

#include <cstdint>

namespace tactus::sync {

enum class SampleStatus : std::int8_t {
  kNone = 0,      // nothing has arrived yet
  kExact,         // a sample of just this instant
  kInterpolated,  // between two samples
  kExtrapolated,  // past the newest sample, by no more than the bound
  kHeld,          // the newest sample, past the bound
  kStale,         // the newest sample, so old that it should not be relied on
};

const char* to_string(SampleStatus);

template <class T>
struct Sample {
  T value{};
  SampleStatus status = SampleStatus::kNone;
};

}  // namespace tactus::sync
