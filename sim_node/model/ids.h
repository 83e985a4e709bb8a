// Ids of events and contacts, unique across restarts, so that receivers can discard repetitions.
#pragma once

#include "sim_node/model/state_archive.h"
#include "sync/bus/identity.h"

namespace tactus::sim {

class Ids {
 public:
  // Several counters may share one incarnation. Each starts at its own lane and advances by the number of lanes.
  explicit Ids(std::int64_t incarnation, std::int64_t lane = 0, std::int64_t lanes = 1)
      : incarnation_(incarnation), lane_(lane), lanes_(lanes) {}
  std::int64_t next_id() { return sync::prefixed_id(incarnation_, lane_ + lanes_ * next_++); }
  // Whether next_id() has returned this id.
  bool issued(std::int64_t id) const {
    const std::int64_t count = id & ((std::int64_t{1} << 40) - 1);
    return count % lanes_ == lane_ && count / lanes_ < next_ && id == sync::prefixed_id(incarnation_, count);
  }
  std::int64_t incarnation() const { return incarnation_; }
  // Starts a new incarnation and restarts the count.
  void restart(std::int64_t incarnation) { *this = Ids(incarnation, lane_, lanes_); }
  // Continues the count under a new incarnation.
  void rename(std::int64_t incarnation) { incarnation_ = incarnation; }
  // The id under the current incarnation of an id issued before.
  std::int64_t renamed(std::int64_t id) const { return sync::prefixed_id(incarnation_, id); }

  void archive(StateArchive& a) {
    a(incarnation_), a(next_);
    a.require(next_ >= 0, "the state holds a number out of range");
  }

 private:
  std::int64_t incarnation_;
  std::int64_t lane_, lanes_;
  std::int64_t next_ = 0;
};

}  // namespace tactus::sim
