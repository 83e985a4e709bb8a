#include "visual_node/frame/text_look.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tactus::visual;

namespace {

using Colour = TextLook::Colour;

// WCAG 2.2, "relative luminance": of a colour in sRGB.
double relative_luminance(const Colour& c) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(c.x()) + 0.7152 * linear(c.y()) + 0.0722 * linear(c.z());
}

// WCAG 2.2, "contrast ratio", 1 .. 21.
double contrast_ratio(const Colour& a, const Colour& b) {
  const double x = relative_luminance(a), y = relative_luminance(b);
  return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

// The renderer blends texts and plates in sRGB (shaders/overlay.frag).
Colour over(const TextLook::Plate& plate, const Colour& picture) {
  return plate.opacity * plate.colour + (1 - plate.opacity) * picture;
}

}  // namespace

TEST_CASE("Every text has the promised contrast over any picture") {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> share(0, 1);
  std::vector<Colour> pictures{{0, 0, 0}, {1, 1, 1}};
  for (int i = 0; i < 500; ++i) pictures.push_back({share(random), share(random), share(random)});
  for (const char* name : {"dark", "light", "high"}) {
    const TextLook look = text_look(name, 1);
    const double text = std::string_view(name) == "high" ? 7 : 4.5;
    // The status word is large: 14 bold pixels a capital in a picture of 640 x 480.
    const double large = std::string_view(name) == "high" ? 7 : 3;
    for (const Colour& picture : pictures) {
      CAPTURE(name, picture.transpose());
      const Colour question = over(look.question, picture), panel = over(look.panel, picture), plot = over(look.plot, picture);
      for (const Colour& c : {look.words, look.quiet}) CHECK(contrast_ratio(c, question) >= text);
      CHECK(contrast_ratio(look.keys, question) >= 3);
      CHECK(contrast_ratio(look.words, panel) >= text);
      CHECK(contrast_ratio(look.status, panel) >= large);
      for (const Colour& c : {look.title, look.label, look.old}) CHECK(contrast_ratio(c, plot) >= text);
      CHECK(contrast_ratio(look.curve, plot) >= 3);
    }
    CHECK(contrast_ratio(look.on_keys, look.keys) >= text);
  }
}

TEST_CASE("The size of letters is a whole number of pixels and at least one") {
  CHECK(text_look("dark", 1).scaled(2) == 2);
  CHECK(text_look("dark", 1.5).scaled(3) == 5);
  CHECK(text_look("light", 2).scaled(2) == 4);
  CHECK(text_look("high", 0.5).scaled(1) == 1);
}
