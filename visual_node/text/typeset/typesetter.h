// Typesets paragraphs of any language with Pango: order of writing, joined letters, marks, fonts for each script,
// line breaks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "visual_node/text/text_blocks.h"

namespace tactus::visual {

// A cluster: the smallest piece of text with a place of its own, for example a letter with its marks.
struct TextCluster {
  std::size_t first_byte = 0;  // in the text
  int x_px = 0, width_px = 0;  // from the left edge of the line
  int line = 0;
};

// Uses the fonts that fontconfig finds, sans-serif first. Thread-safe: no. Realtime-safe: no.
class Typesetter {
 public:
  Typesetter();
  ~Typesetter();
  Typesetter(const Typesetter&) = delete;
  Typesetter& operator=(const Typesetter&) = delete;

  // Throws std::runtime_error with one clause when the text is no UTF-8, or larger than a text picture.
  DrawnText draw(const TextRequest& request);
  // From left to right, line by line.
  std::vector<TextCluster> clusters(const TextBlock& block);

 private:
  struct Fonts;
  std::unique_ptr<Fonts> fonts_;
};

}  // namespace tactus::visual
