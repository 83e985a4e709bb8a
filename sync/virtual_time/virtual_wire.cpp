#include "sync/virtual_time/virtual_wire.h"

#include <algorithm>
#include <utility>

#include "sync/random/keyed_random.h"

namespace tactus::sync {

VirtualWire::VirtualWire(WirePlan plan, std::uint64_t seed) : plan_(std::move(plan)), seed_(seed) {
  Loss{plan_.loss};  // throws here instead of later in each path
}

std::unique_ptr<VirtualEnd> VirtualWire::join() {
  std::unique_ptr<VirtualEnd> end(new VirtualEnd(*this, mixed(seed_, ++joined_)));
  ends_.push_back(end.get());
  return end;
}

int VirtualWire::add_listener(Listener listener) {
  listeners_.emplace(++listener_count_, std::move(listener));
  return listener_count_;
}

VirtualEnd::~VirtualEnd() {
  std::erase(wire_.ends_, this);
  for (VirtualEnd* end : wire_.ends_) end->paths_.erase(this);
}

void VirtualWire::send(const VirtualEnd& from, std::size_t side, std::string_view channel, std::span<const std::uint8_t> data,
                       HostTime now) {
  ++sent_;
  for (const auto& [number, listener] : listeners_) listener(now, channel, data);
  if (const auto at = blocked_.find(channel); at != blocked_.end() && now < at->second) return;
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
  for (VirtualEnd* end : ends_) {
    const auto to = end->subscribers_[side].find(channel);
    if (to == end->subscribers_[side].end()) continue;
    // Messages from an end to itself have no latency and no loss.
    VirtualEnd::Path& path = end->paths_.try_emplace(&from, plan_).first->second;
    const std::uint64_t number = path.sent++;
    const bool own = end == &from;
    if (!own && path.loss.lose(uniform(end->seed_, 2 * number))) continue;
    const Nanoseconds delay = own ? Nanoseconds(0) : plan_.latency + path.jitter.next(uniform(end->seed_, 2 * number + 1));
    path.newest = std::max({path.newest, now, now + delay});
    if (!bytes) bytes = std::make_shared<const std::vector<std::uint8_t>>(data.begin(), data.end());
    end->in_flight_.push_back({path.newest, end->next_number_++, &to->second, bytes});
    std::push_heap(end->in_flight_.begin(), end->in_flight_.end(), VirtualEnd::later);
  }
}

void VirtualEnd::drain(HostTime now, int max_messages) {
  for (; max_messages > 0 && next_arrival() <= now; --max_messages) {
    std::pop_heap(in_flight_.begin(), in_flight_.end(), later);
    const Datagram m = std::move(in_flight_.back());
    in_flight_.pop_back();
    for (MessageReceiver* inbox : *m.to) inbox->accept(m.bytes->data(), m.bytes->size(), now);
  }
}

}  // namespace tactus::sync
