// What a measured mode of a material may be (measured_mode_t).
#pragma once

namespace tactus {

inline constexpr int kMaxMeasuredModes = 128;  // as many as sound renders of one body
inline constexpr double kMinModeFrequency_Hz = 20, kMaxModeFrequency_Hz = 20'000;  // what people hear

}  // namespace tactus
