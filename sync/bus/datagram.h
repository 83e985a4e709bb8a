// Parses a datagram of the bus into a channel and the bytes of one message.
//
// Source: LCM, "UDP Multicast Protocol Description" (lcm-proj.github.io/lcm, content/udp-multicast-protocol): a short message
// is the magic number "LC02", a sequence number, the channel, NUL, and the payload; a fragment of a long one begins with
// "LC03" and 20 bytes of header, and the first fragment names the channel.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "lcmtypes/channels.h"

namespace tactus::sync {

inline constexpr std::size_t kMaxChannelBytes = 63;

struct ChannelBytes {
  std::string_view channel;
  std::span<const std::uint8_t> data;
  bool complete = true;  // false: a fragment of a message longer than the bus allows

  // True when it is a whole message within the size limit of the bus.
  bool fits() const { return complete && data.size() <= channels::kMaxMessageBytes; }
};

// nullopt when the bytes are not an LCM datagram, or are a later fragment, which has no channel. Refers to `bytes`.
std::optional<ChannelBytes> parse_datagram(std::span<const std::uint8_t> bytes);

}  // namespace tactus::sync
