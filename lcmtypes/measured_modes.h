// Limits of the measured modes of a material (measured_mode_t).
#pragma once

namespace tactus {

inline constexpr int kMaxMeasuredModes = 128;  // the number of modes that audio_node renders for one body
inline constexpr double kMinModeFrequency_Hz = 20, kMaxModeFrequency_Hz = 20'000;  // the audible range

}  // namespace tactus
