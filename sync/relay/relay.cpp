#include "sync/relay/relay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sync/log/log_header.h"

namespace tactus::sync {

Relay::Relay(RelayRules rules, std::vector<LineEnd> sites, std::int64_t run_id)
    : rules_(std::move(rules)),
      sites_(std::move(sites)),
      run_id_(run_id),
      last_received_(sites_.size(), HostTime{} - kSilent),
      reported_counts_(sites_.size()) {
  for (const LineEnd& site : sites_) outboxes_.emplace_back(site.bit_per_s);
}

Decimator& Relay::decimator(const PassRule& rule) { return decimators_.try_emplace(&rule, rule).first->second; }

void Relay::on_bus_message(const ChannelBytes& m, bool bulk, HostTime now) {
  const PassRule* rule = rules_.find(m.channel);
  if (!rule || !m.fits()) return;
  const auto header = peek_header(m.data.data(), m.data.size());
  if (!header || header->run_id != run_id_) {
    ++counts_.bad;
    return;
  }
  // The relay also receives the messages that it sent itself.
  if (!sides_.belongs_to(*header, SenderSides::kHere, now)) return;
  const Urgency urgency = bulk ? Urgency::kBulk : rule->first ? Urgency::kFirst : Urgency::kState;
  decimator(*rule).push(*header, m.data, now, [&](std::span<const std::uint8_t> passing) {
    ++counts_.out;
    const auto datagram = line_datagram({m.channel, passing}, bulk);
    for (Outbox& outbox : outboxes_) outbox.push(urgency, datagram, now);
  });
}

bool Relay::on_line_message(std::size_t site, const LineMessage& m, HostTime now) {
  last_received_[site] = now;
  const PassRule* rule = rules_.find(m.message.channel);
  if (!rule) return ++counts_.withheld, false;
  const auto header = peek_header(m.message.data.data(), m.message.data.size());
  if (!header || header->run_id != run_id_) return ++counts_.bad, false;
  if (!sides_.belongs_to(*header, SenderSides::kHere + 1 + static_cast<int>(site), now)) return false;
  ++counts_.in;
  if (!carries_motion(*rule)) return true;
  if (!motions_[rule].try_emplace(site, *rule->thinning.deadband).first->second.push(m.message.data, now)) ++counts_.bad;
  return false;
}

std::string Relay::status_text(HostTime now) {
  std::string text;
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const OutboxCounts& line = outboxes_[i].counts();
    const OutboxCounts before = std::exchange(reported_counts_[i], line);
    const double kbit_s =
        8e-3 * static_cast<double>(line.bytes - before.bytes) / std::max(1e-3, to_seconds(now - reported_at_));
    text += (i > 0 ? "; " : "") + sites_[i].name + (silent(i, now) ? ": nothing received" : ": received") + ", " +
            std::to_string(std::lround(kbit_s)) + " kbit/s there";
    if (line.late > before.late)
      text += ", " + std::to_string(line.late - before.late) + " given up, the line is too slow";
    else if (line.late > 0)
      text += ", " + std::to_string(line.late) + " were given up";
    if (line.late_bulk > 0) text += ", " + std::to_string(line.late_bulk) + " of assets put off";
    if (line.refused > 0) text += ", " + std::to_string(line.refused) + " refused by the network";
  }
  reported_at_ = now;
  if (counts_.withheld > 0)
    text += "; " + std::to_string(counts_.withheld) + " withheld, give all relays the same rules";
  return text;
}

}  // namespace tactus::sync
