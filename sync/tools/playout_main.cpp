// playout: requests another playout policy from the running cluster, and prints the presentation delay of each modality under
// it.
#include <algorithm>
#include <cstdio>
#include <optional>
#include <set>
#include <tactus/node_health_t.hpp>
#include <tactus/playout_entry_t.hpp>
#include <tactus/playout_request_t.hpp>
#include <tactus/playout_t.hpp>

#include "lcmtypes/generation.h"
#include "sync/bus/bus.h"
#include "sync/bus/bus_arguments.h"
#include "sync/bus/identity.h"
#include "sync/node/node_options.h"
#include "sync/clocks/pacing.h"
#include "sync/playout/exchange.h"
#include "sync/playout/options.h"
#include "sync/text/printable.h"

using namespace tactus;

namespace {

constexpr sync::Nanoseconds kTimeout{3'000'000'000};  // PLAYOUT comes every 100 ms
constexpr std::int64_t kClocksDiffer_ns = 1'000'000'000;  // design
constexpr sync::Nanoseconds kListen{500'000'000};     // health comes every 100 ms
constexpr sync::Nanoseconds kRepeat{100'000'000};      // a datagram may be lost
constexpr sync::Nanoseconds kPages{300'000'000};       // a plan of many modalities comes in several messages, three times within this

void print(const playout_t& m) {
  std::printf("policy %s, aligner %s\n", name_of(static_cast<sync::Policy>(m.policy)),
              name_of(static_cast<sync::AlignerKind>(m.aligner)));
  if (m.lockstep_Hz > 0) std::printf("one loop for all senses, %.1f Hz\n", m.lockstep_Hz);
  std::printf("%-16s %10s %10s\n", "sense", "delay/ms", "needs/ms");
  for (const playout_entry_t& e : m.entries) {
    std::printf("%-16s %10.1f ", sync::printable(e.modality).c_str(), static_cast<double>(e.delay_ns) * 1e-6);
    if (e.needs_ns < 0)
      std::printf("%10s\n", "-");
    else
      std::printf("%10.1f%s\n", static_cast<double>(e.needs_ns) * 1e-6,
                  e.needs_ns > e.delay_ns && e.delay_ns > 0 ? "  later than requested" : "");
  }
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app(
      "Requests another playout policy from the running cluster; without arguments, prints the current one.");
  sync::BusOptions bus_options;
  std::int64_t run_id = 1;
  sync::PlayoutOptions options;
  options.add_to(app, false);
  sync::add_bus_options(app, bus_options);
  app.add_option("--run-id", run_id, "number of the cluster run").environment("TACTUS_RUN_ID").show_default();
  sync::parse_or_exit(app, "playout", argc, argv);
  const sync::PlayoutPlan plan = options.plan();
  const bool changes_policy = !options.policy.empty() || !options.soa.empty();
  if (!changes_policy && argc > 1 && !(options.aligner + options.base + options.budget).empty())
    throw std::invalid_argument("name the policy too; see playout --help");

  sync::Bus bus(sync::Identity::fresh("playout", run_id), bus_options);
  auto& playouts = bus.queue<playout_t>(channels::kPlayout, 64);
  auto& healths = bus.queue<node_health_t>(channels::kNodeHealth, 1024);
  std::set<std::string> modalities;
  for (const sync::HostTime begin = sync::host_now(); !plan.soa.empty() && sync::host_now() < begin + kListen;) {
    bus.wait(kRepeat);
    bus.drain(sync::host_now());
    while (const auto m = healths.pop())
      if (m->message.header.run_id == run_id) modalities.insert(m->message.modality);
  }
  for (const auto& [name, asynchrony] : plan.soa)
    if (!modalities.contains(name))
      throw std::runtime_error("no sense \"" + sync::printable(name) + "\" runs in this cluster; no change was made");
  playout_request_t request = sync::request_for(plan, sync::realtime_ns());
  std::optional<playout_t> answer;
  sync::HostTime until = sync::host_now() + kTimeout;
  for (sync::HostTime next = sync::host_now(); sync::host_now() < until;) {
    if (changes_policy && !answer && sync::host_now() >= next) {
      bus.publish(channels::kPlayoutRequest, request);
      next += kRepeat;
    }
    bus.wait(kRepeat / 4);
    bus.drain(sync::host_now());
    while (const auto m = playouts.pop()) {
      if (m->message.header.run_id != run_id) continue;
      // Dated ahead: of a clock that ran ahead. It is replaced all the same.
      if (!answer && m->message.generation > sync::realtime_ns() + kClocksDiffer_ns)
        request.generation = std::max(request.generation, next_generation(m->message.generation, sync::realtime_ns()));
      if (changes_policy && m->message.generation != request.generation) continue;
      if (answer) {
        sync::add_page(*answer, m->message);
      } else {
        answer = m->message;
        until = sync::host_now() + kPages;
      }
    }
  }
  if (!answer)
    throw std::runtime_error(changes_policy ? "no sync_node answers on this bus yet; the request may still take effect when "
                                    "one continues. Where there is "
                                    "none, run it inside the cluster: tactus playout"
                                  : "no sync_node publishes on this bus; run it inside the cluster: tactus playout");
  print(*answer);
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("playout", e);
}
