#include "visual_node/frame/text_look.h"

#include <algorithm>
#include <cmath>

namespace tactus::visual {
namespace {

TextLook bright_plates() {
  TextLook look;
  look.question = look.panel = look.plot = {{0.97f, 0.97f, 0.95f}, 0.95f};
  look.words = {0.05f, 0.05f, 0.07f}, look.quiet = {0.25f, 0.28f, 0.3f};
  look.keys = {0, 0.27f, 0.45f}, look.on_keys = {1, 1, 1};
  look.status = {0.45f, 0.2f, 0};
  look.title = {0, 0.2f, 0.45f}, look.label = {0.2f, 0.2f, 0.2f}, look.curve = {0, 0.35f, 0.2f}, look.old = {0.33f, 0.33f, 0.33f};
  return look;
}

TextLook high_contrast() {
  TextLook look;
  look.question = look.panel = look.plot = {{0, 0, 0}, 1};
  look.words = look.quiet = look.label = {1, 1, 1};
  look.keys = look.status = look.title = look.curve = {1, 1, 0};
  look.on_keys = {0, 0, 0}, look.old = {0.75f, 0.75f, 0.75f};
  return look;
}

}  // namespace

float TextLook::scaled(float pixels) const { return std::max(1.0f, std::round(pixels * size)); }

TextLook text_look(std::string_view contrast, double size) {
  TextLook look = contrast == "light" ? bright_plates() : contrast == "high" ? high_contrast() : TextLook{};
  look.size = static_cast<float>(size);
  return look;
}

}  // namespace tactus::visual
