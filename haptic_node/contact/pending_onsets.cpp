#include "haptic_node/contact/pending_onsets.h"

namespace tactus::haptic {
namespace {

presentation_t report_of(std::int64_t event_id, sync::HostTime scheduled, std::int64_t presented_ns,
                         sync::Nanoseconds uncertainty) {
  presentation_t r{};
  r.event_id = event_id;
  r.part = presentation_t::CONSTRAINT;
  r.scheduled_ns = sync::to_ns(scheduled);
  r.presented_ns = presented_ns;
  r.uncertainty_ns = uncertainty.count();
  r.outcome = presented_ns < 0 ? presentation_t::DROPPED_LATE : presentation_t::PRESENTED;
  return r;
}

}  // namespace

void PendingOnsets::add(std::int64_t event_id, std::int64_t contact_id, sync::HostTime scheduled, sync::HostTime now,
                        std::vector<presentation_t>& reports) {
  if (pending_.size() < kMaxPending)
    pending_.push_back({event_id, contact_id, scheduled, now, std::nullopt});
  else
    reports.push_back(report_of(event_id, scheduled, -1, sync::Nanoseconds(0)));
}

void PendingOnsets::step(const Rendered& rendered, const ContactImpulses& impulses, std::vector<presentation_t>& reports) {
  for (PendingBegin& w : pending_)
    if (!w.known && rendered.surface_known(w.contact_id)) w.known = rendered.now;
  std::erase_if(pending_, [&](const PendingBegin& w) {
    const auto felt = impulses.first_force_time(w.contact_id);
    const sync::Nanoseconds waited = rendered.now - w.received;
    const bool passed = rendered.shown && *rendered.shown - w.scheduled >= kMaxWait;
    const bool over = waited >= kMaxWait && (passed || waited >= kMaxWait + rendered.delay + kMaxModelWait);
    if (!felt && !over) return false;
    const std::optional<sync::HostTime> presented = felt ? felt : w.known;
    reports.push_back(report_of(w.event_id, w.scheduled, presented ? sync::to_ns(*presented) : -1, rendered.uncertainty));
    return true;
  });
}

}  // namespace tactus::haptic
