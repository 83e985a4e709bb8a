#include "visual_node/gl/renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tactus/uniform_t.hpp>

namespace tactus::visual {
namespace {

// Clip space -1 .. 1 to texture coordinates 0 .. 1.
Eigen::Matrix4f texture_from_clip() {
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity() * 0.5f;
  m.col(3) << 0.5f, 0.5f, 0.5f, 1.0f;
  return m;
}

void enable(unsigned what, bool on) { on ? glEnable(what) : glDisable(what); }

std::vector<View> views_in(const DrawList& list) {
  return list.views.empty() ? std::vector<View>{{.camera = list.camera}} : list.views;
}

// Sets the viewport of a view in a picture of that size. Adjacent parts share no pixel and leave no gap.
void set(const View& view, std::pair<int, int> size) {
  const auto at = [](float share, int pixels) {
    return static_cast<int>(std::lround(share * static_cast<float>(pixels)));
  };
  const int x = at(view.x, size.first), y = at(view.y, size.second);
  glViewport(x, y, at(view.x + view.width, size.first) - x, at(view.y + view.height, size.second) - y);
  glColorMask(view.red, view.green, view.blue, GL_TRUE);
}

void unset(std::pair<int, int> size) {
  glViewport(0, 0, size.first, size.second);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

int scaled(int pixels, double scale) { return std::max(1, static_cast<int>(std::lround(pixels * scale))); }

// Small pictures are scaled up in encoded form where the driver can read sRGB without decoding it.
bool reads_encoded() {
  static const bool can = epoxy_has_gl_extension("GL_EXT_texture_sRGB_decode");
  return can;
}

}  // namespace

Renderer::Renderer(int width, int height, int shadow_size, int samples)
    : picture_(width, height), small_(width, height), shadow_size_(shadow_size) {
  if (samples > 1) {
    samples_ = std::make_unique<MultisampleTarget>(width, height, samples);
    if (samples_->samples() != samples)
      warnings_.push_back("anti_aliasing=" + std::to_string(samples) + ": this device supports " +
                          std::to_string(samples_->samples()) + " samples per pixel");
  }
  load({}, {});
}

void Renderer::load(const std::vector<Triangles>& geometries, const Lighting& lighting,
                    const std::vector<Relief>& reliefs, const Appearance& appearance) {
  const bool shadows = lighting.shadow_light >= 0;
  shadow_ = shadows ? std::make_unique<ShadowTarget>(shadow_size_) : nullptr;
  coarse_shadow_ = shadows ? std::make_unique<ShadowTarget>(shadow_size_ / 2) : nullptr;
  library_ = ShaderLibrary(appearance.shaders);
  library_.set(folder_);
  surfaces_ = SurfacePrograms(library_, appearance.looks, lighting, !reliefs.empty(), warnings_);
  passes_ = ScreenPasses(library_, appearance.passes, picture_.width(), picture_.height(), warnings_);
  colours_.clear(), normals_.clear();
  colours_.resize(appearance.pictures.size()), normals_.resize(appearance.pictures.size());
  const auto make = [&](auto& textures, int index, bool encoded) {
    if (index < 0 || textures[static_cast<std::size_t>(index)]) return;
    textures[static_cast<std::size_t>(index)] =
        std::make_unique<SurfaceTexture>(appearance.pictures[static_cast<std::size_t>(index)], encoded);
  };
  for (const Look& look : appearance.looks)
    make(colours_, look.colour_map, true), make(normals_, look.normal_map, false);
  sky_ = appearance.environment >= 0;
  environment_ = sky_ ? std::make_unique<EnvironmentTexture>(
                            appearance.pictures[static_cast<std::size_t>(appearance.environment)])
                      : std::make_unique<EnvironmentTexture>(lighting.background);
  reliefs_.clear();
  for (const Relief& r : reliefs) reliefs_.push_back(std::make_unique<ReliefTexture>(r));
  geometries_.clear();
  for (const Triangles& t : geometries) geometries_.push_back(std::make_unique<GeometryBuffer>(t));
}

void Renderer::set_shader_folder(ShaderFolder folder) {
  folder_ = std::move(folder);
  library_.set(folder_);
  surfaces_.reload(library_, warnings_);
  passes_.reload(library_, warnings_);
}

// Drivers compile a program when it first draws, and again for each new combination within a picture or the next
// one: a software renderer took 0.2 s for the first flash and 0.1 s for the second picture.
void Renderer::warm_up(DrawList list, const std::function<void()>& meanwhile) {
  const auto first = static_cast<int>(list.instances.size());
  list.instances.emplace_back();
  // All kinds of surfaces of the scene are in the list, except those of the tools, which are not in use yet.
  for (auto* batches : {&list.opaque, &list.translucent})
    batches->push_back({.geometry = 0, .first = first, .count = 1, .casts_shadow = true});
  list.glows.push_back(
      {Eigen::Vector4f::Zero(), Eigen::Vector4f::Zero(), Eigen::Vector4f::Zero(), Eigen::Vector4f::Zero()});
  list.strokes.push_back({Eigen::Vector4f::Zero(), Eigen::Vector4f::Zero(), Eigen::Vector4f::Zero()});
  list.overlay.emplace_back();
  list.labels.push_back({.text = std::make_shared<TextPicture>(TextPicture{1, 1, {0}}), .rows = 1});
  const Quality before = quality_;
  const auto draw = [&](const DrawList& picture, const Quality& q) {
    quality_ = q;
    draw_scene(picture);
    draw_flashes_and_overlay(picture);
    wait();
    meanwhile();
  };
  const Quality &best = kQualities.front(), &last = kQualities.back();
  // One kind of surface at a time: all of them together take seconds.
  for (const bool through : {false, true}) {
    std::set<std::pair<bool, int>> drawn;
    for (const Batch& batch : through ? list.translucent : list.opaque) {
      if (!drawn.emplace(batch.relief >= 0, batch.look).second) continue;
      DrawList one = list;
      one.opaque.clear(), one.translucent.clear();
      (through ? one.translucent : one.opaque).push_back(batch);
      for (const Quality& q : {best, last}) draw(one, q);
    }
  }
  // Both shadow modes twice; then the remaining qualities, which have no programs of their own.
  std::vector<Quality> kinds{best, last, best, last, degraded(best, 0.5)};
  kinds.insert(kinds.end(), kQualities.begin() + 1, kQualities.end() - 1);
  for (const Quality& q : kinds) draw(list, q);
  quality_ = before;
}

const ShadowTarget* Renderer::shadow() const {
  return quality_.shadow_divisor == 0 ? nullptr : (quality_.shadow_divisor == 1 ? shadow_ : coarse_shadow_).get();
}

void Renderer::draw_scene(const DrawList& list) {
  instances_.write(list.instances.data(), list.instances.size() * sizeof(Instance));
  if (shadow()) draw_shadow(list, *shadow());
  draw_surfaces(list);
  if (quality_.scale < 1 && !quality_.coarse) scale_up();
  if (!quality_.coarse) passes_.draw(picture_);
}

void Renderer::draw_flashes_and_overlay(const DrawList& list) {
  std::pair size{picture_.width(), picture_.height()};
  if (quality_.coarse)
    size = bind_scaled_target();
  else
    picture_.bind();
  draw_glows(list, size);
  if (quality_.coarse) {
    scale_up();
    passes_.draw(picture_);  // includes the blocks and flashes
    picture_.bind();
  }
  glDisable(GL_FRAMEBUFFER_SRGB);  // these colours are already encoded
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  draw_strokes(list);
  overlay_.use();
  overlay_.set("size",
               Eigen::Vector2f(static_cast<float>(picture_.width()), static_cast<float>(picture_.height())));
  rects_.draw(list.overlay.data(), list.overlay.size());
  labels_.draw(list.labels, picture_.width(), picture_.height());
  glDisable(GL_BLEND);
}

void Renderer::draw_glows(const DrawList& list, std::pair<int, int> size) {
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glow_.use();
  glow_.set("exposure", list.lighting.exposure);
  for (const View& view : views_in(list)) {
    set(view, size);
    glow_.set("clip_from_world", view.camera.clip_from_world());
    glows_.draw(list.glows.data(), list.glows.size());
  }
  unset(size);
}

// Uses the blending and colours of the overlay; a profile that makes pictures coarse keeps these lines fine.
void Renderer::draw_strokes(const DrawList& list) {
  if (list.strokes.empty()) return;
  glDisable(GL_DEPTH_TEST);
  stroke_.use();
  const std::pair size{picture_.width(), picture_.height()};
  for (const View& view : views_in(list)) {
    set(view, size);
    stroke_.set("clip_from_world", view.camera.clip_from_world());
    stroke_.set("size", Eigen::Vector2f(view.width * static_cast<float>(size.first),
                                        view.height * static_cast<float>(size.second)));
    strokes_.draw(list.strokes.data(), list.strokes.size());
  }
  unset(size);
}

// Returns the size of the bound target.
std::pair<int, int> Renderer::bind_scaled_target() const {
  if (quality_.scale == 1) {
    picture_.bind();
    return {picture_.width(), picture_.height()};
  }
  const std::pair size{scaled(small_.width(), quality_.scale), scaled(small_.height(), quality_.scale)};
  small_.bind(size.first, size.second);
  return size;
}

void Renderer::scale_up() {
  const auto width = static_cast<float>(small_.width()), height = static_cast<float>(small_.height());
  const auto used_width = static_cast<float>(scaled(small_.width(), quality_.scale)),
             used_height = static_cast<float>(scaled(small_.height(), quality_.scale));
  picture_.bind();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  enable(GL_FRAMEBUFFER_SRGB, !reads_encoded());
  upscale_.use();
  upscale_.set("small", 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, small_.texture());
  if (reads_encoded()) glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SRGB_DECODE_EXT, GL_SKIP_DECODE_EXT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, quality_.coarse ? GL_NEAREST : GL_LINEAR);
  // The used part of the texture, and the centres of its outermost texels: beyond them lie remains of other
  // pictures.
  const std::array<float, 8> instance{
      used_width / width,          used_height / height,         0, 0, 0.5f / width, 0.5f / height,
      (used_width - 0.5f) / width, (used_height - 0.5f) / height};
  scaled_.draw(instance.data(), 1);
}

void Renderer::draw_shadow(const DrawList& list, const ShadowTarget& shadow) {
  shadow.bind();
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 4.0f);  // 1.5 texels of slope: the filter also reads the neighbouring texel
  shadow_program_.use();
  shadow_program_.set("clip_from_world", list.lighting.shadow_clip);
  for (const Batch& b : list.opaque)
    if (b.casts_shadow) draw_batch(b);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void Renderer::draw_surfaces(const DrawList& list) {
  const std::pair size = bind_scaled_target();
  const bool resolves = samples_ != nullptr;
  if (resolves) samples_->bind(size.first, size.second);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_DEPTH_TEST);
  const Eigen::Vector3f background = list.lighting.background * list.lighting.exposure;
  glClearColor(background.x(), background.y(), background.z(), 1);
  glClear(GL_COLOR_BUFFER_BIT);

  std::vector<Light> lights = list.lighting.lights;
  if (lights.empty()) lights.push_back({});  // a dark lamp: its colours are 0
  glBindBuffer(GL_UNIFORM_BUFFER, lights_.id());
  glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(lights.size() * sizeof(Light)), lights.data(),
               GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, lights_.id());
  if (shadow()) {
    glActiveTexture(GL_TEXTURE0 + kShadowUnit);
    glBindTexture(GL_TEXTURE_2D, shadow()->texture());
  }
  glActiveTexture(GL_TEXTURE0 + kEnvironmentUnit);
  glBindTexture(GL_TEXTURE_CUBE_MAP, environment_->id());
  for (const View& view : views_in(list)) {
    set(view, size);
    draw_surfaces(list, view.camera);
  }
  unset(size);
  glDisable(GL_CULL_FACE);
  if (resolves) samples_->resolve(quality_.scale == 1 ? picture_ : small_, size.first, size.second);
}

// Draws one view, in the current viewport.
void Renderer::draw_surfaces(const DrawList& list, const Camera& camera) {
  surfaces_.for_each(shadow() != nullptr,
                     [&](const Program& p, const Look& look) { describe(p, look, list, camera); });
  glDepthMask(GL_TRUE);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDisable(GL_BLEND);
  for (const Batch& b : list.opaque) draw_surface(b, false);
  if (sky_) draw_sky(list, camera);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  for (const Batch& b : list.translucent) draw_surface(b, true);
}

void Renderer::describe(const Program& surface, const Look& look, const DrawList& list,
                        const Camera& camera) const {
  surface.use();
  surface.set("clip_from_world", camera.clip_from_world());
  surface.set("shadow_from_world", Eigen::Matrix4f(texture_from_clip() * list.lighting.shadow_clip));
  surface.set("eye", camera.eye);
  surface.set("ambient_light", list.lighting.ambient);
  surface.set("exposure", list.lighting.exposure);
  surface.set("shadow_map", kShadowUnit);
  surface.set("slope_map", kReliefUnit);
  if (look.colour_map >= 0) surface.set("colour_map", kColourUnit);
  if (look.normal_map >= 0) surface.set("normal_map", kNormalUnit);
  if (look.reflectance > 0) {
    surface.set("environment", kEnvironmentUnit);
    surface.set("reflectance", look.reflectance);
  }
  for (const uniform_t& u : look.uniforms) surface.set(u);
}

// Draws the sky behind everything that is opaque.
void Renderer::draw_sky(const DrawList& list, const Camera& camera) {
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_CULL_FACE);
  sky_program_.use();
  sky_program_.set("environment", kEnvironmentUnit);
  sky_program_.set("exposure", list.lighting.exposure);
  sky_program_.set("world_from_clip", Eigen::Matrix4f(camera.clip_from_world().inverse()));
  const std::array<float, 4> none{};
  sky_quad_.draw(none.data(), 1);
  glDepthFunc(GL_LESS);
}

void Renderer::draw_surface(const Batch& batch, bool translucent) {
  const bool rough = batch.relief >= 0 && batch.relief < static_cast<int>(reliefs_.size());
  const Program& program = surfaces_.program(batch.look, rough, shadow() != nullptr);
  const Look& look = surfaces_.look(batch.look);
  program.use();
  program.set("see_through", translucent ? 1.0f : 0.0f);
  const auto bind = [](int unit, unsigned texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<unsigned>(unit));
    glBindTexture(GL_TEXTURE_2D, texture);
  };
  if (rough) {
    const ReliefTexture& relief = *reliefs_[static_cast<std::size_t>(batch.relief)];
    program.set("relief_size", relief.size_m());
    bind(kReliefUnit, relief.id());
  }
  if (look.colour_map >= 0) bind(kColourUnit, colours_[static_cast<std::size_t>(look.colour_map)]->id());
  if (look.normal_map >= 0) bind(kNormalUnit, normals_[static_cast<std::size_t>(look.normal_map)]->id());
  translucent ? draw_translucent(batch) : draw_batch(batch);
}

// A transparent shape is also visible from the back: draw first its far side, then its near one.
void Renderer::draw_translucent(const Batch& batch) {
  const auto at = static_cast<std::size_t>(batch.geometry);
  if (at >= geometries_.size() || !geometries_[at]->two_sided()) return draw_batch(batch);
  glEnable(GL_CULL_FACE);
  for (int i = 0; i < batch.count; ++i)
    for (const auto unseen : {GL_FRONT, GL_BACK}) {
      glCullFace(unseen);
      geometries_[at]->draw(instances_, batch.first + i, 1);
    }
}

void Renderer::draw_batch(const Batch& batch) {
  const auto at = static_cast<std::size_t>(batch.geometry);
  if (at >= geometries_.size()) return;
  enable(GL_CULL_FACE, !geometries_[at]->two_sided());
  geometries_[at]->draw(instances_, batch.first, batch.count);
}

bool Renderer::wait() const {
  // A fence, not glFinish: a driver may implement that as a flush.
  const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  constexpr GLuint64 kMaxWait_ns = 1'000'000'000;  // limit of the wait for a device that hangs
  const GLenum done = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kMaxWait_ns);
  glDeleteSync(fence);
  return done == GL_ALREADY_SIGNALED || done == GL_CONDITION_SATISFIED;
}

}  // namespace tactus::visual
