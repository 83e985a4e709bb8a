// Who a process is on the bus, and the hashes that name processes and assets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace tactus::sync {

// FNV-1a (Fowler, Noll, Vo; draft-eastlake-fnv, section 2): small, public, and the same in every language.
constexpr std::uint32_t fnv1a_32(std::string_view text) {
  std::uint32_t h = 2166136261u;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 16777619u;
  return h;
}
inline constexpr std::uint64_t kFnv1aBegin = 14695981039346656037ull;
// Piece by piece: begin with kFnv1aBegin.
std::uint64_t fnv1a_64(std::uint64_t hash, const void* data, std::size_t size);
std::int64_t fnv1a_64(const void* data, std::size_t size);

// Names the CLOCK_MONOTONIC of this process: equal exactly where two processes read the same clock. The parts are the
// machine's start (boot_id), the time namespace (its inode) and that namespace's monotonic offset: a namespace that ended
// may leave its inode to one with another offset. Parts that this system lacks are left empty.
std::int32_t clock_of_this_process();
std::int32_t clock_id(std::string_view boot_id, std::uint64_t time_namespace, std::string_view monotonic_offset);

struct Identity {
  std::string node;              // process name, e.g. "audio_node"
  std::int32_t source = 0;       // hash of it
  std::int64_t incarnation = 0;  // random, > 0
  std::int64_t run_id = 1;       // of the cluster run
  std::int32_t clock = 0;        // which CLOCK_MONOTONIC its times are of

  // With this process' clock. Draws a fresh incarnation from the operating system. Throws std::system_error when it gives no random numbers.
  static Identity fresh(std::string node, std::int64_t run_id);
};

// Ids of events and contacts: 24 bits of the incarnation above 40 bits that count.
constexpr std::int64_t prefixed_id(std::int64_t incarnation, std::int64_t count) {
  return ((incarnation & 0x7fffff) << 40) | (count & ((std::int64_t{1} << 40) - 1));
}

}  // namespace tactus::sync
