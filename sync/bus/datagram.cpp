#include "sync/bus/datagram.h"

#include <algorithm>

namespace tactus::sync {
namespace {

constexpr std::size_t kShortHeader = 8;      // magic, sequence number
constexpr std::size_t kFragmentHeader = 20;  // and size of the message, offset, number and count of fragments
constexpr std::size_t kFragmentNumberAt = 16;

bool begins_with(std::span<const std::uint8_t> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

std::optional<ChannelBytes> after_header(std::span<const std::uint8_t> bytes, bool complete) {
  const auto end = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
  const auto length = static_cast<std::size_t>(end - bytes.begin());
  if (end == bytes.end() || length == 0 || length > kMaxChannelBytes) return std::nullopt;
  return ChannelBytes{{reinterpret_cast<const char*>(bytes.data()), length}, bytes.subspan(length + 1), complete};
}

}  // namespace

std::optional<ChannelBytes> parse_datagram(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kShortHeader && begins_with(bytes, "LC02"))
    return after_header(bytes.subspan(kShortHeader), true);
  if (bytes.size() > kFragmentHeader && begins_with(bytes, "LC03") && bytes[kFragmentNumberAt] == 0 &&
      bytes[kFragmentNumberAt + 1] == 0)
    return after_header(bytes.subspan(kFragmentHeader), false);
  return std::nullopt;
}

}  // namespace tactus::sync
