#include "sync/resampling/sample_status.h"

namespace tactus::sync {

const char* to_string(SampleStatus status) {
  switch (status) {
    case SampleStatus::kNone: return "none";
    case SampleStatus::kExact: return "exact";
    case SampleStatus::kInterpolated: return "interpolated";
    case SampleStatus::kExtrapolated: return "extrapolated";
    case SampleStatus::kHeld: return "held";
    case SampleStatus::kStale: return "stale";
  }
  return "none";
}

}  // namespace tactus::sync
