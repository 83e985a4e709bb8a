// relay: carries the bus between sites: messages that other sites need go to them, and theirs to this site. One relay runs at each site.
//
//   in   the channels that its rules name, on both ports; the same from other relays, by unicast UDP
//   out  the same channels, to this bus and to other relays
//
// Each line has its own queue, which drops messages that would arrive too late: a slow site, or an unreachable one, does not
// affect the others. Without a relay, this site continues alone; the last state of other sites is held and reported as old.
#include <fstream>
#include <sstream>
#include <tactus/node_health_t.hpp>

#include "sync/node/node.h"
#include "sync/relay/relay.h"
#include "sync/tools/replay/replay_port.h"
#include "sync/bus/receive_buffer.h"
#include "sync/bus/udp_reader.h"

using namespace tactus;

namespace {

constexpr std::uintmax_t kMaxRulesBytes = 1 << 20;
constexpr sync::Nanoseconds kStatusPeriod{500'000'000};

std::string read_rules(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) throw std::runtime_error("--rules " + path + " cannot be read; give a file of rules, as scripts/python/tactus/cluster/relays/wide.xml");
  if (text.str().size() > kMaxRulesBytes) throw std::runtime_error("--rules " + path + " is larger than 1 MiB; give a file of rules");
  return text.str();
}

std::vector<sync::LineEnd> other_sites(const std::vector<std::string>& texts) {
  std::vector<sync::LineEnd> sites;
  for (const std::string& text : texts) sites.push_back(sync::parse_other_site(text));
  return sites;
}

sync::BusOptions bulk_of(sync::BusOptions bus) {
  ++bus.port;
  return bus;
}

}  // namespace

int main(int argc, char** argv) try {
  const sync::NodeDescriptor descriptor{.name = "relay",
                                        .modality = "",
                                        .rate_Hz = 500,  // so it adds a millisecond on average
                                        .fifo_priority = 40,
                                        .about = "Carries the bus between sites: sends the channels of its rules, at the rates of its rules, over one line to each other site.",
                                        .opens_sockets = true};
  sync::Arguments app;
  sync::NodeOptions options;
  std::string listen, rules_file;
  std::vector<std::string> to;
  options.add_to(app, descriptor);
  app.add_option("--listen", listen, "address at which other relays reach this one: [ADDRESS:]PORT");
  app.add_option("--to", to, "address of another site's relay, and the bit rate of the line to it: ADDRESS:PORT[,KBIT]; once for each").one_value_per_use();
  app.add_option("--rules", rules_file, "file of the channels to send, the same for all relays; scripts/python/tactus/cluster/relays/ has examples");
  sync::parse_or_exit(app, descriptor.name, argc, argv);

  std::optional<sync::LineEnd> here;
  std::optional<sync::RelayRules> rules;
  if (!listen.empty()) here = sync::parse_line_end(listen);
  if (!rules_file.empty()) rules = sync::parse_relay_rules(read_rules(rules_file), rules_file);
  const std::vector<sync::LineEnd> sites = other_sites(to);
  sync::Node node(descriptor, options);
  if (!here || !rules || sites.empty()) throw std::invalid_argument("--listen, --to and --rules are needed; see relay --help");
  sync::Relay relay(*rules, sites, options.run_id);
  sync::LineSocket line(*here);
  sync::UdpReader reader(options.bus.group, options.bus.port);
  sync::drop_receive_buffer_right();
  sync::ReplayPort realtime(options.bus), bulk(bulk_of(options.bus));
  for (std::size_t i = 0; i < relay.sites().size(); ++i)
    node.tags().add("late_" + std::to_string(i + 1), "1", [&relay, i] { return static_cast<double>(relay.line(i).late); }, 1);
  node.tags().add("in", "1", [&] { return static_cast<double>(relay.counts().in); }, 1);
  node.tags().add("out", "1", [&] { return static_cast<double>(relay.counts().out); }, 1);

  sync::HostTime next_status{};
  while (node.running()) {
    const sync::HostTime now = node.wait();
    line.read(relay.sites(), [&](std::size_t site, const sync::LineMessage& m) {
      if (relay.on_line_message(site, m, now)) (m.bulk ? bulk : realtime).send(m.message.channel, m.message.data);
    });
    relay.publish_motions(now, [&](const std::string& channel, std::span<const std::uint8_t> m) { realtime.send(channel, m); });
    reader.read(sync::Bus::kMaxDrain, [&](std::size_t side, const sync::ChannelBytes& m) { relay.on_bus_message(m, side == 1, now); });
    relay.flush(now, [&](const sync::LineEnd& site, std::span<const std::uint8_t> datagram) { return line.send(site, datagram); });
    if (now < next_status) continue;
    next_status = now + kStatusPeriod;
    bool silent = false;
    for (std::size_t i = 0; i < relay.sites().size(); ++i) silent |= relay.silent(i, now);
    node.set_state(silent ? node_health_t::INPUT_LOST : node_health_t::RUNNING, relay.status_text(now));
  }
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("relay", e);
}
