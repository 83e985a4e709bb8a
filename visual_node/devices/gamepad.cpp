#include "visual_node/devices/gamepad.h"

#include <cmath>

namespace tactus::visual {

std::vector<Button> Gamepad::pressed(const GamepadState& now) {
  std::array<bool, kButtons> held = now.held;
  for (const GamepadState::Stick& s : now.sticks) {
    // A stick counts as an arrow in the direction of its larger axis.
    const bool sideways = std::abs(s.x) >= std::abs(s.y);
    const float deflection = sideways ? s.x : s.y;
    const Button arrow =
        sideways ? (deflection < 0 ? Button::kLeft : Button::kRight) : (deflection < 0 ? Button::kUp : Button::kDown);
    const auto i = static_cast<std::size_t>(arrow);
    held[i] = held[i] || std::abs(deflection) > (before_[i] ? kReleased : kPushed);
  }
  std::vector<Button> out;
  for (std::size_t i = 0; i < kButtons; ++i)
    if (held[i] && !before_[i] && seen_) out.push_back(static_cast<Button>(i));
  before_ = held;
  seen_ = true;
  return out;
}

}  // namespace tactus::visual
