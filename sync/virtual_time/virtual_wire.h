// The bus between the programs of a VirtualTime: delivers sent messages to the subscribers after a latency with jitter,
// unless they are lost on the way to that subscriber. As on a switched network, the messages from one end to another arrive
// in the order of sending. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sync/random/jitter.h"
#include "sync/random/loss.h"
#include "sync/time/time.h"
#include "sync/virtual_time/message_receiver.h"

namespace tactus::sync {

struct WirePlan {
  Nanoseconds latency{0};
  JitterDef jitter{};  // added to the latency; an arrival before the sending time is moved to the sending time
  LossDef loss{};      // of each datagram on its way to each receiver
};

class VirtualWire;

// The end of the wire at one program. Realtime-safe: no.
class VirtualEnd {
 public:
  ~VirtualEnd();
  VirtualEnd(const VirtualEnd&) = delete;
  VirtualEnd& operator=(const VirtualEnd&) = delete;

  // side: 0 the first port, 1 the next.
  void subscribe(std::size_t side, const std::string& channel, MessageReceiver* inbox) { subscribers_[side][channel].push_back(inbox); }
  // Delivers the messages that have arrived by now, oldest first, at most max_messages.
  void drain(HostTime now, int max_messages);
  // Arrival of the next message; HostTime::max(): none is in flight.
  HostTime next_arrival() const { return in_flight_.empty() ? HostTime::max() : in_flight_.front().at; }

 private:
  friend class VirtualWire;
  using Inboxes = std::vector<MessageReceiver*>;
  struct Datagram {
    HostTime at;
    std::uint64_t number;  // counts the datagrams that are sent to this end
    const Inboxes* to;
    std::shared_ptr<const std::vector<std::uint8_t>> bytes;
  };
  static bool later(const Datagram& a, const Datagram& b) { return a.at != b.at ? a.at > b.at : a.number > b.number; }
  // Jitter and loss of one sender's datagrams on their way to this end.
  struct Path {
    explicit Path(const WirePlan& plan) : jitter(plan.jitter), loss(plan.loss) {}
    Jitter jitter;
    Loss loss;
    std::uint64_t sent = 0;
    HostTime newest{};
  };
  VirtualEnd(VirtualWire& wire, std::uint64_t seed) : wire_(wire), seed_(seed) {}

  VirtualWire& wire_;
  std::uint64_t seed_;
  std::array<std::map<std::string, Inboxes, std::less<>>, 2> subscribers_;
  std::vector<Datagram> in_flight_;  // a heap; the next arrival is first
  std::uint64_t next_number_ = 0;
  std::map<const VirtualEnd*, Path> paths_;
};

class VirtualWire {
 public:
  // Throws std::invalid_argument with one sentence when the loss is invalid.
  VirtualWire(WirePlan plan, std::uint64_t seed);

  std::unique_ptr<VirtualEnd> join();
  void send(const VirtualEnd& from, std::size_t side, std::string_view channel, std::span<const std::uint8_t> data, HostTime now);
  // Loses every message of that channel that is sent before then, on its way to every receiver.
  void block(const std::string& channel, HostTime until) { blocked_[channel] = until; }
  // Calls the listener for every message when it is sent: for a recorder without losses. Pass the returned number to remove_listener.
  using Listener = std::function<void(HostTime, std::string_view channel, std::span<const std::uint8_t> data)>;
  int add_listener(Listener listener);
  void remove_listener(int number) { listeners_.erase(number); }

  std::int64_t sent() const { return sent_; }

 private:
  friend class VirtualEnd;
  WirePlan plan_;
  std::uint64_t seed_;
  std::uint64_t joined_ = 0;
  std::vector<VirtualEnd*> ends_;
  std::map<int, Listener> listeners_;
  std::map<std::string, HostTime, std::less<>> blocked_;
  int listener_count_ = 0;
  std::int64_t sent_ = 0;
};

}  // namespace tactus::sync
