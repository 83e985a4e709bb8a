#include "sync/presentation/presentation_reporter.h"

#include "sync/bus/bus.h"

#include <tactus/presented_t.hpp>

namespace tactus::sync {
namespace {
constexpr std::size_t kReportsPerMessage = 30;  // of 42 bytes each
}

void PresentationReporter::report(const presentation_t& r) {
  if (pending_.size() >= kMaxPending) {
    pending_.pop_front();
    ++dropped_;
  }
  pending_.push_back({r, {}, false});
}

void PresentationReporter::publish(Bus& bus, HostTime now) {
  presented_t m{};
  m.header.sim_time_ns = -1;
  m.modality = modality_;
  const auto flush = [&] {
    if (m.reports.empty()) return;
    m.count = static_cast<std::int32_t>(m.reports.size());
    bus.publish(channels::kPresented, m);
    m.reports.clear();
  };
  for (Pending& p : pending_) {
    if (p.sent && now - p.first_sent < kRepeatAfter) continue;
    m.reports.push_back(p.report);
    if (m.reports.size() >= kReportsPerMessage) flush();
    // The second transmission is the last: this time marks the report for the clean-up below.
    p.first_sent = p.sent ? HostTime::min() : now;
    p.sent = true;
  }
  flush();
  std::erase_if(pending_, [](const Pending& p) { return p.sent && p.first_sent == HostTime::min(); });
}

}  // namespace tactus::sync
