// Around a state: what says that it is one, of which version, of which world, and that it is whole.
//
//   offset  size  what
//   0       8     "TACTSTAT"
//   8       8     version of the form, kStateVersion
//   16      8     fingerprint of the world and its settings (fingerprint.h)
//   24      8     n, bytes of the state
//   32      n     the state: the members of every part, in the order in which their archive() names them
//   32 + n  8     FNV-1a (64 bit) of all that comes before
//
// Numbers are little-endian. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::sim {

// To be raised with every change of what a state holds: one of another version is refused.
inline constexpr std::uint64_t kStateVersion = 2;

std::vector<std::uint8_t> wrap_state(std::span<const std::uint8_t> state, std::uint64_t fingerprint);
// The state within. Throws BadState with one sentence when the bytes are damaged, of another version or another
// world.
std::span<const std::uint8_t> unwrap_state(std::span<const std::uint8_t> bytes, std::uint64_t fingerprint);

}  // namespace tactus::sim
