// Collects the outcomes of a renderer's events and publishes them on PRESENTED, each report twice, so that the loss of one
// datagram loses no report. Bounded: when more than kMaxPending wait, the oldest are dropped and counted.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <tactus/presentation_t.hpp>

#include "sync/time/time.h"

namespace tactus::sync {

class Bus;

class PresentationReporter {
 public:
  static constexpr std::size_t kMaxPending = 1024;
  static constexpr Nanoseconds kRepeatAfter{20'000'000};

  explicit PresentationReporter(std::string modality) : modality_(std::move(modality)) {}

  void report(const presentation_t& report);
  // Call once a tick: publishes new reports and due repetitions, in pages.
  void publish(Bus& bus, HostTime now);
  std::int64_t dropped() const { return dropped_; }

 private:
  struct Pending {
    presentation_t report;
    HostTime first_sent{};
    bool sent = false;
  };
  std::string modality_;
  std::deque<Pending> pending_;
  std::int64_t dropped_ = 0;
};

}  // namespace tactus::sync
