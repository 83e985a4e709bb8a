// Sends a request to a node and waits for the reply: repeats the request, which carries a random id, until a reply carries
// that id.
#pragma once

#include <optional>

#include "sync/bus/bus.h"
#include "sync/bus/identity.h"
#include "sync/clocks/pacing.h"

namespace tactus::sync {

// A random number > 0, different for each request. Throws std::runtime_error when the system has no random numbers.
std::int64_t request_id();

// The reply of this run to `message`; nullopt: no reply within `timeout`. It blocks: for command-line programs only.
template <class Request, class Reply>
std::optional<Reply> request(Bus& bus, const char* channel, Request& message, Queue<Reply>& replies,
                         Nanoseconds timeout) {
  constexpr Nanoseconds kRepeat{100'000'000};  // a datagram may be lost
  const HostTime begin = host_now();
  for (HostTime next = begin; host_now() < begin + timeout;) {
    if (host_now() >= next) {
      bus.publish(channel, message);
      next += kRepeat;
    }
    bus.wait(kRepeat / 4);
    bus.drain(host_now());
    while (auto m = replies.pop())
      if (m->message.header.run_id == bus.identity().run_id && m->message.id == message.id)
        return std::move(m->message);
  }
  return std::nullopt;
}

}  // namespace tactus::sync
