// The tick of touch in the tests.
#pragma once

#include <cstdint>

namespace tactus::haptic::test {

inline constexpr std::int64_t kMs = 1'000'000;  // ns
inline constexpr double kDt = 1e-3;  // s

}  // namespace tactus::haptic::test
