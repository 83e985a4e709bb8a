// Strikes bodies one after the other, each alone, through the callback and the virtual sound card, and prints the WAV file of each.
// tests/measure/measure_modes compares the files with closed forms.
#include <chrono>
#include <fstream>
#include <iostream>
#include <memory>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/vec3_t.hpp>
#include <tactus/vec3f_t.hpp>
#include <thread>

#include <nlohmann/json.hpp>

#include "audio_node/devices/stream.h"
#include "audio_node/excitation/impact.h"
#include "sync/clocks/pacing.h"
#include "sync/node/node_options.h"

using namespace tactus;
using nlohmann::json;

namespace {

// A long period leaves a loaded machine time to compute it; the block size does not change the sound.
constexpr int kPeriodFrames = 4096;
constexpr sync::Nanoseconds kAhead{600'000'000};  // several periods: the stream has settled by then

vec3_t vec3(const json& of) { return {of.at(0), of.at(1), of.at(2)}; }
vec3f_t vec3f(const json& of) { return {of.at(0), of.at(1), of.at(2)}; }

// The body of that case, and a hammer too small to be audible.
scene_t scene_of(const json& of) {
  scene_t scene{};
  material_def_t material{};
  const json& figures = of.at("material");
  material.youngs_modulus_Pa = figures.at("youngs_modulus_Pa"), material.poissons_ratio = figures.at("poissons_ratio");
  material.density_kg_m3 = figures.at("density_kg_m3");
  material.rayleigh_alpha_1_s = figures.at("rayleigh_alpha_1_s"), material.rayleigh_beta_s = figures.at("rayleigh_beta_s");
  material.restitution = 0.5;
  for (const json& mode : figures.value("modes", json::array()))
    material.modes.push_back({mode.at(0), mode.at(1), mode.at(2)});
  material.mode_count = static_cast<int>(material.modes.size());
  body_def_t hammer{}, body{};
  hammer.tool = body.tool = -1;
  hammer.mass_kg = 0.001;
  body.id = 1, body.mass_kg = of.at("mass_kg"), body.is_static = of.at("is_static") ? 1 : 0;
  hammer.pose.orientation.w = body.pose.orientation.w = scene.listener.orientation.w = 1;
  shape_def_t head{}, shape{};
  head.kind = shape_def_t::SPHERE, head.size_m = {0.002, 0, 0};
  shape.body = 1;
  shape.kind = of.at("shape") == "box" ? shape_def_t::BOX : shape_def_t::SPHERE, shape.size_m = vec3(of.at("size_m"));
  head.pose.orientation.w = shape.pose.orientation.w = 1;
  scene.bodies = {hammer, body}, scene.shapes = {head, shape}, scene.materials = {material};
  scene.body_count = scene.shape_count = 2, scene.material_count = 1;
  return scene;
}

contact_event_t blow(const json& of) {
  contact_event_t event{};
  event.event_id = 1, event.kind = contact_event_t::HIT;
  event.body_a = 0, event.body_b = 1, event.tool = -1;
  event.point_m = {of.at("point_m").at(0), of.at("point_m").at(1), of.at("point_m").at(2)};
  event.normal = vec3f(of.at("normal"));
  // A contact of about 30 us between hard bodies: one or two samples, so that it excites all audible modes.
  event.approach_speed_m_s = 1, event.effective_mass_kg = 0.001f, event.curvature_1_m = 500;
  return event;
}

void say_result(const json& of, const std::string& wav, std::int64_t underflows) {
  std::cout << json{{"name", of.at("name")}, {"wav", wav}, {"underflows", underflows}}.dump() << std::endl;
}

void strike(const json& of, const std::string& folder) {
  audio::Settings settings;
  settings.max_modes = of.value("max_modes", static_cast<int>(settings.max_modes));
  audio::StreamOptions options;
  options.device = "virtual", options.folder = folder;
  options.rate_Hz = static_cast<int>(settings.sample_rate_Hz), options.period_frames = kPeriodFrames;
  const audio::Impacts impacts(scene_of(of), {}, settings, settings.sample_rate_Hz, 1);
  audio::CallbackQueues queues;
  auto renderer = std::make_unique<audio::Renderer>(queues, audio::RendererDef{});
  audio::Stream stream(
      options, [&](float* out, int frames, const audio::BlockTime& time) { renderer->render(out, frames, time); });
  const auto at_rest = [](int) { return std::optional(Eigen::Isometry3d::Identity()); };
  queues.strikes.push(impacts.strike(blow(of), sync::host_now() + kAhead, at_rest));
  std::this_thread::sleep_for(std::chrono::duration<double>(of.at("seconds").get<double>()) + kAhead);
  say_result(of, stream.medium(), stream.underflows());
}

}  // namespace

int main(int argc, char** argv) try {
  std::string cases, folder = ".";
  tactus::sync::Arguments app{"Strikes bodies one after the other, each alone, through the virtual card; one JSON line for each reports its WAV."};
  app.add_option("cases", cases, "JSON: an array of strikes, each with a body and a point").required();
  app.add_option("--out", folder, "folder of the WAV files");
  tactus::sync::parse_or_exit(app, "strike_bodies", argc, argv);
  std::ifstream file(cases);
  if (!file) throw std::runtime_error(cases + " cannot be read; name a file of cases");
  for (const json& of : json::parse(file)) strike(of, folder);
  return 0;
} catch (const std::exception& e) {
  std::cerr << "strike_bodies: " << e.what() << "\n";
  return 1;
}
