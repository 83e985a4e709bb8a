// The identity of a process on the bus, and the hashes that name processes and assets.
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
// Incremental hash: start with kFnv1aBegin.
std::uint64_t fnv1a_64(std::uint64_t hash, const void* data, std::size_t size);
std::int64_t fnv1a_64(const void* data, std::size_t size);

// An id of the CLOCK_MONOTONIC of this process: two processes have the same id exactly when they read the same clock. Its
// parts are the machine's start (boot_id), the time namespace (its inode) and that namespace's monotonic offset: the inode of
// an ended namespace may be reused by one with another offset. Parts that this system lacks are left empty.
std::int32_t clock_of_this_process();
std::int32_t clock_id(std::string_view boot_id, std::uint64_t time_namespace, std::string_view monotonic_offset);

struct Identity {
  std::string node;              // process name, e.g. "audio_node"
  std::int32_t source = 0;       // hash of it
  std::int64_t incarnation = 0;  // random, > 0
  std::int64_t run_id = 1;       // of the cluster run
  std::int32_t clock = 0;        // id of the CLOCK_MONOTONIC of its times

  // Returns an identity with the clock of this process and a new random incarnation. Throws std::system_error when the system
  // provides no random numbers.
  static Identity fresh(std::string node, std::int64_t run_id);
};

// Ids of events and contacts: the low 23 bits of the incarnation above a 40-bit counter.
constexpr std::int64_t prefixed_id(std::int64_t incarnation, std::int64_t count) {
  return ((incarnation & 0x7fffff) << 40) | (count & ((std::int64_t{1} << 40) - 1));
}

}  // namespace tactus::sync
