// What the keys and the mouse of a window ask for. Pure: the window hands in what was pressed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "visual_node/overlay/kinds.h"

namespace tactus::visual {

enum class Act { kPauseOrResume, kStep, kReset, kFullScreen, kClose, kOverlay };
struct Wish {
  Act act;
  Overlay overlay = Overlay::kHelp;  // of kOverlay
  bool operator==(const Wish&) const = default;
};

// key: the upper case letter, digit or sign on it, or one of these.
inline constexpr int kEscape = 256, kF11 = 300;  // as GLFW numbers them
std::optional<Wish> wish_of(int key);
// What each key does, a line each.
std::vector<std::string> help_lines();

}  // namespace tactus::visual
