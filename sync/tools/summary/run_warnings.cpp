#include "sync/tools/summary/run_warnings.h"

#include <algorithm>

namespace tactus::sync {

void RunWarnings::observe(const node_health_t& report, HostTime now) {
  if (!nodes_.contains(report.node) && nodes_.size() >= kMaxNodes) return;
  const auto [at, first] = nodes_.try_emplace(report.node);
  Node& node = at->second;
  node.modality = report.modality;
  node.expected_events = report.expected_events;
  node.ready = report.state != node_health_t::WAITING;
  node.reason = report.status_text.substr(0, report.status_text.find(';'));  // a note ends with the scheduling of the process
  count_missed(node, report, first, now);
  if (first && begin_seen_) node.late = true, node.late_reason = "it started later";
  if (!world_seen_ || now - last_world_ > kWorldSilent) return;
  ++node.reports;
  if (report.state != node_health_t::OUTPUT_LOST) return;
  ++node.without_output;
  node.output_reason = node.reason;
}

void RunWarnings::count_missed(Node& node, const node_health_t& report, bool first, HostTime now) {
  const bool again = !first && report.header.incarnation != node.incarnation;
  node.incarnation = report.header.incarnation, node.missed = report.missed_ticks, node.last = now;
  if (!begin_seen_) {
    node.missed_at.fill(node.missed);
    return;
  }
  // A report ends the seconds that are over by less than its own period.
  for (std::size_t second = kSeconds; second > 0 && now - begin_ <= from_seconds(static_cast<double>(second)) + kReport; --second) {
    node.missed_at[second] = node.missed;
    if (again) node.seconds = second - 1;
  }
}

void RunWarnings::observe_world(std::int64_t sim_ns, HostTime now) {
  last_world_ = now;
  if (world_seen_) return;
  world_seen_ = true;
  begin_seen_ = sim_ns <= kBeginWithin_ns;
  if (!begin_seen_) return;
  begin_ = now;
  for (auto& [name, node] : nodes_) node.missed_at.fill(node.missed);
  for (auto& [name, node] : nodes_)
    if (!node.ready) node.late = true, node.late_reason = node.reason;
}

std::map<std::string, std::vector<std::int64_t>> RunWarnings::missed_by_second() const {
  std::map<std::string, std::vector<std::int64_t>> missed;
  if (!begin_seen_) return missed;
  for (const auto& [name, node] : nodes_)
    for (std::size_t i = 0; i < node.seconds; ++i) {
      if (i > 0 && node.last - begin_ < from_seconds(static_cast<double>(i + 1)) - kReport) break;
      missed[name].push_back(std::max<std::int64_t>(0, node.missed_at[i + 1] - node.missed_at[i]));
    }
  return missed;
}

std::vector<std::string> RunWarnings::sentences(const PresentationMatcher& matcher) const {
  std::vector<std::string> out;
  std::map<std::string, std::int32_t> expected;  // by modality
  for (const auto& [name, node] : nodes_) {
    if (node.modality.empty()) continue;
    expected[node.modality] |= node.expected_events;
    if (node.late)
      out.push_back(name + " was not ready when the world began (" + node.late_reason + "); it missed the first events");
    if (node.without_output > 0)
      out.push_back(name + " had no output in " + std::to_string(node.without_output) + " of " + std::to_string(node.reports) +
                    " reports (" + node.output_reason + "); its events in that time count as dead");
  }
  for (const auto& [modality, kinds] : expected) {
    if ((kinds & node_health_t::EXPECTS_OWN_TOOL_ONLY) != 0) continue;  // its events depend on the hand
    const std::int64_t events = ((kinds & node_health_t::EXPECTS_BEGIN) != 0 ? matcher.begins() : 0) +
                                ((kinds & node_health_t::EXPECTS_HIT) != 0 ? matcher.hits() : 0);
    const auto tally = matcher.modalities().find(modality);
    const OutcomeCounts counts = tally == matcher.modalities().end() ? OutcomeCounts{} : tally->second;
    if (events == 0 || counts.presented > 0 || counts.dropped_by_profile > 0) continue;
    out.push_back(modality + " presented none of the " + std::to_string(events) +
                  " events that it presents when it works; its output of this run is empty. Read the log of its node");
  }
  return out;
}

}  // namespace tactus::sync
