// Reads the header of a message of any type: every type of this system begins with it, after LCM's fingerprint of 8 bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tactus/header_t.hpp>

namespace tactus::sync {

// nullopt when the bytes are too few or their values cannot be a header, as in a message of another system.
inline std::optional<header_t> peek_header(const void* data, std::size_t size) {
  constexpr int kFingerprintBytes = 8;
  constexpr std::int64_t kMaxTime_ns = 1'000'000'000'000'000'000;  // as lcmtypes/valid.cpp
  header_t h{};
  if (size > INT32_MAX ||
      h._decodeNoHash(data, kFingerprintBytes, static_cast<int>(size) - kFingerprintBytes) < 0 ||
      h.sim_time_ns < -1 || h.sim_time_ns > kMaxTime_ns || h.publish_time_ns < 0 ||
      h.publish_time_ns > kMaxTime_ns || h.run_id <= 0 || h.incarnation <= 0 || h.seq < 0)
    return std::nullopt;
  return h;
}

}  // namespace tactus::sync
