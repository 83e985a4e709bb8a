#include "scripts/live/feed.h"

#include <algorithm>
#include <tactus/contact_event_t.hpp>
#include <tactus/input_health_t.hpp>
#include <tactus/modality_report_t.hpp>
#include <tactus/pair_report_t.hpp>
#include <tactus/presentation_t.hpp>

#include "sync/bus/decode.h"
#include "sync/text/printable.h"

namespace tactus::live {
namespace {

using nlohmann::json;

constexpr sync::Nanoseconds kHealthPeriod{250'000'000};  // design: faster than a user reads
constexpr sync::Nanoseconds kLostAfter{1'500'000'000};   // as in watch

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

bool Feed::accepts(std::string_view channel) {
  return channel == channels::kNodeHealth || channel == channels::kSyncReport || channel == channels::kContactEvents ||
         channel == channels::kPresented;
}

void Feed::on_message(std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival) {
  if (channel == channels::kNodeHealth) {
    if (const auto m = sync::decode<node_health_t>(bytes.data(), bytes.size())) on_message(*m, arrival);
  } else if (channel == channels::kSyncReport) {
    if (const auto m = sync::decode<sync_report_t>(bytes.data(), bytes.size())) on_message(*m);
  } else if (channel == channels::kContactEvents) {
    if (const auto m = sync::decode<contact_events_t>(bytes.data(), bytes.size())) on_message(*m);
  } else if (channel == channels::kPresented) {
    if (const auto m = sync::decode<presented_t>(bytes.data(), bytes.size())) on_message(*m);
  }
}

void Feed::on_message(const node_health_t& m, sync::HostTime arrival) {
  if (is_own_run(m.header) && (nodes_.contains(m.node) || nodes_.size() < kMaxNodes)) nodes_[m.node] = {m, arrival};
}

void Feed::on_message(const contact_events_t& m) {
  if (!is_own_run(m.header)) return;
  event_clock_ = m.header.clock;
  for (const contact_event_t& e : m.events) {
    if (event_host_ns_.find(e.event_id)) continue;
    const sync::TimeMap map{sync::sim_time(m.clock.sim_ns), sync::host_time(m.clock.host_ns), m.clock.rate};
    const std::int64_t host_ns = sync::to_ns(map.to_host(sync::sim_time(e.time_ns)));
    event_host_ns_.try_emplace(e.event_id, host_ns);
    if (events_.size() < kMaxPerFrame)
      events_.push_back({seconds(host_ns), e.kind, e.body_a, e.body_b, e.approach_speed_m_s});
    else
      ++dropped_events_;
  }
}

void Feed::on_message(const presented_t& m) {
  if (!is_own_run(m.header)) return;
  for (const presentation_t& p : m.reports) {
    if (!presented_.try_emplace({p.event_id, m.modality, static_cast<int>(p.part)}).second) continue;
    if (presentations_.size() >= kMaxPerFrame) {
      ++dropped_events_;
      continue;
    }
    // Times of two clocks are not compared: such a presentation is drawn at its event, without a latency.
    const std::int64_t* event_ns = event_host_ns_.find(p.event_id);
    const bool comparable = p.presented_ns >= 0 && m.header.clock == event_clock_;
    const std::int64_t at_ns = comparable ? p.presented_ns : event_ns ? *event_ns : m.header.publish_time_ns;
    json latency_ms = nullptr;
    if (comparable && event_ns) latency_ms = seconds(p.presented_ns - *event_ns) * 1e3;
    presentations_.push_back({seconds(at_ns), m.modality, p.part, p.outcome, latency_ms});
  }
}

void Feed::on_message(const sync_report_t& m) {
  if (!is_own_run(m.header)) return;
  for (const modality_report_t& r : m.modalities)
    if (modalities_.contains(r.modality) || modalities_.size() < kMaxModalities) modalities_[r.modality] = r;
  for (const pair_report_t& r : m.pairs)
    if (pairs_.contains({r.a, r.b}) || pairs_.size() < kMaxModalities * kMaxModalities) pairs_[{r.a, r.b}] = r;
  report_new_ = true;
}

void Feed::clear() { *this = Feed(run_id_); }

json Feed::health(sync::HostTime now) const {
  json out = json::array();
  for (const auto& [name, n] : nodes_) {
    const node_health_t& h = n.health;
    std::int64_t gaps = 0;
    for (const input_health_t& i : h.inputs) gaps += i.gaps;
    out.push_back({{"node", sync::printable(name)}, {"source", h.header.source}, {"modality", sync::printable(h.modality)}, {"state", h.state},
                   {"lost", now - n.arrival > kLostAfter}, {"note", sync::printable(h.status_text)}, {"rate_Hz", h.rate_Hz},
                   {"nominal_Hz", h.nominal_rate_Hz}, {"missed", h.missed_ticks}, {"ticks", h.ticks},
                   {"rendered", h.contacts_rendered}, {"profile", std::to_string(h.profile)},
                   {"realtime", h.realtime_factor}, {"gaps", gaps}, {"tick_max_us", seconds(h.tick.max_ns) * 1e6},
                   {"wake_max_us", seconds(h.wake.max_ns) * 1e6}});
  }
  return out;
}

json Feed::report() const {
  json senses = json::array(), pairs = json::array();
  for (const auto& [name, r] : modalities_)
    senses.push_back({{"modality", sync::printable(name)}, {"expected", r.expected}, {"presented", r.presented}, {"lost", r.lost},
                      {"dropped", r.dropped_by_profile}, {"late", r.dropped_late}});
  for (const auto& [key, r] : pairs_)
    pairs.push_back({{"a", sync::printable(r.a)}, {"b", sync::printable(r.b)}, {"n", r.n}, {"p05_ms", seconds(r.p05_ns) * 1e3},
                     {"p50_ms", seconds(r.p50_ns) * 1e3}, {"p95_ms", seconds(r.p95_ns) * 1e3}, {"beyond_least", r.beyond_least}});
  return {{"senses", senses}, {"pairs", pairs}};
}

json Feed::take_changes(sync::HostTime now) {
  json out = json::object();
  if (!events_.empty()) out["events"] = std::exchange(events_, json::array());
  if (!presentations_.empty()) out["presented"] = std::exchange(presentations_, json::array());
  if (dropped_events_ > 0) out["left_out"] = dropped_events_;
  if (!last_health_ || now - *last_health_ >= kHealthPeriod || now < *last_health_) {
    last_health_ = now;
    if (!nodes_.empty()) out["health"] = health(now);
  }
  if (std::exchange(report_new_, false)) out["report"] = report();
  return out;
}

json Feed::state(sync::HostTime now) const { return {{"health", health(now)}, {"report", report()}}; }

std::string Feed::node_of(std::int32_t source) const {
  for (const auto& [name, n] : nodes_)
    if (n.health.header.source == source) return name;
  return "";
}

}  // namespace tactus::live
