// Draws a draw list into a picture with OpenGL 3.3. A context must be current in the calling thread.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "visual_node/gl/buffers.h"
#include "visual_node/gl/program.h"
#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

class Renderer {
 public:
  // Throws std::runtime_error when a shader does not compile.
  Renderer(int width, int height, int shadow_size);

  // Geometries and reliefs that the batches of later draw lists refer to, and how many lamps there are. Takes a
  // tenth of a second on a software renderer; the first picture after it takes no longer than others.
  void load(const std::vector<Triangles>& geometries, const Lighting& lighting,
            const std::vector<Relief>& reliefs = {});
  // A picture is drawn in two parts, so that what has just become known can still be in it: the surfaces, which
  // take nearly all of the time, and then flashes and overlay. Each gives the work to the device and returns.
  void draw_scene(const DrawList& list);
  void draw_over(const DrawList& list);
  // Waits until the device has finished what it was given.
  void wait() const;
  const PictureTarget& picture() const { return picture_; }

 private:
  void warm_up(const Lighting& lighting);
  void draw_shadow(const DrawList& list);
  void draw_surfaces(const DrawList& list);
  void describe(const Program& surface, const DrawList& list) const;
  void draw_surface(const Batch& batch);
  void draw_batch(const Batch& batch);

  PictureTarget picture_;
  int shadow_size_;
  std::unique_ptr<ShadowTarget> shadow_;  // null: no lamp casts one
  std::unique_ptr<Program> surface_;
  std::unique_ptr<Program> rough_surface_;  // null: no material has a relief
  Program shadow_program_{"shadow"}, glow_{"glow"}, overlay_{"overlay"};
  std::vector<std::unique_ptr<GeometryBuffer>> geometries_;
  std::vector<std::unique_ptr<ReliefTexture>> reliefs_;
  StreamBuffer instances_, lights_;
  QuadArray glows_{static_cast<int>(sizeof(Glow) / 16)}, rects_{static_cast<int>(sizeof(Rect) / 16)};
};

}  // namespace tactus::visual
