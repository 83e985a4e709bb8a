#include "visual_node/gl/render_output.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace tactus::visual {

std::unique_ptr<Display> make_display(const Settings& s, bool window) {
  const WindowOptions options{.width = s.window_width > 0 ? s.window_width : s.width,
                              .height = s.window_height > 0 ? s.window_height : s.height,
                              .full_screen = s.full_screen,
                              .monitor = s.monitor,
                              .quad_buffer = s.stereo == "quad_buffer"};
  return window ? make_window("Tactus", options) : make_headless(s.egl_device);
}

RenderOutput::RenderOutput(const Settings& s, bool window, MakeDisplay make)
    : settings_(s), window_(window), make_(std::move(make)), quality_(s), loop_rate_Hz_(s.rate_Hz) {
  configure_software_renderer();
  open();
}

RenderOutput::RenderOutput(const Settings& s) : settings_(s), window_(false), quality_(s), loop_rate_Hz_(s.rate_Hz) {}

void RenderOutput::open() {
  display_ = make_(settings_, window_);
  if (!display_) throw std::runtime_error("there is no graphics device to draw on");
  renderer_ = std::make_unique<Renderer>(settings_.width / 4 * 4, settings_.height / 4 * 4, settings_.shadow_size);
  unfinished_ = 0;
}

std::string RenderOutput::recover(sync::HostTime now, const SceneView* view, const DrawList& sample) {
  if (!draws()) return {};
  std::string why = display_->loss_reason();
  const bool hangs = unfinished_ >= kMaxUnfinished;
  if (why.empty() && hangs) why = "the graphics device does not finish its commands";
  if (why.empty()) return {};
  losses_.push_back(now);
  if (losses_.size() > kMaxLosses) {
    if (now - losses_.front() < kLossesWithin)
      throw std::runtime_error(why + ", " + std::to_string(losses_.size()) +
                               " times in a minute; check the system log");
    losses_.pop_front();
  }
  window_ = window_ && !display_->server_gone();
  renderer_.reset();
  display_.reset();  // before the next one opens: some systems allow only one
  try {
    open();
    if (view) load(*view, sample, settings_);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(why + ", and it cannot be opened again: " + e.what());
  }
  return why + "; drawing continues with " + description();
}

void RenderOutput::load(const SceneView& view, const DrawList& sample, const Settings& s,
                 const std::function<void()>& meanwhile) {
  settings_ = s;
  if (draws()) {
    shaders_ = std::make_unique<ShaderWatch>(s.shader_folder);
    renderer_ = std::make_unique<Renderer>(view.width(), view.height(), s.shadow_size, s.anti_aliasing);
    renderer_->load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
    meanwhile();
    renderer_->warm_up(sample, meanwhile);
  }
  quality_ = QualityControl(s);
  rate_.restart();
  loop_rate_Hz_ = s.rate_Hz;
  halves_ = s.stereo == "quad_buffer";
}

void RenderOutput::start_quality(const DrawList& sample, const std::function<sync::HostTime()>& clock,
                                 const std::function<void()>& meanwhile) {
  if (!draws()) return;
  const sync::HostTime begin = clock();
  std::vector<sync::Nanoseconds> costs;
  for (const Quality& quality : kQualities) {
    std::vector<sync::Nanoseconds> taken;
    renderer_->set_quality(quality);
    do {
      const sync::HostTime from = clock();
      renderer_->draw_scene(sample);
      finish();
      renderer_->draw_flashes_and_overlay(sample);
      finish();
      taken.push_back(clock() - from);
      meanwhile();
    } while (taken.size() < kTimings && clock() - begin < kTimedFor);
    std::nth_element(taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(taken.size() / 2), taken.end());
    costs.push_back(taken[taken.size() / 2]);
    if (!quality_.too_long(costs.back())) break;
    if (clock() - begin < kTimedFor) continue;
    costs.resize(kQualities.size(), costs.back());  // much too slow: the cheapest one
    break;
  }
  quality_.start(costs);
}

void RenderOutput::draw_scene(const DrawList& list, const sync::OutputValues& output) {
  if (!draws()) return;
  if (shaders_)
    if (auto folder = shaders_->take_change()) renderer_->set_shader_folder(std::move(*folder));
  renderer_->set_quality(degraded(quality_.quality(), output.value("resolution")));
  renderer_->draw_scene(list);
  finish();
}

void RenderOutput::draw_flashes_and_overlay(const DrawList& list) {
  if (!draws()) return;
  renderer_->draw_flashes_and_overlay(list);
  finish();
}

void RenderOutput::show() {
  if (!draws()) return;
  display_->show(picture().framebuffer(), picture().width(), picture().height(), halves_);
  finish();
}

}  // namespace tactus::visual
