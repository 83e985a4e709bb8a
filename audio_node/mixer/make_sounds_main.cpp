// make_sounds: renders the default set of recordings from the modal models, with the same bits each time. The
// build calls it; README.md describes the layout of a set.
//
// Every material is a bar of 160 x 40 x 10 mm, which is struck at two places, scraped and rolled upon.
#include <sndfile.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

#include "audio_node/excitation/impact.h"
#include "audio_node/excitation/roughness.h"
#include "audio_node/samples/layers.h"
#include "audio_node/mixer/sound_writer.h"
#include "audio_node/mixer/voices.h"
#include "lcmtypes/vectors.h"
#include "sync/node/node_options.h"

using namespace tactus;
using namespace tactus::audio;

namespace {

constexpr double kRate_Hz = 48000;
const Eigen::Vector3d kBar_m{0.16, 0.04, 0.01};
constexpr double kSpeeds_m_s[] = {0.1, 0.5};  // of layers of each interaction
// struck places as shares of the half length of the bar, never its middle
constexpr double kPlaces[] = {0.45, 0.2};
constexpr double kStriker_kg = 0.1;
constexpr double kMaxLength_s = 1.5, kLoop_s = 1.2;
constexpr float kEnd = 1e-3f;       // of the peak: the sound has ended
constexpr double kLoopRms = 0.1;    // leaves headroom for its peaks
constexpr double kRollGrain = 0.1;  // a rolling patch of 1 mm passes no finer grain than 0.1 of scraping
// Only its spectrum matters, not its height.
constexpr Roughness kRough{1e-6, 0};
constexpr double kRollCutoff_Hz = 400;
// Of the levels within the set: the pressures of the materials span 70 dB, and those of soft ones would be below the noise of a recording.
// Stevens' exponent of loudness (unverified).
constexpr double kCompression = 0.6;
// Materials that are paired with each other, in addition to all materials alone.
const std::set<std::string> kPaired{"steel", "glass", "oak", "rubber"};

std::vector<material_def_t> read_materials(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line))
    throw std::runtime_error("cannot read " + path + "; give the materials.csv of the scenes");
  std::vector<material_def_t> all;
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    material_def_t m{};
    std::getline(fields, m.name, ',');
    double* const values[] = {&m.youngs_modulus_Pa, &m.poissons_ratio,  &m.density_kg_m3,    &m.rayleigh_alpha_1_s,
                              &m.rayleigh_beta_s,   &m.friction_static, &m.friction_dynamic, &m.restitution};
    std::string word;
    for (double* value : values) {
      if (!std::getline(fields, word, ','))
        throw std::runtime_error(path + ": a line of " + m.name + " is too short");
      *value = std::stod(word);
    }
    all.push_back(m);
  }
  return all;
}

// Bars of two materials at the origin.
scene_t bars(const material_def_t& a, const material_def_t& b) {
  scene_t s{};
  // A metre in front of the bars, facing them.
  s.listener = to_pose(Eigen::Isometry3d(Eigen::Translation3d(-1, 0, 0)));
  s.materials = {a, b};
  for (int i = 0; i < 2; ++i) {
    body_def_t body{};
    body.id = i, body.mass_kg = kBar_m.prod() * s.materials[static_cast<std::size_t>(i)].density_kg_m3;
    s.bodies.push_back(body);
    shape_def_t shape{};
    shape.body = shape.material = i, shape.kind = shape_def_t::BOX;
    shape.size_m.x = kBar_m.x(), shape.size_m.y = kBar_m.y(), shape.size_m.z = kBar_m.z();
    shape.pose = to_pose(Eigen::Isometry3d::Identity());
    s.shapes.push_back(shape);
  }
  s.material_count = s.body_count = s.shape_count = 2;
  return s;
}

class Set {
 public:
  explicit Set(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // alone: the second material strikes or slides, but is not audible.
  void render(const material_def_t& a, const material_def_t& b, bool alone) {
    const scene_t scene = bars(a, b);
    const Impacts impacts(scene, {}, settings_, kRate_Hz, 1);
    const auto sound_folder = folder_ / (alone ? a.name : a.name + "-" + b.name);
    std::filesystem::create_directories(sound_folder);
    std::ofstream(sound_folder / "size.txt") << impacts.body(0).radius_m << "\n";
    for (const double speed : kSpeeds_m_s) {
      for (std::size_t take = 0; take < std::size(kPlaces); ++take)
        write(sound_folder, Interaction::kImpact, speed, take, render_blow(impacts, speed, kPlaces[take], alone));
      write(sound_folder, Interaction::kScrape, speed, 0, friction_loop(impacts, speed, alone, false));
      write(sound_folder, Interaction::kRoll, speed, 0, friction_loop(impacts, speed, alone, true));
    }
  }

 private:
  std::vector<float> render_blow(const Impacts& impacts, double speed_m_s, double along, bool alone) const {
    contact_event_t e{};
    e.body_b = e.material_b = 1;
    e.point_m.x = static_cast<float>(along * kBar_m.x() / 2), e.normal.z = 1;
    e.approach_speed_m_s = static_cast<float>(speed_m_s), e.effective_mass_kg = static_cast<float>(kStriker_kg);
    e.curvature_1_m = 50;  // a corner of 2 cm
    const Strike s = impacts.strike(e, {}, [](int) { return Eigen::Isometry3d::Identity(); });
    Voices voices(2, kRate_Hz, ring(Instructions::kSse2));  // available on every machine: the same bits
    for (std::size_t i = 0; i < (alone ? 1u : 2u); ++i) voices.strike(s.sides[i], 1, s.pulse, 0);
    auto x = render_samples(voices, kMaxLength_s, [](int) {});
    // At the impulse of a recording.
    const auto scale = static_cast<float>(
        std::pow(settings_.recorded_impulse_Ns / static_cast<double>(s.impulse_N_s), settings_.loudness_exponent));
    float peak = 0;
    for (float& v : x) peak = std::max(peak, std::abs(v *= scale));
    while (!x.empty() && std::abs(x.back()) < kEnd * peak) x.pop_back();
    return x;
  }

  std::vector<float> friction_loop(const Impacts& impacts, double speed_m_s, bool alone, bool rolls) const {
    Voices voices(2, kRate_Hz, ring(Instructions::kSse2));
    std::array<PerMode, 2> gains;
    for (int i = 0; i < 2; ++i)
      gains[static_cast<std::size_t>(i)] =
          impacts.gains(i, BodyPlace{{kPlaces[0] * kBar_m.x() / 2, 0, kBar_m.z() / 2}, -Eigen::Vector3d::UnitZ()});
    std::array<float, kMaxBlock> force;
    double moved_m = 0, low = 0;
    const double follow = rolls ? 1 - std::exp(-2 * M_PI * kRollCutoff_Hz / kRate_Hz) : 1;
    const double steepness = std::sqrt(mean_square_slope(kRough));
    std::vector<float> surface;
    const auto x = render_samples(voices, kLoop_s + 0.2, [&](int frames) {
      std::array<float, kMaxBlock> slope{}, none{};
      const double step_m = (rolls ? kRollGrain : 1) * speed_m_s / kRate_Hz;
      add_slopes(kRough, {{moved_m, 0, 0}, {step_m, 0, 0}, {0, 0, 0}}, Eigen::Vector3f::UnitX(),
                 Eigen::Vector3f::Zero(), frames, slope.data(), none.data());
      for (int n = 0; n < frames; ++n) {
        low += follow * (static_cast<double>(slope[static_cast<std::size_t>(n)]) / steepness - low);
        surface.push_back(static_cast<float>(low));
        force[static_cast<std::size_t>(n)] = static_cast<float>(1e-4 * low);
      }
      moved_m += step_m * frames;
      for (int i = 0; i < (alone ? 1 : 2); ++i)
        voices.drive(
            {impacts.voice_id(i), &impacts.resonators(i), &gains[static_cast<std::size_t>(i)], {}, force.data()});
    });
    // Direct sound of the surfaces, as strong as the modes; without it a loop would be a tone.
    double of_modes = 0, of_surface = 0, peak = 0;
    const auto steady = static_cast<std::size_t>(0.2 * kRate_Hz);
    for (std::size_t n = steady; n < x.size(); ++n) {
      of_modes += static_cast<double>(x[n]) * static_cast<double>(x[n]);
      of_surface += static_cast<double>(surface[n]) * static_cast<double>(surface[n]);
    }
    std::vector<float> both;
    const auto count = static_cast<double>(x.size() - steady);
    for (std::size_t n = steady; n < x.size(); ++n) {
      both.push_back(static_cast<float>(kLoopRms * std::sqrt(count / 2) *
                                        (static_cast<double>(x[n]) / std::sqrt(of_modes) +
                                         static_cast<double>(surface[n]) / std::sqrt(of_surface))));
      peak = std::max(peak, std::abs(static_cast<double>(both.back())));
    }
    for (float& v : both) v *= static_cast<float>(std::min(1.0, 0.9 / peak));
    return both;
  }

  static std::vector<float> render_samples(Voices& voices, double length_s, const std::function<void(int)>& before) {
    std::vector<float> x;
    while (x.size() < static_cast<std::size_t>(length_s * kRate_Hz)) {
      std::array<float, 2 * kMaxBlock> mix{};
      before(kMaxBlock);
      voices.render(mix.data(), kMaxBlock);
      // Straight ahead each ear receives the root of a half.
      for (std::size_t n = 0; n < kMaxBlock; ++n) x.push_back(mix[2 * n] * std::sqrt(2.f));
    }
    return x;
  }

  void write(const std::filesystem::path& sound_folder, Interaction interaction, double speed_m_s, std::size_t take,
             const std::vector<float>& x) const {
    std::ostringstream file;
    file << speed_m_s;
    if (take > 0) file << "_" << take + 1;
    std::filesystem::create_directories(sound_folder / name(interaction));
    const auto path = sound_folder / name(interaction) / (file.str() + ".flac");
    SF_INFO info{};
    info.samplerate = static_cast<int>(kRate_Hz), info.channels = 1;
    info.format = SF_FORMAT_FLAC | SF_FORMAT_PCM_24;
    SNDFILE* out = open_for_writing(path, info, "folder");
    if (sf_writef_float(out, x.data(), static_cast<sf_count_t>(x.size())) != static_cast<sf_count_t>(x.size()))
      throw std::runtime_error("cannot write " + path.string() + "; choose another folder");
    sf_close(out);
  }

  std::filesystem::path folder_;
  const Settings settings_ = [] {
    Settings settings;
    settings.loudness_exponent = kCompression;
    return settings;
  }();
};

}  // namespace

int main(int argc, char** argv) try {
  std::string folder, materials, readme;
  sync::Arguments app{"Renders the default set of recordings from modal models."};
  app.add_option("folder", folder, "output folder");
  app.add_option("--materials", materials, "table of materials");
  app.add_option("--readme", readme, "README that is copied into the folder");
  sync::parse_or_exit(app, "make_sounds", argc, argv);
  if (folder.empty() || materials.empty())
    throw std::runtime_error("give a folder and --materials; see make_sounds --help");
  const auto all = read_materials(materials);
  // It replaces only a set that it made itself, never another folder.
  const auto mark = std::filesystem::path(folder) / ".rendered";
  if (std::filesystem::exists(folder) && !std::filesystem::is_empty(folder) && !std::filesystem::exists(mark))
    throw std::runtime_error(folder + " exists and was not written by make_sounds; give a new folder");
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::ofstream(mark) << "by make_sounds\n";
  Set set(folder);
  for (std::size_t i = 0; i < all.size(); ++i) {
    set.render(all[i], all[i], true);
    for (std::size_t k = i + 1; k < all.size(); ++k)
      if (kPaired.contains(all[i].name) && kPaired.contains(all[k].name)) set.render(all[i], all[k], false);
  }
  if (!readme.empty()) std::filesystem::copy_file(readme, std::filesystem::path(folder) / "README.md");
  return 0;
} catch (const std::exception& e) {
  return sync::fail("make_sounds", e);
}
