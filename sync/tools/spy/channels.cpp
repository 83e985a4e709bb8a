#include "sync/tools/spy/channels.h"

#include <algorithm>

#include "sync/log/log_header.h"

namespace tactus::sync::spy {

Channels::Sender* Channels::sender_of(Channel& channel, std::int32_t source) const {
  const auto known = channel.senders.find(source);
  if (known != channel.senders.end()) return &known->second;
  if (channel.senders.size() >= kMaxSenders) return nullptr;
  return &channel.senders.emplace(source, Sender(own_)).first->second;
}

void Channels::push(const MessageBatch::Message& m) {
  ++messages_;
  auto it = channels_.find(m.channel);
  if (it == channels_.end()) {
    if (channels_.size() >= kMax) {
      ++beyond_;
      return;
    }
    it = channels_.emplace(std::string(m.channel), Channel()).first;
  }
  Channel& c = it->second;
  ++c.messages;
  c.newest = m.arrival;
  c.torn += !m.complete;
  c.bytes.assign(m.data.begin(), m.data.end());
  c.type = type_of(m.data);
  const auto header = c.type ? peek_header(m.data.data(), m.data.size()) : std::nullopt;
  Sender* sender = sender_of(c, header ? header->source : 0);
  if (sender) sender->arrivals.add(m.arrival, m.data.size());
  if (!header) return;
  c.sequence.observe(*header);
  if (!sender) return;
  sender->clock.observe(*header, m.arrival);
  const SenderClock::Reading sent = sender->clock.read(header->publish_time_ns, m.arrival);
  c.age_ms = to_seconds(m.arrival - sent.time) * 1000;
  c.age_uncertainty_ms = sent.uncertainty < Nanoseconds(0) ? -1 : to_seconds(sent.uncertainty) * 1000;
}

std::vector<ChannelFigures> Channels::figures(HostTime now) const {
  std::vector<ChannelFigures> out;
  for (const auto& [name, c] : channels_) {
    ChannelFigures& f = out.emplace_back();
    f.name = name;
    if (c.type) f.type = c.type->name;
    f.messages = c.messages, f.torn = c.torn, f.gaps = c.sequence.gaps();
    f.senders = static_cast<int>(c.senders.size());
    for (const auto& [source, sender] : c.senders) {
      f.rate_Hz += sender.arrivals.rate_Hz(now);
      f.bytes_per_s += sender.arrivals.bytes_per_s(now);
      const Arrivals::Jitter jitter = sender.arrivals.jitter(now);
      if (jitter.p99_ms >= f.jitter.p99_ms) f.jitter = jitter;
    }
    f.age_ms = c.age_ms, f.age_uncertainty_ms = c.age_uncertainty_ms;
    f.silent_s = to_seconds(now - c.newest);
  }
  return out;
}

std::span<const std::uint8_t> Channels::newest(std::string_view channel) const {
  const auto it = channels_.find(channel);
  return it == channels_.end() ? std::span<const std::uint8_t>() : std::span<const std::uint8_t>(it->second.bytes);
}

}  // namespace tactus::sync::spy
