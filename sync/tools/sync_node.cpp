// sync_node: synchronises clocks with the other hosts, and matches contact events with the presentation reports of each
// modality. One per host. It coordinates; all other nodes run without it.
//
//   in   CLOCK_PROBE                              requests and replies, in a thread of its own
//        CONTACT_EVENTS, NODE_HEALTH, PRESENTED   all of them
//        DEGRADATION, PLAYOUT_REQUEST             the requested profile and policy
//        PLAYOUT                                  of another host's sync_node: only one publishes
//   out  CLOCK_PROBE                              eight requests every 2 s, less often with more than 16 hosts; a reply to
//   each request
//        CLOCK_MAP                                twice a second, less often with more than 16 hosts; one per clock of another host
//        SYNC_REPORT                              once a second
//        DEGRADATION                              again once a second, for late joiners
//        PLAYOUT                                  ten times a second: the presentation delay of each modality
//
// Without replies to its probes, the published uncertainty of its maps grows. Without CONTACT_EVENTS or PRESENTED it only has
// less to report; a modality that falls silent is named in the report.
#include "sync/tools/sync_node.h"

#include <algorithm>
#include <iostream>
#include <optional>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/degraded_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/playout_request_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/sync_report_t.hpp>

#include "sync/clock_sync/clock_map_estimator.h"
#include "sync/clock_sync/clock_probe.h"
#include "sync/degradation/profile_exchange.h"
#include "sync/bus/identity.h"
#include "sync/node/node.h"
#include "sync/playout/coordinator.h"
#include "sync/playout/exchange.h"
#include "sync/playout/options.h"
#include "sync/presentation/presentation_matcher.h"
#include "sync/clock_sync/probe_thread.h"
#include "sync/presentation/sync_report_pages.h"
#include "sync/virtual_time/virtual_time.h"

using namespace tactus;

namespace {

// One second of each at their highest rate.
constexpr std::size_t kEventsQueue = 4096;
constexpr std::size_t kReportsQueue = 4096;
constexpr std::size_t kHealthQueue = 1024;
constexpr sync::Nanoseconds kReportPeriod{1'000'000'000};
// A process that has just started has the maps after this time (design: with the probes' first wave, less than a second in
// all).
constexpr sync::Nanoseconds kMapPeriod{500'000'000};

template <class Message>
void feed(sync::PresentationMatcher& matcher, sync::Queue<Message>& queue) {
  while (const auto received = queue.pop()) matcher.observe(received->message, received->arrival);
}

// For the live table: the number of mapped clocks, and the largest uncertainty.
std::string clock_status_text(const std::vector<clock_map_t>& maps) {
  if (maps.empty()) return "";
  std::int64_t worst_ns = 0;
  for (const clock_map_t& m : maps) worst_ns = std::max(worst_ns, m.uncertainty_ns);
  return std::to_string(maps.size()) + " other clock" + (maps.size() == 1 ? "" : "s") + " known to " +
         std::to_string((worst_ns + 999) / 1000) + " us";
}

// A clock that drifts and jumps once, for tests: these options are not in --help.
struct EmulatedClockOptions {
  double drift_ppm = 0, jump_ms = 0, jump_after_s = 0;

  void add_to(sync::Arguments& app) {
    app.add_option("--emulate-drift", drift_ppm).range(-1000.0, 1000.0).hidden();
    app.add_option("--emulate-jump", jump_ms).hidden();
    app.add_option("--emulate-jump-after", jump_after_s).hidden();
  }
  sync::EmulatedClock clock(sync::HostTime start) const {
    return {drift_ppm * 1e-6, sync::from_seconds(jump_ms * 1e-3), start,
            jump_ms != 0 ? start + sync::from_seconds(jump_after_s) : sync::HostTime::max()};
  }
};

// The profile of the command line, or the one that was in force when an earlier process of this run ended.
std::optional<sync::ProfileInForce> first_profile(const sync::NodeOptions& options, sync::ProfileReceiver& profiles) {
  std::optional<sync::ProfileInForce> profile;
  if (!options.profile.text.empty()) {
    profile = options.profile;
    profiles.set_generation(0);
  }
  if (auto kept = sync::load_profile(options.out, options.run_id)) {
    std::cerr << options.name << ": continues with the profile that was in force before" << std::endl;
    profiles.set_generation(kept->generation);
    profile = std::move(kept);
  }
  return profile;
}

const sync::NodeDescriptor kSyncNode{.name = "sync_node",
                                     .modality = "",
                                     .rate_Hz = 50,  // at least: it wakes on messages
                                     .fifo_priority = 40,
                                     .about = "Synchronises clocks with other hosts; matches contact events with the reports of each sense."};

}  // namespace

int tactus::sync::run_sync_node(int argc, char** argv) try {
  sync::Arguments app;
  sync::NodeOptions options;
  options.add_to(app, kSyncNode);
  EmulatedClockOptions emulated;
  emulated.add_to(app);
  sync::PlayoutOptions playout_options;
  playout_options.add_to(app, true);
  sync::parse_or_exit(app, kSyncNode.name, argc, argv);
  const sync::PlayoutPlan plan = playout_options.plan();

  sync::Node node(kSyncNode, options);
  auto& health = node.bus().queue<node_health_t>(channels::kNodeHealth, kHealthQueue);
  auto& events = node.bus().queue<contact_events_t>(channels::kContactEvents, kEventsQueue);
  auto& presented = node.bus().queue<presented_t>(channels::kPresented, kReportsQueue);
  const sync::HostTime start = sync::host_now();
  const sync::EmulatedClock clock = emulated.clock(start);
  std::cerr << options.name << ": clock " << node.bus().identity().clock << " at " << sync::to_ns(start) << " ns" << std::endl;
  // In virtual time there is one clock, and no host to probe.
  std::optional<sync::ProbeThread> probes;
  if (!sync::VirtualTime::current()) probes.emplace(options.bus, node.bus().identity(), clock);
  sync::ClockMapEstimator map_estimator(node.bus().identity().clock);
  sync::PresentationMatcher matcher(node.bus().clocks());
  auto& degraded = node.bus().queue<degraded_t>(channels::kDegraded, kReportsQueue);
  auto& playouts = node.bus().queue<playout_t>(channels::kPlayout, kHealthQueue);
  auto& requests = node.bus().queue<playout_request_t>(channels::kPlayoutRequest, kHealthQueue);
  sync::PlayoutCoordinator playout(node.bus().identity().clock, plan);
  if (const auto kept = sync::load_request(options.out, options.run_id); kept && playout.push(*kept))
    std::cerr << options.name << ": continues with the policy requested before: " << name_of(playout.plan().policy) << std::endl;
  auto& degradations = node.bus().queue<degradation_t>(channels::kDegradation, kReportsQueue);
  sync::ProfileReceiver profiles;
  std::optional<sync::ProfileInForce> profile = first_profile(node.options(), profiles);
  node.set_state(node_health_t::RUNNING);

  sync::HostTime next_report = start + kReportPeriod, next_maps = start + kMapPeriod;
  while (node.running()) {
    const sync::HostTime now = node.wait_for_event();
    while (const auto wave = probes ? probes->pop() : std::nullopt) map_estimator.add(*wave);
    if (now >= next_maps) {
      std::vector<clock_map_t> maps = map_estimator.maps(clock.read(now));
      // With many hosts each map is published less often, by the same rule as for probes.
      const auto share = std::max<std::int64_t>(1, static_cast<std::int64_t>(maps.size() / sync::ClockProber::kFewClocks));
      next_maps = std::max(next_maps + kMapPeriod * share, now);
      for (clock_map_t& map : maps) node.bus().publish(channels::kClockMap, map);
      node.set_state(node_health_t::RUNNING, clock_status_text(maps));
    }
    feed(matcher, health);
    feed(matcher, events);
    feed(matcher, presented);
    feed(matcher, degraded);
    while (const auto m = degradations.pop())
      if (m->message.header.run_id == options.run_id)
        if (auto newer = profiles.push(m->message)) {
          sync::store_profile(options.out, *newer, options.run_id);
          profile = std::move(newer);
        }
    matcher.advance(now);
    while (const auto m = requests.pop())
      if (m->message.header.run_id == options.run_id && playout.push(m->message)) sync::store_request(options.out, m->message);
    while (const auto m = playouts.pop())
      if (m->message.header.run_id == options.run_id) playout.push(m->message, now), matcher.observe(m->message, m->arrival);
    for (const auto& [modality, waited_for] : matcher.running_modalities()) playout.latency_demand().add_modality(modality, !waited_for);
    for (const auto& need : matcher.take_needs()) playout.latency_demand().add(need.modality, need.needed);
    if (const auto m = playout.next_message(now))
      for (playout_t& page : sync::pages_of(*m)) node.bus().publish(channels::kPlayout, page);
    if (now < next_report) continue;
    next_report = std::max(next_report + kReportPeriod, now);
    for (sync_report_t& page : sync::report_pages(matcher)) node.bus().publish(channels::kSyncReport, page);
    if (profile) sync::send_profile(node.bus(), *profile);
  }
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("sync_node", e);
}
