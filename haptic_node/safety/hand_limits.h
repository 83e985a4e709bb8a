// Motions that no hand makes between two ticks.
#pragma once

namespace tactus::haptic {

// Faster than any hand (that of a pitcher reaches 40 m/s): the device jumped, as a replayed motion may; no work is
// counted.
inline constexpr double kMaxHandSpeed_m_s = 40;
// The same for rotation: one revolution per tenth of a second (design: twice the speed of a wrist).
inline constexpr double kMaxHandSpin_rad_s = 63;

}  // namespace tactus::haptic
