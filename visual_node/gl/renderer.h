// Draws a draw list into a picture with OpenGL 3.3. A context must be current in the calling thread.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "visual_node/gl/buffers.h"
#include "visual_node/gl/labels.h"
#include "visual_node/gl/program.h"
#include "visual_node/gl/screen_passes.h"
#include "visual_node/gl/surface_programs.h"
#include "visual_node/gl/textures.h"
#include "visual_node/scene_view/draw_list.h"
#include "visual_node/scene_view/quality.h"

namespace tactus::visual {

class Renderer {
 public:
  // samples: number of samples per pixel for smooth edges. Throws std::runtime_error when a shader does not
  // compile.
  Renderer(int width, int height, int shadow_size, int samples = 1);

  // Loads the geometries, reliefs and looks that the batches of later draw lists refer to, and the lamps.
  void load(const std::vector<Triangles>& geometries, const Lighting& lighting,
            const std::vector<Relief>& reliefs = {}, const Appearance& appearance = {});
  // Sets the content of the user's shader folder. All programs that use its files are rebuilt; a program that
  // does not compile keeps its previous version.
  void set_shader_folder(ShaderFolder folder);
  // Returns and clears one sentence for each failure of the last load or change of shaders.
  std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }
  // Draws every kind of picture of the loaded scene with this list, so that no later picture takes longer than
  // others at any quality. A software renderer takes a quarter of a second for each kind of surface when
  // it first draws it. meanwhile: called regularly.
  void warm_up(
      DrawList list, const std::function<void()>& meanwhile = [] {});
  // Quality of the next pictures.
  void set_quality(const Quality& quality) { quality_ = quality; }
  // A picture is drawn in two parts, so that it can include late events: first the surfaces, which take nearly
  // all of the time, then flashes and overlay. Each call submits the work to the device and returns.
  void draw_scene(const DrawList& list);
  void draw_flashes_and_overlay(const DrawList& list);
  // Waits until the device has finished all submitted work; false when it does not within 1 s, or cannot.
  bool wait() const;
  const PictureTarget& picture() const { return picture_; }

 private:
  const ShadowTarget* shadow() const;
  std::pair<int, int> bind_scaled_target() const;
  void draw_shadow(const DrawList& list, const ShadowTarget& shadow);
  void draw_surfaces(const DrawList& list);
  void draw_surfaces(const DrawList& list, const Camera& camera);
  void draw_glows(const DrawList& list, std::pair<int, int> size);
  void draw_strokes(const DrawList& list);
  void scale_up();
  void describe(const Program& surface, const Look& look, const DrawList& list, const Camera& camera) const;
  void draw_sky(const DrawList& list, const Camera& camera);
  void draw_surface(const Batch& batch, bool translucent);
  void draw_translucent(const Batch& batch);
  void draw_batch(const Batch& batch);

  PictureTarget picture_, small_;  // small_ is the target at less than full scale
  int shadow_size_;
  Quality quality_;
  std::unique_ptr<ShadowTarget> shadow_, coarse_shadow_;  // null: no lamp casts a shadow
  std::unique_ptr<MultisampleTarget> samples_;            // null: one sample a pixel
  ShaderLibrary library_;
  ShaderFolder folder_;
  SurfacePrograms surfaces_;
  ScreenPasses passes_;
  std::vector<std::unique_ptr<SurfaceTexture>> colours_, normals_;  // by index of the picture; null: not used as such
  std::unique_ptr<EnvironmentTexture> environment_;
  bool sky_ = false;  // the environment is a picture and visible
  std::vector<std::string> warnings_;
  Program shadow_program_{"shadow"}, glow_{"glow"}, overlay_{"overlay"}, upscale_{"upscale"}, sky_program_{"sky"},
      stroke_{"stroke"};
  Labels labels_;
  std::vector<std::unique_ptr<GeometryBuffer>> geometries_;
  std::vector<std::unique_ptr<ReliefTexture>> reliefs_;
  StreamBuffer instances_, lights_;
  QuadArray glows_{static_cast<int>(sizeof(Glow) / 16)}, rects_{static_cast<int>(sizeof(Rect) / 16)}, scaled_{2},
      sky_quad_{1}, strokes_{static_cast<int>(sizeof(Stroke) / 16)};
};

}  // namespace tactus::visual
