// Which buttons of a gamepad were pressed since it was looked at last; a stick that is pushed is the pad of
// arrows. Pure: the window hands in how the gamepad stands.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tactus::visual {

// By their places on the Xbox controller, which GLFW's and the W3C's standard mapping have.
enum class Button { kA, kB, kX, kY, kLeft, kRight, kUp, kDown };
inline constexpr std::size_t kButtons = 8;

struct GamepadStand {
  std::array<bool, kButtons> held{};  // in the order of Button
  // Of each stick, -1 .. 1 from left to right and from up to down.
  struct Stick {
    float x = 0, y = 0;
  };
  std::array<Stick, 2> sticks{};
};

class Gamepad {
 public:
  // Design: past the half is meant, and what rests within a third has been let go.
  static constexpr float kPushed = 0.6f, kLetGo = 0.35f;

  // What was pressed anew. What is held at the first look counts as pressed before.
  std::vector<Button> pressed(const GamepadStand& now);
  // It was taken away.
  void forget() { *this = {}; }

 private:
  std::array<bool, kButtons> before_{};
  bool seen_ = false;
};

}  // namespace tactus::visual
