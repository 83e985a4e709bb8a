// The inbox of a subscriber, a bounded queue of the messages of a channel. Bus::drain fills it; it is read in the same thread.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "sync/clocks/clock_maps.h"
#include "sync/bus/decode.h"
#include "sync/bus/sequence.h"
#include "sync/time/time.h"
#include "sync/virtual_time/message_receiver.h"

namespace tactus::sync {

// The counts that all kinds of inboxes share, per channel.
struct InputCount {
  std::string channel;
  SequenceTracker sequence;
  std::int64_t bad = 0;
  std::int64_t dropped = 0;  // removed from a full queue
  std::int64_t newest_publish_ns = -1;
  std::int64_t newest_run_id = 0;
  std::int32_t newest_clock = 0;
  HostTime newest_arrival{};
};

// The age of the newest message: by the sender's clock where it can be converted to ours, else since its arrival.
struct InputAge {
  Nanoseconds age{-1};          // -1: no message has arrived
  Nanoseconds uncertainty{-1};  // half width; -1: not known
};
InputAge age_of(const InputCount& input, const OwnClock& own, HostTime now);

template <class Message>
struct Received {
  Message message;
  HostTime arrival;
  SequenceStatus sequence_status;
};

class InboxBase : public MessageReceiver {
 public:
  explicit InboxBase(std::string channel) { count_.channel = std::move(channel); }
  InboxBase(const InboxBase&) = delete;
  InboxBase& operator=(const InboxBase&) = delete;
  const InputCount& count() const { return count_; }

 protected:
  template <class Message>
  SequenceStatus record_arrival(const Message& m, HostTime arrival) {
    const SequenceStatus sequence_status = count_.sequence.observe(m.header);
    if (sequence_status != SequenceStatus::kOld) {
      count_.newest_publish_ns = m.header.publish_time_ns;
      count_.newest_run_id = m.header.run_id;
      count_.newest_clock = m.header.clock;
      count_.newest_arrival = arrival;
    }
    return sequence_status;
  }
  InputCount count_;
};

// Stores messages in order of arrival; when it is full, the oldest is dropped and counted. Old and repeated messages are
// stored, too: pages of one step may overtake each other.
template <class Message>
class Queue : public InboxBase {
 public:
  Queue(std::string channel, std::size_t capacity) : InboxBase(std::move(channel)), capacity_(capacity) {}
  void accept(const void* data, std::size_t size, HostTime arrival) noexcept override {
    auto m = decode<Message>(data, size);
    if (!m) {
      ++count_.bad;
      return;
    }
    const SequenceStatus sequence_status = record_arrival(*m, arrival);
    if (queue_.size() >= capacity_) {
      queue_.pop_front();
      ++count_.dropped;
    }
    queue_.push_back({std::move(*m), arrival, sequence_status});
  }

  std::optional<Received<Message>> pop() {
    if (queue_.empty()) return std::nullopt;
    Received<Message> r = std::move(queue_.front());
    queue_.pop_front();
    return r;
  }

 private:
  std::size_t capacity_;
  std::deque<Received<Message>> queue_;
};

}  // namespace tactus::sync
