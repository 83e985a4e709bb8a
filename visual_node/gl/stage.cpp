#include "visual_node/gl/stage.h"

namespace tactus::visual {

Stage::Stage(const Settings& s, bool window) : quality_(s), loop_rate_Hz_(s.rate_Hz) {
  quiet_software_renderer();
  const WindowOptions options{.width = s.window_width > 0 ? s.window_width : s.width,
                              .height = s.window_height > 0 ? s.window_height : s.height,
                              .full_screen = s.full_screen,
                              .monitor = s.monitor,
                              .quad_buffer = s.stereo == "quad_buffer"};
  display_ = window ? make_window("Tactus", options) : make_headless(s.egl_device);
  renderer_ = std::make_unique<Renderer>(s.width / 4 * 4, s.height / 4 * 4, s.shadow_size);
}

void Stage::load(const SceneView& view, const DrawList& sample, const Settings& s) {
  shaders_ = std::make_unique<ShaderWatch>(s.shader_folder);
  renderer_ = std::make_unique<Renderer>(view.width(), view.height(), s.shadow_size, s.anti_aliasing);
  renderer_->load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
  renderer_->warm_up(sample);
  quality_ = QualityControl(s);
  rate_.restart();
  loop_rate_Hz_ = s.rate_Hz;
  halves_ = s.stereo == "quad_buffer";
}

void Stage::draw_scene(const DrawList& list, const sync::OutputDef& output) {
  if (shaders_)
    if (auto folder = shaders_->take()) renderer_->set_shader_folder(std::move(*folder));
  renderer_->set_quality(degraded(quality_.quality(), output.resolution));
  renderer_->draw_scene(list);
  renderer_->wait();
}

void Stage::draw_over(const DrawList& list) {
  renderer_->draw_over(list);
  renderer_->wait();
}

void Stage::show() {
  display_->show(picture().framebuffer(), picture().width(), picture().height(), halves_);
  renderer_->wait();
}

}  // namespace tactus::visual
