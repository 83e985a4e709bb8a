#include "visual_node/overlay/keys.h"

namespace tactus::visual {
namespace {

struct Key {
  int key;
  const char* name;
  KeyAction action;
  const char* description;
};
constexpr Key kKeys[] = {
    {' ', "space", {Act::kPauseOrResume}, "pause, resume"},
    {'.', ".", {Act::kStep}, "one step of 1 ms"},
    {'R', "R", {Act::kReset}, "restart"},
    {'1', "1", {Act::kOverlay, Overlay::kContacts}, "contacts"},
    {'2', "2", {Act::kOverlay, Overlay::kForces}, "forces"},
    {'3', "3", {Act::kOverlay, Overlay::kTools}, "tools"},
    {'4', "4", {Act::kOverlay, Overlay::kGroups}, "groups"},
    {'5', "5", {Act::kOverlay, Overlay::kAges}, "ages"},
    {'6', "6", {Act::kOverlay, Overlay::kDegradation}, "degradation"},
    {'7', "7", {Act::kOverlay, Overlay::kReport}, "report"},
    {'8', "8", {Act::kOverlay, Overlay::kPlots}, "plots"},
    {'H', "H", {Act::kOverlay, Overlay::kHelp}, "this help"},
    {kF11, "F11", {Act::kFullScreen}, "full screen"},
    {'F', "F", {Act::kFullScreen}, "full screen"},
    {kEscape, "escape", {Act::kClose}, "close"},
};

}  // namespace

std::optional<KeyAction> action_of(int key) {
  for (const Key& k : kKeys)
    if (k.key == key) return k.action;
  return std::nullopt;
}

std::vector<std::string> help_lines() {
  std::vector<std::string> lines;
  for (const Key& k : kKeys)
    lines.push_back(std::string(k.name) + std::string(8 - std::string(k.name).size(), ' ') + k.description);
  lines.emplace_back("mouse   left button aims the lamp");
  return lines;
}

}  // namespace tactus::visual
