// Access to the bus: two LCM ports; sent messages are stamped, received messages are checked. LCM sends;
// sync/bus/udp_reader.h receives.
//
// No call waits for another process. Queues are bounded; overflow is dropped and counted.
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
#include "sync/bus/bus_options.h"
#include "sync/bus/identity.h"
#include "sync/bus/inbox.h"
#include "sync/clocks/pacing.h"
#include "sync/bus/raw_queue.h"

namespace tactus::sync {

class Bus {
 public:
  // Opens both ports. Throws std::runtime_error with one sentence (cause and remedy) when it cannot. Its thread inherits the
  // caller's scheduling, so set that first.
  Bus(Identity identity, const BusOptions& options);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  // Subscriptions exist as long as the bus; create them before the first drain.
  template <class Message>
  Queue<Message>& queue(const char* channel, std::size_t capacity, Port port = Port::kRealtime) {
    return add(std::make_unique<Queue<Message>>(channel, capacity), channel, port);
  }
  // The encoded messages of any channel. A raw queue may be added later; it then receives only later messages.
  RawQueue& raw(const char* channel, std::size_t capacity, Port port = Port::kBoth) {
    return add(std::make_unique<RawQueue>(channel, capacity), channel, port);
  }

  // Subscribes an inbox of the caller's. It must outlive the last drain of the bus, and is not among inboxes().
  void attach(InboxBase& inbox) { subscribe(inbox.count().channel.c_str(), &inbox, Port::kRealtime); }

  // Applies the clock maps of this run from now on. For processes that drain; call before the first drain.
  void track_clocks();
  // The clock of this process and the maps of others. Refers to this bus.
  OwnClock clocks() const { return {identity_.run_id, identity_.clock, &maps_}; }

  // Distributes all received messages to the inboxes, at most kMaxDrain, without waiting.
  void drain(HostTime now);
  static constexpr int kMaxDrain = 8192;
  // Passes on a message that was received elsewhere, such as by the recorder, to the inboxes of its channel.
  void on_message(std::string_view channel, std::span<const std::uint8_t> data, HostTime arrival);
  // For event-driven processes: waits until a message arrives, at most this time.
  void wait(Nanoseconds max_wait);

  // Stamps the header (all but sim_time_ns) and sends. Returns false when the message is too large or the network refused it.
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
  // Starts a new incarnation; receivers see a restart. Numbering starts again. Throws as Identity::fresh does.
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
  // Throws when a message sent to both ports does not return.
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
