// What a datagram of the bus holds: a channel and the bytes of one message.
//
// Source: LCM, "UDP Multicast Protocol Description" (lcm-proj.github.io/lcm, content/udp-multicast-protocol): a
// short message is the magic number "LC02", a sequence number, the channel, NUL, and the payload; a fragment of a
// long one begins with "LC03" and 20 bytes of header, and the first of them names the channel.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "lcmtypes/channels.h"

namespace tactus::sync {

inline constexpr std::size_t kLongestChannel = 63;

struct ChannelBytes {
  std::string_view channel;
  std::span<const std::uint8_t> data;
  bool whole = true;  // false: a piece of a message that is longer than any of ours

  // Not longer than a message of the bus may be.
  bool fits() const { return whole && data.size() <= channels::kMaxMessageBytes; }
};

// Nothing when these bytes are not of LCM, or a later fragment, which has no channel. Refers to `bytes`.
std::optional<ChannelBytes> parse_datagram(std::span<const std::uint8_t> bytes);

}  // namespace tactus::sync
