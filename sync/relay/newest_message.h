// Decides which messages of one sender are old: repetitions, and messages that another one has overtaken. Pure.
//
// Only a message whose number and time are both not newer is old. A single message with a number and a time ahead would make all later
// ones old until the true time has passed it. Therefore, old messages that follow one another for `patience` are the true ones.
#pragma once

#include <optional>
#include <tactus/header_t.hpp>

#include "sync/time/time.h"

namespace tactus::sync {

class NewestMessage {
 public:
  // patience: longer than messages on their way overtake one another.
  explicit NewestMessage(Nanoseconds patience) : patience_(patience) {}

  // True for an old message. Any other one becomes the newest. arrival: of the message, ascending.
  bool is_old(const header_t& header, HostTime arrival);
  // The newest message; only after one.
  const header_t& header() const { return *newest_; }
  bool has_one() const { return newest_.has_value(); }

 private:
  // Old messages, each newer than the one before, that arrived since `begin`.
  struct Run {
    HostTime begin{};
    header_t last{};
  };

  Nanoseconds patience_;
  std::optional<header_t> newest_;
  std::optional<Run> run_;
};

}  // namespace tactus::sync
