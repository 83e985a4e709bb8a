// Tests of a modality that is defined in its own folder only, in a running cluster.
#include <signal.h>

#include <nlohmann/json.hpp>
#include <tactus/modality_report_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/pair_report_t.hpp>
#include <tactus/sync_report_t.hpp>

#include "tests/cluster/support/profiles.h"
#include "tests/cluster/support/run_script.h"

using namespace tactus;
using namespace tactus::cluster;
using nlohmann::json;

namespace {

// Waits until each of these modalities has presented the given number of new events.
bool wait_for_presentations(RunningCluster& c, const std::vector<std::string>& modalities, const PresentedEvents& before,
              std::size_t events) {
  return c.monitor.wait_until(
      [&] {
        return std::all_of(modalities.begin(), modalities.end(),
                           [&](const std::string& m) { return delays_ms(c.monitor, m, before).size() >= events; });
      },
      kTimeout_s);
}

const std::vector<std::string> kOthers{"haptic", "audio", "visual", "thermal"};

}  // namespace

TEST_CASE(
    "A sixth modality joins a running cluster: health, report and summary contain it, with expected "
    "events and asynchronies") {
  RunningCluster c;
  auto& reports = c.monitor.bus().queue<sync_report_t>(channels::kSyncReport, 256);
  c.processes.start("recorder");
  c.start();
  const auto before = c.rates(2);
  c.processes.start("wind_node");
  const bool joined = c.monitor.wait_until([&] { return c.is_running("wind_node"); }, kTimeout_s);
  INFO(c.processes.output("wind_node"));
  REQUIRE(joined);
  CHECK(c.monitor.newest_health("wind_node").modality == "wind");
  CHECK(c.monitor.newest_health("wind_node").expected_events == node_health_t::EXPECTS_HIT);

  modality_report_t latest{};
  std::set<std::string> paired_with;
  const auto reported = [&] {
    while (const auto m = reports.pop()) {
      for (const modality_report_t& r : m->message.modalities)
        if (r.modality == "wind") latest = r;
      for (const pair_report_t& p : m->message.pairs)
        if (p.b == "wind" && p.n > 0) paired_with.insert(p.a);
    }
    return latest.presented >= 5 && paired_with.size() == kOthers.size();
  };
  CHECK(c.monitor.wait_until(reported, kTimeout_s));
  INFO("presented " << latest.presented << " of " << latest.expected << ", with " << paired_with.size() << " others");
  CHECK(latest.lost == 0);

  // The other nodes keep their rates.
  c.check_rates_hold(before, 2);
  for (const auto& [node, rate] : before) CHECK(c.monitor.wait_until([&, node = node] { return c.is_running(node); }, kTimeout_s));
  for (const char* node : {"wind_node", "recorder"}) {
    c.processes.signal(node, SIGTERM);
    CHECK(c.processes.wait_for_exit(node, kTimeout_s) == 0);
  }
  CHECK(std::filesystem::file_size(c.folder.path() / "wind.csv") > 1000);
  c.processes.spawn("summarise", {programs() / "summarise", c.folder.path() / "run.lcmlog", "--out",
                                  c.folder.path() / "summary.json"});
  c.processes.wait_for_exit("summarise", kTimeout_s);
  const json summary = json::parse(contents(c.folder.path() / "summary.json"), nullptr, false);
  REQUIRE_FALSE(summary.is_discarded());
  CHECK(summary["contacts"]["by_modality"]["wind"]["presented"] > 0);
  CHECK(summary["contacts"]["by_modality"]["wind"]["lost"] == 0);
  for (const std::string& other : kOthers) {
    INFO(other);
    CHECK(summary["asynchrony_ms"][other + "_wind"]["n"] > 0);
  }
}

TEST_CASE("A profile delays the sixth modality by its 50 ms, and no other modality") {
  RunningCluster c;
  c.start();
  c.processes.start("wind_node");
  REQUIRE(c.monitor.wait_until([&] { return c.is_running("wind_node"); }, kTimeout_s));
  std::vector<std::string> all = kOthers;
  all.push_back("wind");
  request_playout(c, {"asap"});  // otherwise all modalities wait for the slowest
  c.monitor.receive_for(2);
  constexpr std::size_t kEvents = 12;
  const PresentedEvents none = presented_events(c.monitor);
  REQUIRE(wait_for_presentations(c, all, none, kEvents));
  std::map<std::string, double> before;
  for (const std::string& m : all) before[m] = median(delays_ms(c.monitor, m, none));

  CHECK(put_in_force(c, "<degrade modality=\"wind\" delay=\"50ms\"/>").find("wind_node") != std::string::npos);
  c.monitor.receive_for(0.5);  // events in flight
  const PresentedEvents until = presented_events(c.monitor);
  REQUIRE(wait_for_presentations(c, all, until, kEvents));
  REQUIRE(c.monitor.health("wind_node"));
  CHECK(c.monitor.newest_health("wind_node").profile != 0);
  for (const std::string& m : all) {
    const double now = median(delays_ms(c.monitor, m, until));
    INFO(m << " waited " << before[m] << " ms before and " << now << " ms now");
    // A busy machine moves a median by some ticks, but not by half of the delay.
    CHECK(std::abs(now - before[m] - (m == "wind" ? 50 : 0)) < 25);
  }
}
