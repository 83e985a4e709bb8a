#include "visual_node/overlay/keys.h"

namespace tactus::visual {
namespace {

struct Key {
  int key;
  const char* name;
  KeyAction action;
  const char* description;
};
constexpr Key kKeyTable[] = {
    {' ', "space", {Action::kPauseOrResume}, "pause, resume"},
    {'.', ".", {Action::kStep}, "one step of 1 ms"},
    {'R', "R", {Action::kReset}, "restart"},
    {'1', "1", {Action::kOverlay, Overlay::kContacts}, "contacts"},
    {'2', "2", {Action::kOverlay, Overlay::kForces}, "forces"},
    {'3', "3", {Action::kOverlay, Overlay::kTools}, "tools"},
    {'4', "4", {Action::kOverlay, Overlay::kGroups}, "groups"},
    {'5', "5", {Action::kOverlay, Overlay::kAges}, "ages"},
    {'6', "6", {Action::kOverlay, Overlay::kDegradation}, "degradation"},
    {'7', "7", {Action::kOverlay, Overlay::kReport}, "report"},
    {'8', "8", {Action::kOverlay, Overlay::kPlots}, "plots"},
    {'H', "H", {Action::kOverlay, Overlay::kHelp}, "this help"},
    {kF11, "F11", {Action::kFullScreen}, "full screen"},
    {'F', "F", {Action::kFullScreen}, "full screen"},
    {kEscape, "escape", {Action::kClose}, "close"},
};

}  // namespace

std::optional<KeyAction> action_of(int key) {
  for (const Key& k : kKeyTable)
    if (k.key == key) return k.action;
  return std::nullopt;
}

std::vector<std::string> help_lines() {
  std::vector<std::string> lines;
  for (const Key& k : kKeyTable)
    lines.push_back(std::string(k.name) + std::string(8 - std::string(k.name).size(), ' ') + k.description);
  lines.emplace_back("mouse   left button aims the lamp");
  return lines;
}

}  // namespace tactus::visual
