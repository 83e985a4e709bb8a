// Numbers for events and contacts: unique over restarts, so that receivers discard repetitions by them.
#pragma once

#include "sim_node/model/state_archive.h"
#include "sync/bus/identity.h"

namespace tactus::sim {

class Ids {
 public:
  // Several may give numbers of one incarnation: each every so manieth, from its own on.
  explicit Ids(std::int64_t incarnation, std::int64_t lane = 0, std::int64_t lanes = 1)
      : incarnation_(incarnation), lane_(lane), lanes_(lanes) {}
  std::int64_t fresh() { return sync::prefixed_id(incarnation_, lane_ + lanes_ * next_++); }
  // Whether fresh() has given that number.
  bool issued(std::int64_t id) const {
    const std::int64_t count = id & ((std::int64_t{1} << 40) - 1);
    return count % lanes_ == lane_ && count / lanes_ < next_ && id == sync::prefixed_id(incarnation_, count);
  }
  std::int64_t incarnation() const { return incarnation_; }
  // Another incarnation from here on.
  void restart(std::int64_t incarnation) { *this = Ids(incarnation, lane_, lanes_); }
  // The world goes on in a new life: numbers are counted on, under another name.
  void rename(std::int64_t incarnation) { incarnation_ = incarnation; }
  // What a number given before is called now.
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
