// Draws labels over the picture. A text picture is uploaded when it is first drawn, and stays while pictures use
// it.
#pragma once

#include <memory>
#include <vector>

#include "visual_node/gl/buffers.h"
#include "visual_node/gl/program.h"
#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

// The coverage of a text picture on the device.
class TextTexture {
 public:
  explicit TextTexture(const TextPicture& picture);
  unsigned id() const { return id_; }

 private:
  GlObject id_{GlObject::Kind::kTexture};
};

class Labels {
 public:
  // Draws into the bound picture of that size, with blending as set by the caller. A label without a picture, or
  // with rows outside of it, is left out.
  void draw(const std::vector<Label>& labels, int width, int height);
  // Number of text pictures on the device.
  std::size_t stored() const { return stored_.size(); }

 private:
  struct Stored {
    std::shared_ptr<const TextPicture> picture;
    std::unique_ptr<TextTexture> texture;
    bool used = false;
  };
  Stored& store(const std::shared_ptr<const TextPicture>& picture);

  Program program_{"label"};
  QuadArray quads_{3};
  std::vector<Stored> stored_;
};

}  // namespace tactus::visual
