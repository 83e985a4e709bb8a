// Actions of the keys of a window. Pure: the window passes the pressed keys.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "visual_node/overlay/overlay_set.h"

namespace tactus::visual {

enum class Action { kPauseOrResume, kStep, kReset, kFullScreen, kClose, kOverlay };
struct KeyAction {
  Action action;
  Overlay overlay = Overlay::kHelp;  // for kOverlay
  bool operator==(const KeyAction&) const = default;
};

// key: the upper case letter, digit or sign on it, or one of these.
inline constexpr int kEscape = 256, kF11 = 300;  // GLFW key codes
std::optional<KeyAction> action_of(int key);
// Help text: one line for each key.
std::vector<std::string> help_lines();

}  // namespace tactus::visual
