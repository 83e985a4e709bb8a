// Size and colours of everything that is written into the picture: questions, instructions, overlays, plots and the
// status word. Pure.
#pragma once

#include <Eigen/Core>
#include <string_view>

namespace tactus::visual {

struct TextLook {
  using Colour = Eigen::Vector3f;  // sRGB, 0 .. 1
  // Behind the letters; opacity 0 .. 1.
  struct Plate {
    Colour colour;
    float opacity;
  };

  float size = 1;  // factor on the size of letters, above 0
  Plate question{{0.05f, 0.06f, 0.08f}, 0.88f}, panel{{0, 0, 0}, 0.65f}, plot{{0, 0, 0}, 0.82f};
  Colour words{1, 1, 1}, quiet{0.72f, 0.76f, 0.8f};            // a question, its hint and progress
  Colour keys{1, 0.78f, 0.25f}, on_keys{0.05f, 0.06f, 0.08f};  // the keys and the mark of a question, and the numbers on the keys
  Colour status{1, 0.78f, 0.25f};
  Colour title{0.75f, 0.85f, 1}, label{0.8f, 0.8f, 0.8f}, curve{0.4f, 1, 0.6f}, old{0.6f, 0.6f, 0.6f};  // of plots

  // Pixels of a letter's pixel, whole and at least 1, for a size that is usual without the factor.
  float scaled(float pixels) const;
};

// contrast, size: the settings text_contrast and text_size. Over any picture, texts have a contrast of at least 4.5 : 1, the
// large status word of 3 : 1, and keys, marks and curves of 3 : 1 to their plate (WCAG 2.2, 1.4.3 and 1.4.11); with "high",
// texts have 7 : 1 (1.4.6).
TextLook text_look(std::string_view contrast, double size);

}  // namespace tactus::visual
