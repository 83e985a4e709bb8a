// Sends bytes on a channel of the bus unchanged. It is separate from Bus, which sends only messages that it has stamped
// itself.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "sync/bus/bus.h"

namespace tactus::sync {

class ReplayPort {
 public:
  // Uses the real-time port: a log does not state the port of a message, and receivers of bulk data listen on both. Throws
  // std::runtime_error with one sentence.
  explicit ReplayPort(const BusOptions& options);
  ~ReplayPort();
  // Returns false when the network refused it.
  bool send(std::string_view channel, std::span<const std::uint8_t> message);
  std::int64_t refused() const { return refused_; }

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
  std::string channel_;
  std::int64_t refused_ = 0;
};

}  // namespace tactus::sync
