// Envelope of a saved state, with magic, version, fingerprint of the world, and checksum.
//
// offset  size  what
// 0       8     "TACTSTAT"
// 8       8     version of the format, kStateVersion
// 16      8     fingerprint of the world and its settings (fingerprint.h)
// 24      8     n, bytes of the state
// 32      n     the state: the members of every part, in the order of their archive()
// 32 + n  8     FNV-1a (64 bit) of all preceding bytes
//
// Numbers are little-endian. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::sim {

// Increase it with every change of the content of a state: a state of another version is rejected.
inline constexpr std::uint64_t kStateVersion = 5;

std::vector<std::uint8_t> wrap_state(std::span<const std::uint8_t> state, std::uint64_t fingerprint);
// Returns the state inside. Throws InvalidState with one sentence when the bytes are damaged, or of another
// version or world.
std::span<const std::uint8_t> unwrap_state(std::span<const std::uint8_t> bytes, std::uint64_t fingerprint);

}  // namespace tactus::sim
