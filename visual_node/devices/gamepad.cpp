#include "visual_node/devices/gamepad.h"

#include <algorithm>
#include <cmath>

namespace tactus::visual {

std::vector<Button> Gamepad::pressed(const GamepadStand& now) {
  std::array<bool, kButtons> held = now.held;
  for (const GamepadStand::Stick& s : now.sticks) {
    // A stick points one way: the one in which it is pushed farther.
    const bool sideways = std::abs(s.x) >= std::abs(s.y);
    const float far = sideways ? s.x : s.y;
    const Button way =
        sideways ? (far < 0 ? Button::kLeft : Button::kRight) : (far < 0 ? Button::kUp : Button::kDown);
    const auto i = static_cast<std::size_t>(way);
    held[i] = held[i] || std::abs(far) > (before_[i] ? kLetGo : kPushed);
  }
  std::vector<Button> out;
  for (std::size_t i = 0; i < kButtons; ++i)
    if (held[i] && !before_[i] && seen_) out.push_back(static_cast<Button>(i));
  before_ = held;
  seen_ = true;
  return out;
}

}  // namespace tactus::visual
