// Detects newly pressed buttons of a gamepad; a pushed stick counts as an arrow of the D-pad. Pure: the caller
// passes the state of the gamepad.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tactus::visual {

// Named by position on the Xbox controller, as in the standard mappings of GLFW and the W3C.
enum class Button { kA, kB, kX, kY, kLeft, kRight, kUp, kDown };
inline constexpr std::size_t kButtons = 8;

struct GamepadState {
  std::array<bool, kButtons> held{};  // in the order of Button
  // Axes of each stick, -1 .. 1: left to right, and up to down.
  struct Stick {
    float x = 0, y = 0;
  };
  std::array<Stick, 2> sticks{};
};

class Gamepad {
 public:
  // Design: a deflection above 0.6 is deliberate; below 0.35, about a third, the stick is at rest.
  static constexpr float kPushed = 0.6f, kReleased = 0.35f;

  // Returns the newly pressed buttons. Buttons held at the first call do not count as newly pressed.
  std::vector<Button> pressed(const GamepadState& now);
  // The gamepad was disconnected.
  void reset() { *this = {}; }

 private:
  std::array<bool, kButtons> before_{};
  bool seen_ = false;
};

}  // namespace tactus::visual
