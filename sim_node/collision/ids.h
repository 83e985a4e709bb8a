// Numbers for events and contacts: unique over restarts, so that receivers discard repetitions by them.
#pragma once

#include "sync/identity.h"

namespace tactus::sim {

class Ids {
 public:
  explicit Ids(std::int64_t incarnation) : incarnation_(incarnation) {}
  std::int64_t fresh() { return sync::prefixed_id(incarnation_, next_++); }
  // Whether fresh() has given that number.
  bool issued(std::int64_t id) const {
    const std::int64_t count = id & ((std::int64_t{1} << 40) - 1);
    return count < next_ && id == sync::prefixed_id(incarnation_, count);
  }
  // Another incarnation from here on.
  void restart(std::int64_t incarnation) { *this = Ids(incarnation); }

 private:
  std::int64_t incarnation_;
  std::int64_t next_ = 0;
};

}  // namespace tactus::sim
