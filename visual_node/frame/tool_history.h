// The recent reports of one tool by time of arrival, for a picture that a profile delays: it shows the tool of the instant
// that it presents. Pure.
#pragma once

#include <cstddef>
#include <deque>
#include <tactus/tool_state_t.hpp>

#include "sync/time/time.h"

namespace tactus::visual {

class ToolHistory {
 public:
  // Stored past beyond the delay in force, so that a delay that begins finds the reports of the time before (design).
  static constexpr sync::Nanoseconds kSpan{1'000'000'000};
  // Reports that arrive closer together replace each other, except at the begin; a picture shows one of them (design).
  static constexpr sync::Nanoseconds kSpacing{1'000'000};
  // Upper limit of the stored reports: 65 s. A picture that is later shows the tool where the simulation holds it.
  static constexpr std::size_t kMaxReports = 1 << 16;

  struct Report {
    sync::HostTime arrival;
    tool_state_t state;  // without constraints
  };

  // delay: that a profile adds to the pictures.
  void extend_history(sync::Nanoseconds delay) { span_ = kSpan + delay; }
  void push(const tool_state_t& state, sync::HostTime arrival) {
    // A log that is replayed from its start begins before the stored reports: they are void.
    while (!reports_.empty() && reports_.back().arrival > arrival) reports_.pop_back();
    const std::size_t count = reports_.size();
    if (count >= 2 && arrival - reports_[count - 2].arrival < kSpacing) reports_.pop_back();
    reports_.push_back({arrival, state});
    reports_.back().state.constraints.clear();
    reports_.back().state.constraint_count = 0;
    while (reports_.size() > kMaxReports || reports_.front().arrival < arrival - span_) reports_.pop_front();
  }
  // Null: none.
  const Report* newest() const { return reports_.empty() ? nullptr : &reports_.back(); }
  // The newest report that had arrived by t; null: none, or it is no longer stored.
  const Report* arrived_by(sync::HostTime t) const {
    for (auto report = reports_.rbegin(); report != reports_.rend(); ++report)
      if (report->arrival <= t) return &*report;
    return nullptr;
  }

 private:
  std::deque<Report> reports_;  // in order of arrival
  sync::Nanoseconds span_ = kSpan;
};

}  // namespace tactus::visual
