// Access to the bus: two LCM ports, stamped messages out, checked messages in. LCM sends; sync/bus/udp_reader.h
// receives.
//
// Nothing here waits for another process. Queues are bounded; what does not fit is dropped and counted.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tactus/header_t.hpp>
#include <vector>

#include "lcmtypes/channels.h"
#include "sync/clocks/clock_maps.h"
#include "sync/bus/identity.h"
#include "sync/bus/inbox.h"
#include "sync/clocks/pacing.h"
#include "sync/bus/raw_queue.h"

namespace tactus::sync {

struct BusOptions {
  std::string group = channels::kGroup;
  int port = channels::kDefaultPort;  // bulk is the next one
  int ttl = 0;                        // 0: never leaves this machine
  bool memory = false;                // within this process only, for tests and logs: no network
  std::int32_t clock = 0;             // of the machine that a log was recorded on; 0: this process reads its own
};

enum class Port { kRealtime, kBulk, kBoth };

class Bus {
 public:
  // Opens both ports. Throws std::runtime_error with one sentence (what is wrong and what to do) when it cannot.
  // The thread that it starts inherits the caller's scheduling: set that first.
  Bus(Identity identity, const BusOptions& options);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  // Subscriptions live as long as the bus; make them before the first drain.
  template <class Message>
  Latest<Message>& latest(const char* channel, Port port = Port::kRealtime) {
    return add(std::make_unique<Latest<Message>>(channel), channel, port);
  }
  template <class Message>
  Queue<Message>& queue(const char* channel, std::size_t capacity, Port port = Port::kRealtime) {
    return add(std::make_unique<Queue<Message>>(channel, capacity), channel, port);
  }
  // The bytes of any channel, unread. One may come later, too: what came before is not in it.
  RawQueue& raw(const char* channel, std::size_t capacity, Port port = Port::kBoth) {
    return add(std::make_unique<RawQueue>(channel, capacity), channel, port);
  }

  // An inbox of the caller's, which outlives the bus' last drain and is not among inboxes().
  void attach(InboxBase& inbox) { subscribe(inbox.count().channel.c_str(), &inbox, Port::kRealtime); }

  // Heeds the clock maps of this run from now on. For processes that drain; call before the first drain.
  void follow_clocks();
  // Our clock and what is known of others. Refers to this bus.
  OwnClock clocks() const { return {identity_.run_id, identity_.clock, &maps_}; }

  // Hands everything that has arrived to the inboxes, at most kMaxDrain messages, without waiting.
  void drain(HostTime now);
  static constexpr int kMaxDrain = 8192;
  // What somebody else has received, as a recorder did: to the inboxes of that channel.
  void hear(std::string_view channel, std::span<const std::uint8_t> data, HostTime arrival);
  // For processes that are driven by events: waits until something arrives, at most so long.
  void wait(Nanoseconds at_most);

  // Stamps the header (all but sim_time_ns) and sends. False when the message is too large or the network refused
  // it.
  template <class Message>
  bool publish(const char* channel, Message& m, Port port = Port::kRealtime) {
    stamp(channel, m.header);
    const int size = m.getEncodedSize();
    if (size > static_cast<int>(channels::kMaxMessageBytes)) return refuse();
    unsigned char bytes[channels::kMaxMessageBytes];
    m.encode(bytes, 0, size);
    return send(channel, bytes, static_cast<unsigned>(size), port);
  }
  std::int64_t refused() const { return refused_; }

  const Identity& identity() const { return identity_; }
  // To everyone this process is another from here on, as if it had been started anew: a fresh incarnation, numbered from
  // the beginning. Throws as Identity::fresh does.
  void begin_incarnation();
  const std::vector<std::unique_ptr<InboxBase>>& inboxes() const { return inboxes_; }

 private:
  struct Connections;
  template <class Inbox>
  Inbox& add(std::unique_ptr<Inbox> inbox, const char* channel, Port port) {
    Inbox& ref = *inbox;
    subscribe(channel, &ref, port);
    inboxes_.push_back(std::move(inbox));
    return ref;
  }
  void subscribe(const char* channel, InboxBase* inbox, Port port);
  void stamp(const char* channel, header_t& header);
  bool send(const char* channel, const void* data, unsigned size, Port port);
  bool refuse() { return ++refused_, false; }
  // Throws when what is sent to both ports does not come back.
  void test_self(const std::string& url);

  Identity identity_;
  ClockMaps maps_;
  std::unique_ptr<InboxBase> map_inbox_;
  std::unique_ptr<Connections> connections_;
  std::vector<std::unique_ptr<InboxBase>> inboxes_;
  std::map<std::string, std::int64_t> next_seq_;
  std::int64_t refused_ = 0;
};

// "udpm://group:port?ttl=T".
std::string lcm_url(const BusOptions& options, int port);

}  // namespace tactus::sync
