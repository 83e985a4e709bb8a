// The tick of touch in the tests.
#pragma once

namespace tactus::haptic::test {

inline constexpr double kDt = 1e-3;  // s

}  // namespace tactus::haptic::test
