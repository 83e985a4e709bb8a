// What a relay does with what it hears: of the bus of its site, what the rules let pass, thinned, to every other
// site, each by a line of its own; of the lines, what the rules let pass, to the bus. Pure: the program hands
// messages in and sends what comes out.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sync/bus/datagram.h"
#include "sync/relay/link.h"
#include "sync/relay/outbox.h"
#include "sync/relay/rules.h"
#include "sync/relay/sides.h"
#include "sync/relay/decimator.h"

namespace tactus::sync {

struct RelayCounts {
  std::int64_t in = 0;        // messages let in from other sites
  std::int64_t out = 0;       // messages for other sites, after thinning
  std::int64_t withheld = 0;  // that no rule names, of the lines: the other end has other rules
  std::int64_t bad = 0;       // were none of ours, or of another run
};

class Relay {
 public:
  // A site is silent when it was not heard for so long; a process says its health ten times a second.
  static constexpr Nanoseconds kSilent{1'000'000'000};

  Relay(RelayRules rules, std::vector<LineEnd> sites, std::int64_t run_id);

  // From the bus of this site.
  void hear_bus(const ChannelBytes& message, bool bulk, HostTime now);
  // From the line of a site: true when the message is to be said on the bus.
  bool hear_line(std::size_t site, const LineMessage& message, HostTime now);
  // Calls send(site, datagram) -> bool for what may go by now.
  template <class Send>
  void flush(HostTime now, Send&& send) {
    for (std::size_t i = 0; i < sites_.size(); ++i)
      outboxes_[i].flush(now, [&](std::span<const std::uint8_t> datagram) { return send(sites_[i], datagram); });
  }

  const std::vector<LineEnd>& sites() const { return sites_; }
  const RelayCounts& counts() const { return counts_; }
  const OutboxCounts& line(std::size_t site) const { return outboxes_[site].counts(); }
  bool silent(std::size_t site, HostTime now) const { return now - heard_[site] > kSilent; }
  // For the live table: what each line carries since this was asked before, what it lost, and whether its other
  // end is heard.
  std::string note(HostTime now);

 private:
  Decimator& thinner(const PassRule& rule);

  RelayRules rules_;
  std::vector<LineEnd> sites_;
  std::int64_t run_id_;
  std::vector<Outbox> outboxes_;
  std::vector<HostTime> heard_;
  std::vector<OutboxCounts> noted_counts_;
  HostTime noted_{};
  std::map<const PassRule*, Decimator> thinners_;
  Sides sides_;
  RelayCounts counts_;
};

}  // namespace tactus::sync
