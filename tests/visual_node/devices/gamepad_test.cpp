#include "visual_node/devices/gamepad.h"

#include <catch2/catch.hpp>

using namespace tactus::visual;

namespace {

GamepadState held(std::initializer_list<Button> buttons) {
  GamepadState s;
  for (const Button b : buttons) s.held[static_cast<std::size_t>(b)] = true;
  return s;
}
GamepadState pushed(float x, float y, std::size_t stick = 0) {
  GamepadState s;
  s.sticks[stick] = {x, y};
  return s;
}
using Buttons = std::vector<Button>;

}  // namespace

TEST_CASE("A gamepad button is reported once, when it goes down") {
  Gamepad pad;
  CHECK(pad.pressed(held({Button::kB})).empty());  // held when the gamepad was found
  CHECK(pad.pressed(held({Button::kB, Button::kA})) == Buttons{Button::kA});
  CHECK(pad.pressed(held({Button::kA})).empty());
  CHECK(pad.pressed(held({Button::kA, Button::kB})) == Buttons{Button::kB});
  pad.reset();
  CHECK(pad.pressed(held({Button::kX})).empty());
}

TEST_CASE("A pushed stick is reported as an arrow once until it is released, despite jitter") {
  for (const std::size_t stick : {0u, 1u}) {
    Gamepad pad;
    pad.pressed({});
    CHECK(pad.pressed(pushed(0.5f, 0.3f, stick)).empty());
    CHECK(pad.pressed(pushed(0.7f, 0.3f, stick)) == Buttons{Button::kRight});
    for (const float x : {0.59f, 0.61f, 0.4f, 1.0f}) CHECK(pad.pressed(pushed(x, 0.1f, stick)).empty());
    CHECK(pad.pressed(pushed(0.3f, 0, stick)).empty());
    CHECK(pad.pressed(pushed(0.7f, 0, stick)) == Buttons{Button::kRight});
    CHECK(pad.pressed(pushed(-0.9f, 0.8f, stick)) == Buttons{Button::kLeft});
    CHECK(pad.pressed(pushed(0, -1, stick)) == Buttons{Button::kUp});
    CHECK(pad.pressed(pushed(0, 1, stick)) == Buttons{Button::kDown});
  }
}
