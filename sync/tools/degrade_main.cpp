// degrade: puts a degradation profile in force in a running cluster, or removes it, and prints which nodes have adopted it.
#include <algorithm>
#include <iostream>
#include <map>
#include <set>
#include <tactus/contact_frame_t.hpp>
#include <tactus/degradation_t.hpp>
#include <tactus/node_health_t.hpp>

#include "lcmtypes/generation.h"
#include "sync/bus/bus.h"
#include "sync/bus/bus_arguments.h"
#include "sync/degradation/profile_exchange.h"
#include "sync/bus/identity.h"
#include "sync/node/node_options.h"
#include "sync/clocks/pacing.h"
#include "sync/text/printable.h"
#include "sync/clocks/sim_clock_tracker.h"

using namespace tactus;

namespace {

constexpr sync::Nanoseconds kListen{500'000'000};      // health comes every 100 ms, the clock of the simulation every ms
constexpr sync::Nanoseconds kTimeout{2'000'000'000};  // health comes every 100 ms
// A profile in force that is dated further ahead is of a clock that ran ahead, and is replaced all the same. Of two profiles that are
// requested at the same time the later one holds.
constexpr std::int64_t kClocksDiffer_ns = 1'000'000'000;
constexpr sync::Nanoseconds kRepeat{100'000'000};      // a datagram may be lost

std::string joined(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& n : names) text += (text.empty() ? "" : ", ") + sync::printable(n);
  return text;
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app("Applies a degradation profile to the running cluster; \"off\" removes it.");
  sync::BusOptions bus_options;
  std::int64_t run_id = 1;
  std::string file;
  app.add_option("PROFILE", file, "XML file of the profile, or off");
  sync::add_bus_options(app, bus_options);
  app.add_option("--run-id", run_id, "number of the cluster run").environment("TACTUS_RUN_ID").show_default();
  sync::parse_or_exit(app, "degrade", argc, argv);

  if (file.empty()) throw std::runtime_error("name a profile, or off; see degrade --help");

  auto profile = file == "off" ? sync::read_profile("<profile name=\"off\"/>", file) : sync::read_profile_file(file);
  profile.generation = sync::realtime_ns();

  sync::Bus bus(sync::Identity::fresh("degrade", run_id), bus_options);
  auto& frames = bus.queue<contact_frame_t>(channels::kContacts, 4096);
  auto& healths = bus.queue<node_health_t>(channels::kNodeHealth, 1024);
  auto& profiles = bus.queue<degradation_t>(channels::kDegradation, 256);
  sync::SimClockTracker simulation(bus.clocks());
  std::map<std::string, bool> senses;  // node -> whether it has adopted the profile
  std::set<std::string> modalities;    // that are present
  const sync::HostTime begin = sync::host_now();
  while (sync::host_now() < begin + kListen) {
    bus.wait(kRepeat);
    bus.drain(sync::host_now());
    while (const auto m = frames.pop()) simulation.track(m->message.header, m->message.clock, m->arrival);
    while (const auto m = healths.pop())
      if (m->message.header.run_id == run_id && !m->message.modality.empty()) modalities.insert(m->message.modality);
  }
  if (modalities.empty())
    throw std::runtime_error(
        "no modality publishes on this bus, nothing was changed; run it inside the cluster: tactus degrade");
  for (const sync::Rule& rule : profile.parsed->rules)
    if (!modalities.contains(rule.modality))
      throw std::runtime_error(sync::printable(file) + ":" + std::to_string(rule.line) + ": no modality \"" +
                               sync::printable(rule.modality) + "\" runs in this cluster, only " +
                               joined(modalities) + "; nothing was changed");
  const auto map = simulation.map(sync::host_now());
  if (map) profile.start = std::max(sync::SimTime{}, map->to_sim(sync::host_now()));

  const sync::HostTime sent = sync::host_now();
  for (sync::HostTime next = sent; sync::host_now() < sent + kTimeout;) {
    if (sync::host_now() >= next) {
      sync::send_profile(bus, profile);
      next += kRepeat;
    }
    bus.wait(kRepeat / 4);
    bus.drain(sync::host_now());
    while (const auto m = profiles.pop())
      if (m->message.header.run_id == run_id && m->message.hash != profile.hash && m->message.generation > sync::realtime_ns() + kClocksDiffer_ns)
        profile.generation = std::max(profile.generation, next_generation(m->message.generation, sync::realtime_ns()));
    while (const auto m = healths.pop())
      if (m->message.header.run_id == run_id && !m->message.modality.empty())
        senses[m->message.node] = m->message.profile == profile.hash;
    // Every node has published its health twice by then.
    const bool all = std::all_of(senses.begin(), senses.end(), [](const auto& s) { return s.second; });
    if (!senses.empty() && all && sync::host_now() - sent > 3 * kRepeat) break;
  }
  std::set<std::string> accepted, missing;
  for (const auto& [name, has] : senses) (has ? accepted : missing).insert(name);
  if (senses.empty())
    throw std::runtime_error("no health has been received from " + joined(modalities) +
                             " since the profile was sent; it may still take effect when they continue");
  if (accepted.empty())
    throw std::runtime_error(joined(missing) +
                             " did not accept it; they may not support it, see their logs");
  std::cout << "in force since " << sync::to_seconds(profile.start - sync::SimTime{}) << " s of simulated time in "
            << joined(accepted) << std::endl;
  if (!missing.empty()) throw std::runtime_error(joined(missing) + " did not accept it; see their logs");
  return 0;
} catch (const std::exception& e) {
  return sync::fail("degrade", e);
}
