// Decodes received bytes: accepts only exactly one valid message of the right type.
#pragma once

#include <cstdint>
#include <exception>
#include <optional>
#include <vector>

#include "lcmtypes/channels.h"
#include "lcmtypes/valid.h"

namespace tactus::sync {

// nullopt when the bytes are truncated, too many, of another type, or hold a value out of range.
template <class Message>
std::optional<Message> decode(const void* data, std::size_t size) {
  if (size > channels::kMaxMessageBytes) return std::nullopt;
  try {
    Message m{};
    if (m.decode(data, 0, static_cast<int>(size)) != static_cast<int>(size) || !valid(m)) return std::nullopt;
    return m;
  } catch (const std::exception&) {
    return std::nullopt;  // the generated decoder throws on hostile lengths
  }
}

// The same for an asset: without a size limit, but with the same validation.
template <class Asset>
std::optional<Asset> decode_asset(const std::vector<std::uint8_t>& bytes) {
  try {
    Asset a{};
    if (a.decode(bytes.data(), 0, static_cast<int>(bytes.size())) != static_cast<int>(bytes.size()) || !valid(a))
      return std::nullopt;
    return a;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

template <class Message>
std::vector<std::uint8_t> encode(const Message& m) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(m.getEncodedSize()));
  m.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace tactus::sync
