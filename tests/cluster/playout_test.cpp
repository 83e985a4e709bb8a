// Tests of playout policies in a running cluster: changed at run time, and kept when no program repeats them.
#include <algorithm>
#include <cstdlib>

#include "tests/cluster/support/profiles.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

// Asynchronies of a after b, ms, for new hits of the tool; touch by its transient.
std::vector<double> asynchronies_ms(const ClusterMonitor& monitor, const std::string& a, const std::string& b,
                                    const PresentedEvents& before) {
  std::vector<double> out;
  const auto of_a = monitor.presented().find(a), of_b = monitor.presented().find(b);
  if (of_a == monitor.presented().end() || of_b == monitor.presented().end()) return out;
  const auto known = before.find(a);
  for (const auto& [id, r] : of_a->second) {
    const auto other = of_b->second.find(id);
    if (other == of_b->second.end() || r.presented_ns < 0 || other->second.presented_ns < 0) continue;
    if (known != before.end() && known->second.contains(id)) continue;
    out.push_back(static_cast<double>(r.presented_ns - other->second.presented_ns) * 1e-6);
  }
  return out;
}

// Asynchrony over the next seconds, after the delays have been slewed: the median, or a lower quantile, because other work on the machine
// makes pictures late, never early.
double settled_asynchrony_ms(RunningCluster& c, const std::string& a, const std::string& b, double slewed_s, double quantile = 0.1) {
  c.monitor.receive_for(slewed_s);
  const PresentedEvents before = presented_events(c.monitor);
  CHECK(c.monitor.wait_until([&] { return asynchronies_ms(c.monitor, a, b, before).size() >= 5; }, kTimeout_s));
  std::vector<double> sorted = asynchronies_ms(c.monitor, a, b, before);
  std::sort(sorted.begin(), sorted.end());
  return sorted.empty() ? 0 : sorted[static_cast<std::size_t>(quantile * static_cast<double>(sorted.size()))];
}

}  // namespace

TEST_CASE("Sound and picture have the requested SOA, also after a change in the running cluster") {
  RunningCluster c;
  c.start();
  // 100 ms of a base of 200 ms are slewed at 5 % of the time: within 4.5 s.
  CHECK(request_playout(c, {"experiment", "--base", "200ms", "--soa", "audio=-60ms,visual=60ms"}).find("experiment") !=
        std::string::npos);
  const double separated_ms = settled_asynchrony_ms(c, "visual", "audio", 6);
  CHECK(separated_ms > 60);
  CHECK(separated_ms < 240);
  request_playout(c, {"experiment", "--base", "200ms"});
  const double together = settled_asynchrony_ms(c, "visual", "audio", 4);
  CHECK(std::abs(together) < 60);
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}

TEST_CASE(
    "When sync_node is killed the modalities keep the playout policy, and the restarted sync_node "
    "publishes the requested one") {
  RunningCluster c;
  c.start();
  request_playout(c, {"experiment", "--base", "150ms", "--soa", "visual=100ms"});
  const double before = settled_asynchrony_ms(c, "visual", "audio", 6);
  c.processes.kill("sync_node");
  const double alone = settled_asynchrony_ms(c, "visual", "audio", 1);
  CHECK(alone > before / 2);
  CHECK(alone < before * 2);
  c.processes.start("sync_node", {});
  CHECK(c.monitor.wait_until([&] { return c.is_running("sync_node"); }, kTimeout_s));
  const double again = settled_asynchrony_ms(c, "visual", "audio", 2);
  CHECK(again > before / 2);
  CHECK(again < before * 2);
  CHECK(request_playout(c, {}).find("experiment") != std::string::npos);
}

TEST_CASE("In the serial loop of 2005 all modalities render, one after the other") {
  RunningCluster c;
  c.start();
  CHECK(request_playout(c, {"itouch2005"}).find("one loop") != std::string::npos);
  CHECK(settled_asynchrony_ms(c, "visual", "audio", 4, 0.5) > 0);
  CHECK(c.monitor.wait_until([&] { return c.all_running(kNodes); }, kTimeout_s));
}

TEST_CASE("The reported presentation time includes the display latency after the fence, and playout compensates for it") {
  RunningCluster c;
  c.start();
  c.processes.kill("visual_node");
  c.processes.start("visual_node", {"--set", "display_latency=0.2"});
  CHECK(c.monitor.wait_until([&] { return c.is_running("visual_node"); }, kTimeout_s));
  request_playout(c, {"asap"});
  // Without the policy, picture and sound come within one or two frames of each other.
  CHECK(settled_asynchrony_ms(c, "visual", "audio", 2) > 150);
  request_playout(c, {"experiment", "--base", "400ms"});
  CHECK(std::abs(settled_asynchrony_ms(c, "visual", "audio", 10)) < 120);
}
