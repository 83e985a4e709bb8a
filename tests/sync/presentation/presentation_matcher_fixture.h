// Messages of a simulated cluster for tests of PresentationMatcher; times are ms since a fixed host time.
#pragma once

#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>
#include <vector>

#include "sync/presentation/presentation_matcher.h"
#include "tests/sync/support/memory_sink.h"

namespace tactus::sync {

inline constexpr int kHit = node_health_t::EXPECTS_HIT;
inline constexpr int kBoth = int{node_health_t::EXPECTS_BEGIN} | int{node_health_t::EXPECTS_HIT};

struct MatcherFixture {
  static constexpr std::int64_t kRun = 7;
  static constexpr std::int64_t kBase = 1'000'000'000'000;
  PresentationMatcher matcher{kRun};
  std::int64_t sim_incarnation = 100;

  static HostTime at(double ms) { return host_time(kBase + static_cast<std::int64_t>(ms * 1e6)); }

  static node_health_t health_message(const std::string& node, const std::string& modality, int owes, double ms,
                                      std::int64_t incarnation = 1, std::int8_t state = node_health_t::RUNNING,
                                      int tool = -1) {
    node_health_t m{};
    m.header = header_of(node, incarnation, 0, to_ns(at(ms)), kRun);
    m.node = node;
    m.modality = modality;
    m.expected_events = owes;
    m.state = state;
    m.tool = tool;
    return m;
  }
  void health(const std::string& node, const std::string& modality, int owes, double ms, std::int64_t incarnation = 1,
              std::int8_t state = node_health_t::RUNNING, int tool = -1) {
    matcher.observe(health_message(node, modality, owes, ms, incarnation, state, tool), at(ms));
  }
  // Ten healths per second in from .. to.
  void healths(const std::string& node, const std::string& modality, int owes, double from, double to,
               std::int64_t incarnation = 1, std::int8_t state = node_health_t::RUNNING, int tool = -1) {
    for (double ms = from; ms <= to; ms += 100) health(node, modality, owes, ms, incarnation, state, tool);
  }

  static contact_events_t event_message(std::int64_t id, double ms, int kind, std::int64_t incarnation, int tool = -1) {
    contact_events_t m{};
    m.header = header_of("sim_node", incarnation, 0, to_ns(at(ms + 1)), kRun);
    m.clock.host_ns = kBase;
    m.clock.rate = 1;
    m.pages = 1;
    contact_event_t e{};
    e.event_id = id;
    e.kind = static_cast<std::int8_t>(kind);
    e.time_ns = static_cast<std::int64_t>(ms * 1e6);
    e.tool = tool;
    e.normal.z = 1;
    e.effective_mass_kg = 1;
    m.events = {e};
    m.count = 1;
    return m;
  }
  void event(std::int64_t id, double ms, int kind = contact_event_t::HIT, int tool = -1) {
    matcher.observe(event_message(id, ms, kind, sim_incarnation, tool), at(ms + 1));
  }

  static presented_t presented_message(const std::string& node, const std::string& modality, std::int64_t id,
                                       double presented_ms, std::int8_t outcome = presentation_t::PRESENTED,
                                       std::int8_t part = presentation_t::WHOLE) {
    presented_t m{};
    m.header = header_of(node, 1, 0, to_ns(at(presented_ms)), kRun);
    m.modality = modality;
    presentation_t p{};
    p.event_id = id;
    p.part = part;
    p.outcome = outcome;
    p.presented_ns = to_ns(at(presented_ms));
    m.reports = {p};
    m.count = 1;
    return m;
  }
  void presented(const std::string& node, const std::string& modality, std::int64_t id, double presented_ms,
                 std::int8_t outcome = presentation_t::PRESENTED, std::int8_t part = presentation_t::WHOLE) {
    matcher.observe(presented_message(node, modality, id, presented_ms, outcome, part), at(presented_ms + 1));
  }

  OutcomeCounts tally(const std::string& modality) const {
    const auto it = matcher.modalities().find(modality);
    return it == matcher.modalities().end() ? OutcomeCounts{} : it->second;
  }
};

inline std::int64_t sum(const OutcomeCounts& t) {
  return t.presented + t.lost + t.stalled + t.dead + t.dropped_by_profile + t.dropped_late;
}

}  // namespace tactus::sync
