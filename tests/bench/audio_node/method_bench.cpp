// Cost of one contact for the audio callback when it is computed, played from recordings, or both: impacts on four materials, and sliding
// contacts, in blocks of 64 frames with a stereo pan.
//
//    bin/method_bench [--seconds N] [--json FILE]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "audio_node/excitation/impact.h"
#include "audio_node/mixer/renderer.h"
#include "audio_node/mixer/library.h"
#include "audio_node/excitation/sampler.h"
#include "lcmtypes/vectors.h"
#include "sync/node/node_options.h"

using namespace tactus;
using namespace tactus::audio;

namespace {

constexpr int kFrames = 64;
constexpr int kImpacts_1_s = 20, kSliding = 8;
const char* const kMaterials[] = {"steel", "glass", "oak", "rubber"};

std::int64_t clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Plates of 0.3 m of four materials, each struck by all others.
scene_t plates() {
  scene_t s{};
  s.listener = to_pose(Eigen::Isometry3d(Eigen::Translation3d(-1, 0, 0)));
  for (int i = 0; i < 4; ++i) {
    material_def_t m{};
    m.name = kMaterials[i];
    m.youngs_modulus_Pa = 7e10, m.poissons_ratio = 0.25, m.density_kg_m3 = 2500, m.rayleigh_alpha_1_s = 2;
    m.rayleigh_beta_s = 1e-7, m.friction_dynamic = 0.4, m.restitution = 0.5;
    s.materials.push_back(m);
    body_def_t body{};
    body.id = i, body.mass_kg = 1;
    s.bodies.push_back(body);
    shape_def_t shape{};
    shape.body = shape.material = i, shape.kind = shape_def_t::BOX;
    shape.size_m.x = 0.3, shape.size_m.y = 0.25, shape.size_m.z = 0.005;
    shape.pose = to_pose(Eigen::Isometry3d::Identity());
    s.shapes.push_back(shape);
  }
  s.material_count = s.body_count = s.shape_count = 4;
  return s;
}

struct Cost {
  double modal_us = 0, samples_us = 0, all_us = 0;  // per contact; for sliding: per second of it
};

class Rehearsal {
 public:
  Rehearsal(const Database& database, const std::string& method) : scene_(plates()), impacts_(make(method)) {
    sampler_ = std::make_unique<Sampler>(scene_, settings_);
    sampler_->set_database(&database, 1);
  }

  Cost impacts(int seconds) {
    std::mt19937 random(1);
    std::int64_t id = 0;
    double next_s = 0;
    return run(seconds, kImpacts_1_s * seconds, [&](double now_s, sync::HostTime at) {
      for (; next_s <= now_s; next_s += 1.0 / kImpacts_1_s) {
        contact_event_t e{};
        e.event_id = ++id;
        e.body_a = static_cast<int>(random() % 3), e.body_b = 3;
        e.body_b = e.body_a + 1 + static_cast<int>(random() % static_cast<unsigned>(3 - e.body_a));
        e.material_a = e.body_a, e.material_b = e.body_b;
        e.point_m.x = static_cast<float>(random() % 100) * 1e-3f;
        e.normal.z = 1, e.effective_mass_kg = 0.1f, e.curvature_1_m = 50;
        e.approach_speed_m_s = 0.05f + 1e-4f * static_cast<float>(random() % 10000);
        Strike s = impacts_.strike(e, at, [](int) { return Eigen::Isometry3d::Identity(); });
        sampler_->add_recordings(s, e, impacts_);
        queues_->strikes.push(s);
      }
    });
  }

  Cost sliding(int seconds) {
    sync::Contacts contacts;
    for (int i = 0; i < kSliding; ++i) {
      contact_t c{};
      c.contact_id = i + 1, c.material_a = c.body_a = i % 3, c.material_b = c.body_b = 3;
      c.normal_force_N = 3, c.sliding_velocity_m_s.x = 0.1f + 0.05f * static_cast<float>(i);
      c.point_count = 1, c.points.resize(1);
      contacts.push_back(c);
    }
    return run(seconds, kSliding * seconds, [&](double now_s, sync::HostTime at) {
      for (const RecordedContact& r : sampler_->recorded_contacts(contacts, at)) queues_->recorded.contacts.push(r);
      for (const contact_t& c : contacts) {
        const float share = sampler_->modal_gain(c.contact_id, Interaction::kScrape);
        if (share > 0) queues_->scrapes.push(scrape(c, share, now_s, at));
      }
    });
  }

 private:
  Impacts make(const std::string& method) {
    settings_.method = method;
    queues_->recorded.databases.push(1);
    return Impacts(scene_, {}, settings_, settings_.sample_rate_Hz, 1);
  }

  // Body a scrapes over the roughness of b.
  Scrape scrape(const contact_t& c, float share, double now_s, sync::HostTime at) {
    Scrape s;
    s.id = c.contact_id, s.number = number_++, s.at = at;
    s.slide = 1e-4f * share;
    for (std::size_t i = 0; i < 2; ++i) {
      const int body = i == 0 ? c.body_a : c.body_b;
      ScrapeSide& side = s.sides[i];
      side.voice = impacts_.voice_id(body), side.resonators = impacts_.resonators(body);
      side.gains = impacts_.gains(body, std::nullopt);
      side.known = true;
      side.roughness = {1e-6, 0};
    }
    const double speed_m_s = static_cast<double>(c.sliding_velocity_m_s.x);
    s.sides[1].place_m.x() = speed_m_s * now_s, s.sides[1].velocity_m_s.x() = speed_m_s;
    s.sides[1].slide_vector.x() = 1;
    return s;
  }

  template <class Excite>
  Cost run(int seconds, int contacts, Excite excite) {
    std::vector<float> block(2 * kFrames);
    const auto blocks = static_cast<std::int64_t>(seconds * settings_.sample_rate_Hz / kFrames);
    const std::int64_t before[] = {queues_->costs[0].ns, queues_->costs[1].ns};
    std::int64_t took = 0;
    for (std::int64_t i = 0; i < blocks; ++i) {
      const double now_s = static_cast<double>(i) * kFrames / settings_.sample_rate_Hz;
      const sync::HostTime first = sync::host_time(1'000'000'000 + ++rendered_ * kFrames * 1'000'000'000 / 48000);
      excite(now_s, first);
      const std::int64_t begun = clock_ns();
      renderer_->render(block.data(), kFrames, {first, {}, {}});
      took += clock_ns() - begun;
      for (presentation_t r; queues_->reports.pop(r);) continue;
    }
    const auto each = [&](std::int64_t ns) { return 1e-3 * static_cast<double>(ns) / contacts; };
    return {each(queues_->costs[0].ns - before[0]), each(queues_->costs[1].ns - before[1]), each(took)};
  }

  scene_t scene_;
  Settings settings_;
  std::unique_ptr<CallbackQueues> queues_ = std::make_unique<CallbackQueues>();
  std::unique_ptr<Renderer> renderer_ = [this] {
    RendererDef def;
    def.clock_ns = clock_ns;
    return std::make_unique<Renderer>(*queues_, def);
  }();
  Impacts impacts_;
  std::unique_ptr<Sampler> sampler_;
  std::int64_t number_ = 0, rendered_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  std::string json, folder = "default";
  int seconds = 10;
  tactus::sync::Arguments app{"Cost of a contact in the audio callback, by method."};
  app.add_option("--seconds", seconds, "seconds of sound of each row").range(1, 600);
  app.add_option("--sounds", folder, "folder of recordings; default: the set beside the program");
  app.add_option("--json", json, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "method_bench", argc, argv);
  const Database database = read_database(sounds_folder(folder), 48000, 0.05);
  for (const SoundFault& f : database.faults)
    std::fprintf(stderr, "method_bench: %s %s\n", f.path.c_str(), f.what.c_str());
  if (database.sounds.empty()) return 1;
  std::printf("%-8s  %-26s %10s %10s %10s\n", "method", "us of the callback", "modal", "samples", "total");
  nlohmann::json rows = nlohmann::json::array();
  for (const char* method : {"modal", "samples", "both"})
    for (const bool slides : {false, true}) {
      Rehearsal rehearsal(database, method);
      const Cost c = slides ? rehearsal.sliding(seconds) : rehearsal.impacts(seconds);
      const char* of = slides ? "a second of one that slides" : "an impact";
      std::printf("%-8s  %-26s %10.1f %10.1f %10.1f\n", method, of, c.modal_us, c.samples_us, c.all_us);
      rows.push_back({{"method", method},
                      {"of", of},
                      {"modal_us", c.modal_us},
                      {"samples_us", c.samples_us},
                      {"all_us", c.all_us}});
    }
  if (!json.empty()) std::ofstream(json) << rows.dump(1) << "\n";
  return 0;
}
