// Decodes received bytes: accepts only exactly one valid message of the right type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <vector>

#include "lcmtypes/channels.h"
#include "lcmtypes/valid.h"

namespace tactus::sync {

// The message of an asset, without a size limit. nullopt when the bytes are truncated, too many, of another type, or hold a
// value out of range.
template <class Message>
std::optional<Message> decode_asset(std::span<const std::uint8_t> bytes) {
  try {
    Message m{};
    const int size = static_cast<int>(bytes.size());
    if (m.decode(bytes.data(), 0, size) != size || !valid(m)) return std::nullopt;
    return m;
  } catch (const std::exception&) {
    return std::nullopt;  // the generated decoder throws on hostile lengths
  }
}

// The same for a message of the bus.
template <class Message>
std::optional<Message> decode(const void* data, std::size_t size) {
  if (size > channels::kMaxMessageBytes) return std::nullopt;
  return decode_asset<Message>({static_cast<const std::uint8_t*>(data), size});
}

template <class Message>
std::vector<std::uint8_t> encode(const Message& m) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(m.getEncodedSize()));
  m.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace tactus::sync
