// The bus between the programs of a VirtualTime: who has subscribed hears what is sent, after a latency that trembles, unless it
// is lost on the way to him. As on a switched network, what one sends another comes in the order in which it was sent. Pure.
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
  JitterDef jitter{};  // on top; what would arrive before it was sent arrives at once
  LossDef loss{};      // of each datagram on its way to each receiver
};

class VirtualWire;

// Where one program hears. Realtime-safe: no.
class VirtualEnd {
 public:
  ~VirtualEnd();
  VirtualEnd(const VirtualEnd&) = delete;
  VirtualEnd& operator=(const VirtualEnd&) = delete;

  // side: 0 the first port, 1 the next.
  void subscribe(std::size_t side, const std::string& channel, MessageReceiver* inbox) { subscribers_[side][channel].push_back(inbox); }
  // Hands over what has arrived by then, oldest first, at most so many.
  void drain(HostTime now, int at_most);
  // When the next message arrives; HostTime::max(): none is under way.
  HostTime next_arrival() const { return under_way_.empty() ? HostTime::max() : under_way_.front().at; }

 private:
  friend class VirtualWire;
  using Inboxes = std::vector<MessageReceiver*>;
  struct Datagram {
    HostTime at;
    std::uint64_t number;  // of those that this end is sent
    const Inboxes* to;
    std::shared_ptr<const std::vector<std::uint8_t>> bytes;
  };
  static bool later(const Datagram& a, const Datagram& b) { return a.at != b.at ? a.at > b.at : a.number > b.number; }
  // Of what one sender's datagrams meet on their way here.
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
  std::vector<Datagram> under_way_;  // a heap, the next first
  std::uint64_t numbered_ = 0;
  std::map<const VirtualEnd*, Path> paths_;
};

class VirtualWire {
 public:
  // Throws std::invalid_argument with one sentence when there is no such loss.
  VirtualWire(WirePlan plan, std::uint64_t seed);

  std::unique_ptr<VirtualEnd> join();
  void send(const VirtualEnd& from, std::size_t side, std::string_view channel, std::span<const std::uint8_t> data, HostTime now);
  // Is told of all that is sent, when it is: a recorder that loses nothing. The number ends it.
  using Tell = std::function<void(HostTime, std::string_view channel, std::span<const std::uint8_t> data)>;
  int tell(Tell of_message);
  void tell_no_more(int number) { tell_.erase(number); }

  std::int64_t sent() const { return sent_; }
  std::int64_t lost() const { return lost_; }

 private:
  friend class VirtualEnd;
  WirePlan plan_;
  std::uint64_t seed_;
  std::uint64_t joined_ = 0;
  std::vector<VirtualEnd*> ends_;
  std::map<int, Tell> tell_;
  int tells_ = 0;
  std::int64_t sent_ = 0, lost_ = 0;
};

}  // namespace tactus::sync
