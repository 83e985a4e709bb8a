#include "sim_node/model/envelope.h"

#include <algorithm>
#include <string_view>

#include "sim_node/model/state_archive.h"
#include "sync/bus/identity.h"

namespace tactus::sim {
namespace {

constexpr std::string_view kMagic = "TACTSTAT";
constexpr std::size_t kHead = 32, kTail = 8;

void append(std::vector<std::uint8_t>& out, std::uint64_t x) {
  const auto* from = reinterpret_cast<const std::uint8_t*>(&x);
  out.insert(out.end(), from, from + sizeof x);
}

std::uint64_t number_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint64_t x = 0;
  std::memcpy(&x, bytes.data() + offset, sizeof x);
  return x;
}

std::uint64_t hash_of(std::span<const std::uint8_t> bytes) {
  return sync::fnv1a_64(sync::kFnv1aBegin, bytes.data(), bytes.size());
}

}  // namespace

std::vector<std::uint8_t> wrap_state(std::span<const std::uint8_t> state, std::uint64_t fingerprint) {
  std::vector<std::uint8_t> out(kMagic.begin(), kMagic.end());
  out.reserve(kHead + state.size() + kTail);
  append(out, kStateVersion);
  append(out, fingerprint);
  append(out, state.size());
  out.insert(out.end(), state.begin(), state.end());
  append(out, hash_of(out));
  return out;
}

std::span<const std::uint8_t> unwrap_state(std::span<const std::uint8_t> bytes, std::uint64_t fingerprint) {
  if (bytes.size() < kHead + kTail || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin()))
    throw InvalidState("the bytes are not a saved state of a simulation");
  if (number_at(bytes, 8) != kStateVersion)
    throw InvalidState("the state has version " + std::to_string(number_at(bytes, 8)) +
                       ", this program reads version " + std::to_string(kStateVersion));
  const std::size_t size = bytes.size() - kHead - kTail;
  if (number_at(bytes, 24) != size || number_at(bytes, kHead + size) != hash_of(bytes.first(kHead + size)))
    throw InvalidState("the state is damaged");
  if (number_at(bytes, 16) != fingerprint)
    throw InvalidState("the state belongs to another scene or to other settings");
  return bytes.subspan(kHead, size);
}

}  // namespace tactus::sim
