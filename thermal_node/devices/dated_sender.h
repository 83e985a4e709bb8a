// Follows the one sender of an output (sync/clocks/single_sender.h), and judges the dates of its messages: a message that is late,
// or dated ahead, is not used. While two programs send, none of them is right. Pure.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <tactus/header_t.hpp>

#include "sync/clocks/single_sender.h"
#include "sync/time/time.h"

namespace tactus::thermal {

class DatedSender {
 public:
  enum class Result {
    kUse,       // the next message of the followed sender
    kRestart,   // the same, of a sender that is followed from now on
    kOther,     // of another sender: a conflict
    kForeign,   // of another run
    kRepeated,  // an old or an impossible number
    kLate,      // sent longer than `silence` ago
    kAhead,     // sent later than it arrives: the clock of the sender has stepped, or the date is false
  };
  // Design: clocks of one machine agree to less; a message that is sent later than it arrives by more is dated
  // ahead.
  static constexpr sync::Nanoseconds kMaxAhead{10'000'000};

  // silence: without a message for this time the sender is gone, and any other is followed. clock: id of the clock
  // of this process (sync/bus/identity.h); 0: no sender reads the same clock. run_id: as of SingleSender.
  explicit DatedSender(sync::Nanoseconds silence, std::int32_t clock = 0, std::int64_t run_id = sync::SingleSender::kAnyRun)
      : silence_(silence), clock_(clock), run_id_(run_id), sender_(run_id, silence) {}

  // Messages of one output. Use only kUse and kRestart. arrival may step back with the clock of this process. Realtime-safe: yes.
  Result observe(const header_t& header, sync::HostTime arrival);

  // True before the first message, and when the sender is gone.
  bool silent(sync::HostTime now) const { return !recent(used_, now); }
  // Two senders, or a date ahead, within `silence` before now.
  bool conflict(sync::HostTime now) const { return sender_.conflict(now - sync::Nanoseconds(1)); }
  bool ahead(sync::HostTime now) const { return recent(ahead_, now); }
  // False until the sender has been followed for `silence`, without a pause.
  bool trusted(sync::HostTime now) const { return !silent(now) && *used_ - since_ >= silence_; }
  // Number of senders that have been followed.
  std::int64_t followed() const { return followed_; }

 private:
  // The clock of this process may step back, and a message may arrive within a tick.
  bool recent(const std::optional<sync::HostTime>& at, sync::HostTime now) const {
    return at && std::chrono::abs(now - *at) <= silence_;
  }
  // Latency beyond the smallest possible one; negative: dated ahead.
  sync::Nanoseconds lateness(const header_t& header, sync::HostTime arrival);

  sync::Nanoseconds silence_;
  std::int32_t clock_;
  std::int64_t run_id_;
  sync::SingleSender sender_;
  std::int64_t incarnation_ = 0, followed_ = 0;
  std::optional<sync::Nanoseconds> latency_;  // smallest of the sender, with the unknown offset of its clock
  sync::HostTime latency_at_{}, since_{};
  std::optional<sync::HostTime> used_, ahead_;
};

}  // namespace tactus::thermal
