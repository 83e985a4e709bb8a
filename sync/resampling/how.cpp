#include "sync/resampling/how.h"

namespace tactus::sync {

const char* to_string(How how) {
  switch (how) {
    case How::kNone: return "none";
    case How::kExact: return "exact";
    case How::kInterpolated: return "interpolated";
    case How::kExtrapolated: return "extrapolated";
    case How::kHeld: return "held";
    case How::kStale: return "stale";
  }
  return "none";
}

}  // namespace tactus::sync
