// The core of a relay: from the bus of its site, the messages that the rules permit, thinned, go to every other site, each by
// its own line; from the lines, the messages that the rules permit go to the bus. Pure: the program passes messages in and
// sends the results.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sync/bus/datagram.h"
#include "sync/relay/link.h"
#include "sync/relay/motion_line.h"
#include "sync/relay/outbox.h"
#include "sync/relay/rules.h"
#include "sync/relay/sides.h"
#include "sync/relay/decimator.h"

namespace tactus::sync {

struct RelayCounts {
  std::int64_t in = 0;        // messages accepted from other sites
  std::int64_t out = 0;       // messages for other sites, after thinning
  std::int64_t withheld = 0;  // messages from the lines that no rule names: the other end has other rules
  std::int64_t bad = 0;       // invalid, or of another run
};

class Relay {
 public:
  // A site counts as silent after this time without a message; a process publishes its health ten times a second.
  static constexpr Nanoseconds kSilent{1'000'000'000};

  Relay(RelayRules rules, std::vector<LineEnd> sites, std::int64_t run_id);

  // A message from the bus of this site.
  void on_bus_message(const ChannelBytes& message, bool bulk, HostTime now);
  // A message from the line of a site: returns true when it must be sent on the bus as it is. The motion of a hand is sent by
  // publish_motions() instead.
  bool on_line_message(std::size_t site, const LineMessage& message, HostTime now);
  // Calls send(channel, message) for the motions of hands at other sites: those that arrived since the last call, and between them the
  // motion that the deadband of the rule implies. Once a tick.
  template <class Send>
  void publish_motions(HostTime now, Send&& send) {
    for (auto& [rule, receivers] : motions_)
      for (auto& [site, receiver] : receivers)
        receiver.publish(now, [&, rule = rule](std::span<const std::uint8_t> message) { send(rule->channel, message); });
  }
  // Calls send(site, datagram) -> bool for the datagrams that may be sent by now.
  template <class Send>
  void flush(HostTime now, Send&& send) {
    for (std::size_t i = 0; i < sites_.size(); ++i)
      outboxes_[i].flush(now, [&](std::span<const std::uint8_t> datagram) { return send(sites_[i], datagram); });
  }

  const std::vector<LineEnd>& sites() const { return sites_; }
  const RelayCounts& counts() const { return counts_; }
  const OutboxCounts& line(std::size_t site) const { return outboxes_[site].counts(); }
  bool silent(std::size_t site, HostTime now) const { return now - last_received_[site] > kSilent; }
  // For the live table: the load and the losses of each line since the last call, and whether its other end is received.
  std::string status_text(HostTime now);

 private:
  Decimator& decimator(const PassRule& rule);

  RelayRules rules_;
  std::vector<LineEnd> sites_;
  std::int64_t run_id_;
  std::vector<Outbox> outboxes_;
  std::vector<HostTime> last_received_;
  std::vector<OutboxCounts> reported_counts_;
  HostTime reported_at_{};
  std::map<const PassRule*, Decimator> decimators_;
  std::map<const PassRule*, std::map<std::size_t, MotionReceiver>> motions_;  // by rule and site
  SenderSides sides_;
  RelayCounts counts_;
};

}  // namespace tactus::sync
