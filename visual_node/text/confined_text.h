// Draws text of any language in a confined process, the program draw_text (sync/sandbox/README.md): its libraries
// parse fonts and the text of a study, and no fault of theirs reaches the node.
#pragma once

#include "sync/sandbox/reader_session.h"
#include "visual_node/text/text_blocks.h"

namespace tactus::visual {

class ConfinedText {
 public:
  // The process starts with the first request and ends with the thread that made it.
  ConfinedText();

  // Throws std::runtime_error with one clause: the program is missing, or it failed. Not for the loop of a node:
  // it takes 10 ms to 1 s, and at most kTimeout. One thread only.
  DrawnText draw(const TextRequest& request);

  static constexpr std::chrono::seconds kTimeout{20};  // design: far more than fonts on a network take

 private:
  sync::ReaderSession session_;
};

}  // namespace tactus::visual
