// Writes a synthetic log: on materials_bench a tip of the same material strikes, scrapes and rolls on a bar of each material, with the
// same motion, and silence after each. tests/measure/draw_sounds draws the output of audio_node --log for it.
//
//    bin/bench_sounds LOG MATERIAL...
#include <cstdio>
#include <iostream>
#include <tactus/asset_ref_t.hpp>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_point_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "audio_node/modal/body_sound.h"
#include "audio_node/excitation/contact_patch.h"
#include "sim_node/scene/load_sdf.h"
#include "sim_node/scene/scene_assets.h"
#include "sync/node/node_options.h"
#include "tests/audio_node/support/recorded_run.h"

using namespace tactus;
using audio::test::RecordedRun;

namespace {

// Times per material, s; tests/measure/draw_sounds uses the same.
constexpr double kFirst_s = 1, kEach_s = 4.2, kScrape_s = 1.6, kRoll_s = 2.9, kLasts_s = 0.6;
constexpr double kSpeed_m_s = 0.15, kForce_N = 4, kStep_s = 1.0 / 60;
constexpr double kTip_1_m = 200;  // a round tip of 5 mm

int body_named(const scene_t& scene, const std::string& name) {
  for (const body_def_t& b : scene.bodies)
    if (b.name == name || b.name.starts_with(name + "::")) return b.id;
  throw std::runtime_error("materials_bench has no " + name + "; name a material that has a bar there");
}

// The body of the tip: the bar of skin, which is nearly silent itself. The tip has the material of the bar that it strikes, so that
// nothing else sounds: a recording of a pair contains both.
int striker(const scene_t& scene) { return body_named(scene, "skin_bar"); }

double patch_m2(const scene_t& scene, int material) {
  const audio::Elastic m = audio::elastic(scene.materials[static_cast<std::size_t>(material)]);
  const double radius_m = audio::patch_radius_m(kForce_N, kTip_1_m, audio::reduced_modulus_Pa(m, m));
  return M_PI * radius_m * radius_m;
}

// A contact as the simulation publishes it (audio_node/excitation/contact_motion.h): it moves over the bar. A sliding tip keeps its contact
// point, a rolling one moves over both surfaces.
contact_t contact(const scene_t& scene, int bar, int material, double went_m, bool rolls) {
  const Eigen::Isometry3d lies = to_eigen(scene.bodies[static_cast<std::size_t>(bar)].pose);
  // Beside the middle of its width, so that torsional modes ring, too.
  const Eigen::Vector3d on_bar(-0.05 + went_m, 0.008, 0.01), on_tip(rolls ? went_m : 0, 0, 0);
  const int tip = striker(scene);
  contact_t c{};
  c.contact_id = 1000 + bar, c.body_a = std::min(bar, tip), c.body_b = std::max(bar, tip), c.tool = -1;
  const bool bar_first = bar < tip;
  c.material_a = c.material_b = material;
  c.normal.z = bar_first ? 1 : -1;
  c.normal_force_N = static_cast<float>(kForce_N), c.depth_m = 1e-5f;
  c.area_m2 = static_cast<float>(patch_m2(scene, material));
  c.sliding_velocity_m_s.x = static_cast<float>(rolls ? 0 : bar_first ? kSpeed_m_s : -kSpeed_m_s);
  // The mean of the velocities over both surfaces.
  c.rolling_velocity_m_s.x = static_cast<float>(rolls ? kSpeed_m_s : kSpeed_m_s / 2);
  contact_point_t p{};
  p.a_world_m = p.b_world_m = to_vec3(lies * on_bar);
  (bar_first ? p.a_body_m : p.b_body_m) = to_vec3(on_bar);
  (bar_first ? p.b_body_m : p.a_body_m) = to_vec3(on_tip);
  c.point_count = 1, c.points = {p};
  return c;
}

}  // namespace

int main(int argc, char** argv) try {
  std::string path;
  std::vector<std::string> materials;
  tactus::sync::Arguments app{"Writes a log in which bars of materials_bench are struck, scraped and rolled on."};
  app.add_option("LOG", path, "file to write").required();
  app.add_option("MATERIAL", materials, "in order").required();
  tactus::sync::parse_or_exit(app, "bench_sounds", argc, argv);

  std::vector<std::string> warnings;
  const auto assets =
      sim::make_assets(sim::load_sdf(TACTUS_SOURCE_DIR "/sim_node/scenes/materials_bench.sdf", warnings));
  scene_t scene{};
  for (const sync::Asset& a : assets)
    if (a.kind == asset_ref_t::SCENE) scene = sync::decode_asset<scene_t>(a.bytes).value();

  std::remove(path.c_str());
  RecordedRun run(std::make_unique<sync::FileSink>(path), assets);
  double next_snapshot = 0;
  const double end = kFirst_s + kEach_s * static_cast<double>(materials.size());
  std::size_t struck = 0;
  for (int ms = 0; ms < static_cast<int>(1000 * end); ++ms) {
    const double now = ms * 1e-3;
    const double since = std::fmod(now - kFirst_s + kEach_s, kEach_s);
    const auto i = static_cast<std::size_t>(std::max(0.0, (now - kFirst_s) / kEach_s));
    const int bar = body_named(scene, materials[i] + "_bar");
    int material = -1;
    for (const shape_def_t& s : scene.shapes)
      if (s.body == bar) material = s.material;
    if (now >= kFirst_s && i == struck) {
      // Near its end, where no mode of a bar has a node.
      const contact_t where = contact(scene, bar, material, -0.018, false);
      contact_event_t e = RecordedRun::hit(static_cast<std::int64_t>(++struck), now, where.body_a, where.body_b);
      e.material_a = where.material_a, e.material_b = where.material_b;
      e.effective_mass_kg = 0.02f, e.curvature_1_m = static_cast<float>(kTip_1_m);  // a light hammer
      e.point_m = where.points[0].a_world_m, e.normal = where.normal;
      run.write_events(now, {e});
    }
    if (now < next_snapshot) continue;
    next_snapshot += kStep_s;
    std::vector<contact_t> contacts;
    for (const double begin : {kScrape_s, kRoll_s})
      if (now >= kFirst_s && since >= begin && since < begin + kLasts_s)
        contacts.push_back(contact(scene, bar, material, kSpeed_m_s * (since - begin), begin == kRoll_s));
    run.write_contacts(now, contacts);
  }
  run.finish();
  return 0;
} catch (const std::exception& e) {
  return sync::fail("bench_sounds", e);
}
