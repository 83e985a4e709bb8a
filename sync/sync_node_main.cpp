// sync_node: matches contact events with what each sense reports of them. It coordinates; nobody needs it to run.
//
//   in   CONTACT_EVENTS, NODE_HEALTH, PRESENTED   all of them
//        DEGRADATION                              the profile that somebody puts in force
//   out  SYNC_REPORT                              once a second
//        DEGRADATION                              again once a second, for who comes late
//
// Losing CONTACT_EVENTS or PRESENTED only leaves it less to report; a sense that falls silent is named in the report.
#include <CLI/CLI.hpp>
#include <optional>

#include "sync/degradation/profile_exchange.h"
#include "sync/identity.h"
#include "sync/node.h"
#include "sync/presentation_matcher.h"

using namespace tactus;

namespace {

// One second of each at the most that they are sent.
constexpr std::size_t kEventsQueue = 4096;
constexpr std::size_t kReportsQueue = 4096;
constexpr std::size_t kHealthQueue = 1024;
constexpr sync::Nanoseconds kReportPeriod{1'000'000'000};

template <class Message>
void feed(sync::PresentationMatcher& matcher, sync::Queue<Message>& queue) {
  while (const auto received = queue.pop()) matcher.observe(received->message, received->arrival);
}

}  // namespace

int main(int argc, char** argv) try {
  const sync::Declaration declaration{.node = "sync_node",
                                      .modality = "",
                                      .rate_Hz = 50,  // at the least: it wakes when something arrives
                                      .fifo_priority = 40,
                                      .about = "Matches contact events with what each sense reports of them."};
  CLI::App app;
  sync::NodeOptions options;
  options.add_to(app, declaration);
  sync::parse_or_exit(app, declaration.node, argc, argv);

  sync::Node node(declaration, options);
  auto& health = node.bus().queue<node_health_t>(channels::kNodeHealth, kHealthQueue);
  auto& events = node.bus().queue<contact_events_t>(channels::kContactEvents, kEventsQueue);
  auto& presented = node.bus().queue<presented_t>(channels::kPresented, kReportsQueue);
  auto& degradations = node.bus().queue<degradation_t>(channels::kDegradation, kReportsQueue);
  sync::PresentationMatcher matcher(options.run_id);
  sync::ProfileReceiver profiles;
  std::optional<sync::ProfileInForce> profile;
  if (const std::string& text = node.options().profile; !text.empty()) {
    profile = {text, sync::fnv1a_64(text.data(), text.size()), 0, sync::SimTime{}};
    profiles.set_generation(0);
  }
  node.set_state(node_health_t::RUNNING);

  sync::HostTime next_report = sync::host_now() + kReportPeriod;
  while (node.running()) {
    const sync::HostTime now = node.wait_for_event();
    feed(matcher, health);
    feed(matcher, events);
    feed(matcher, presented);
    while (const auto m = degradations.pop())
      if (m->message.header.run_id == options.run_id)
        if (auto newer = profiles.take(m->message)) profile = std::move(newer);
    matcher.advance(now);
    if (now < next_report) continue;
    next_report = std::max(next_report + kReportPeriod, now);
    sync_report_t report = matcher.report();
    node.bus().publish(channels::kSyncReport, report);
    if (profile) sync::send_profile(node.bus(), *profile);
  }
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("sync_node", e);
}
