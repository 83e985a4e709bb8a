#include "audio_node/excitation/impact.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tactus/body_def_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/tool_def_t.hpp>

#include "audio_node/excitation/contact_patch.h"
#include "audio_node/signal/loudness.h"
#include "audio_node/modal/measured_modes.h"
#include "audio_node/excitation/peak.h"
#include "audio_node/excitation/radiation.h"
#include "audio_node/signal/plausible.h"
#include "lcmtypes/vectors.h"

namespace tactus::audio {
namespace {

using std::numbers::pi;

// Bounds of plausible input; values beyond them are clamped.
constexpr double kMaxMass_kg = 1e3, kMaxApproach_m_s = 50, kMinApproach_m_s = 1e-4, kMinCurvature_1_m = 1;
// FoleyAutomatic, section 3: impulses at the first four modal frequencies, within 15 ms.
constexpr std::size_t kMicroCollisions = 4;
constexpr double kMicroWithin_s = 0.015;
// A repeated collision is complete when half a period of its mode is longer than the blow by this share. Design: over a factor of
// 2.5 in speed, since the time of a blow falls with the fifth root of the speed (Hertz).
constexpr double kHardening = 0.2;
// Value for a strike that is inaudible at any strength.
constexpr float kInaudible = 2;

// The shape that represents a body: its largest collision shape.
const shape_def_t* main_shape(const scene_t& scene, int body) {
  const shape_def_t* best = nullptr;
  double best_size = -1;
  for (const shape_def_t& shape : scene.shapes) {
    if (shape.body != body) continue;
    const double size =
        shape.size_m.x * std::max(shape.size_m.y, shape.size_m.x) * std::max(shape.size_m.z, shape.size_m.x);
    if (size > best_size) best = &shape, best_size = size;
  }
  return best;
}

// The contact shape of a tool, which has no collision shape. A ball of radius 0, a point, has none.
std::optional<shape_def_t> shape_of(const tool_def_t& tool) {
  shape_def_t shape{};
  shape.pose.orientation.w = 1;
  shape.body = tool.body, shape.material = tool.material;
  shape.size_m = tool.size_m, shape.mesh_hash = tool.mesh_hash;
  switch (tool.shape) {
    case tool_def_t::BOX: shape.kind = shape_def_t::BOX; break;
    case tool_def_t::CAPSULE: shape.kind = shape_def_t::CAPSULE; break;
    case tool_def_t::MESH: shape.kind = shape_def_t::MESH; break;
    default:
      if (!(tool.radius_m > 0)) return std::nullopt;
      shape.kind = shape_def_t::SPHERE;
      shape.size_m.x = tool.radius_m;
  }
  return shape;
}

// Peak pressure of an undivided blow of that many samples, whose clicks are peak pressures.
double blow_Pa(Strike strike, int samples, double rate_Hz) {
  strike.pulse = one_hump(samples);
  const float change = steepest(strike.pulse);
  for (StrikeSide& side : strike.sides) side.click /= change;
  return peak_Pa(strike, rate_Hz);
}

}  // namespace

double contact_time_s(double mass_kg, double curvature_1_m, double speed_m_s, const Elastic& a, const Elastic& b) {
  const double e = reduced_modulus_Pa(a, b);
  return 2.87 * std::pow(mass_kg * mass_kg * curvature_1_m / (e * e * speed_m_s), 0.2);
}

SourcePosition place_of(const Eigen::Isometry3d& T_W_listener, const Eigen::Vector3d& source_m, double nearest_m) {
  const Eigen::Vector3d p = T_W_listener.inverse() * source_m;
  const double r = p.norm();
  return {r > 1e-9 ? Eigen::Vector3f((p / r).cast<float>()) : Eigen::Vector3f::UnitX(),
          static_cast<float>(std::max(r, nearest_m)), source_m};
}

Impacts::Impacts(const scene_t& scene, const std::function<std::optional<Extent>(std::int64_t)>& mesh,
                 const Settings& settings, double rate_Hz, std::int64_t generation)
    : settings_(settings), rate_Hz_(rate_Hz), generation_(generation), listener_(to_eigen(scene.listener)) {
  for (const material_def_t& m : scene.materials) materials_.push_back(elastic(m));
  const auto table = std::make_shared<ResonatorTable>();
  const auto add = [&](const body_def_t& body, const shape_def_t* shape, int material_index) {
    const auto extent = shape && shape->kind == shape_def_t::MESH ? mesh(shape->mesh_hash) : std::nullopt;
    Voice v{body_sound(body, shape, material(material_index), extent, settings), table->size(), {}, {}};
    Resonators& resonators = table->emplace_back();
    if (material_index >= 0 && static_cast<std::size_t>(material_index) < scene.materials.size())
      apply_measured_modes(v.sound, scene.materials[static_cast<std::size_t>(material_index)], settings);
    if (body.is_static) v.static_pose = to_eigen(body.pose);
    // Close to half the sample rate a resonator would sound at another frequency.
    std::erase_if(v.sound.modes, [&](const Mode& m) { return m.frequency_Hz > 0.45 * rate_Hz; });
    for (const Mode& mode : v.sound.modes) {
      const double lost = mode.damping_1_s / (2 * pi);
      const ModeStep step =
          mode_step(std::sqrt(std::max(1.0, mode.frequency_Hz * mode.frequency_Hz - lost * lost)),
                    mode.damping_1_s, rate_Hz);
      resonators.add(step);
      v.radiated.push_back(static_cast<double>(step.unit_gain) / v.sound.mass_kg * kAirDensity_kg_m3 *
                           kSoundSpeed_m_s *
                           radiation_m(v.sound.radiation_frequency_Hz.value_or(mode.frequency_Hz), v.sound.radius_m));
    }
    return v;
  };
  for (body_def_t body : scene.bodies) {
    const shape_def_t* shape = main_shape(scene, body.id);
    std::optional<shape_def_t> held;
    int material_index = shape ? shape->material : -1;
    if (body.tool >= 0 && body.tool < scene.tool_count) {
      const tool_def_t& tool = scene.tools[static_cast<std::size_t>(body.tool)];
      if (material_index < 0) material_index = tool.material;
      if (!shape && (held = shape_of(tool))) shape = &*held;
      body.mass_kg = std::max(1e-3, tool.mass_kg);
    }
    voices_.push_back(add(body, shape, material_index));
  }
  body_def_t none{};
  unknown_ = add(none, nullptr, -1);
  resonators_ = table;
}

const Impacts::Voice& Impacts::voice(int id) const {
  return id >= 0 && static_cast<std::size_t>(id) < voices_.size() ? voices_[static_cast<std::size_t>(id)]
                                                                  : unknown_;
}

Elastic Impacts::material(int index) const {
  return index >= 0 && static_cast<std::size_t>(index) < materials_.size()
             ? materials_[static_cast<std::size_t>(index)]
             : Elastic{};
}

PerMode Impacts::gains(int body, const std::optional<BodyPlace>& place) const {
  const Voice& v = voice(body);
  PerMode gains{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(resonators(body).count); ++i) {
    const Mode& mode = v.sound.modes[i];
    gains[i] = static_cast<float>(v.radiated[i] * (place ? gain_at(v.sound, mode, *place) : mode.gain));
  }
  return gains;
}

std::optional<BodyPlace> Impacts::place_on_body(int body, const Eigen::Vector3d& point_m,
                                          const Eigen::Vector3d& direction, const PoseOf& pose) const {
  std::optional<Eigen::Isometry3d> pose_of_body = voice(body).static_pose;
  if (!pose_of_body && pose) pose_of_body = pose(body);
  if (!pose_of_body || !pose_of_body->matrix().allFinite() || !point_m.allFinite() || !(direction.norm() > 0.5))
    return std::nullopt;
  return BodyPlace{pose_of_body->inverse() * point_m, pose_of_body->linear().transpose() * direction.normalized()};
}

// Peak pressure at 1 m of the click of a body that the impact accelerates as a whole (Chadwick, Zheng, James, "Precomputed
// acceleration noise", SIGGRAPH 2012). A blow shorter than two samples has its steepest part above half the sample rate.
double Impacts::click_Pa(const BodySound& s, double impulse_N_s, double length_s) const {
  if (!s.moves) return 0;
  return acceleration_peak_Pa(impulse_N_s / s.mass_kg, std::max(length_s, 2 / rate_Hz_), s.radius_m);
}

// Hard bodies collide repeatedly in the first 15 ms, at the times of their first four modes; the model of van den
// Doel, Kry and Pai ("FoleyAutomatic", SIGGRAPH 2001, section 3). Hard means that the blow ends before half a
// period of the mode. The repeated collisions carry their share of the impulse; the rest is the blow. Each sets in gradually: a
// blow that is a little faster sounds a little different.
ForcePulse Impacts::pulse(const Voice& a, const Voice& b, double length_s) const {
  const auto in_samples = [&](double s) { return std::max(1, static_cast<int>(std::lround(s * rate_Hz_))); };
  ForcePulse pulse = one_hump(in_samples(length_s));
  std::vector<double> frequencies;
  for (const Voice* v : {&a, &b})
    for (std::size_t i = 0; i < std::min<std::size_t>(v->sound.modes.size(), kMicroCollisions); ++i)
      if (const double f = v->sound.modes[i].frequency_Hz; 1 / f < kMicroWithin_s) frequencies.push_back(f);
  std::sort(frequencies.begin(), frequencies.end());
  // Keeps the latest times: those of the lowest modes.
  frequencies.resize(std::min<std::size_t>(frequencies.size(), kMicroCollisions));
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    const double onset = std::clamp((0.5 / (frequencies[i] * length_s) - 1) / kHardening, 0.0, 1.0);
    if (onset == 0) break;  // all other modes are higher
    const auto each = static_cast<float>(onset * settings_.micro_collisions / static_cast<double>(frequencies.size()));
    pulse[i + 1] = {in_samples(1 / frequencies[i]), pulse[0].samples, each};
    pulse[0].share -= each;
  }
  return pulse;
}

Strike Impacts::strike(const contact_event_t& event, sync::HostTime scheduled, const PoseOf& pose) const {
  Strike strike;
  strike.event_id = event.event_id;
  strike.scheduled = scheduled;
  strike.min_audible_gain = kInaudible;
  if (!plausible(event)) return strike;
  const double mass = std::clamp<double>(event.effective_mass_kg, 1e-6, kMaxMass_kg);
  const double speed = std::clamp<double>(event.approach_speed_m_s, kMinApproach_m_s, kMaxApproach_m_s);
  const double curvature = std::max<double>(event.curvature_1_m, kMinCurvature_1_m);
  const std::array<const Voice*, 2> bodies{&voice(event.body_a), &voice(event.body_b)};
  const std::array<int, 2> ids{event.body_a, event.body_b}, surfaces{event.material_a, event.material_b};
  const auto surface = [&](std::size_t i) {
    return surfaces[i] >= 0 ? material(surfaces[i]) : bodies[i]->sound.material;
  };
  const Elastic a = surface(0), b = surface(1);
  const double impulse = mass * speed * (1 + std::clamp(std::min(a.restitution, b.restitution), 0.0, 1.0));
  const double length_s = std::min(settings_.longest_contact_s, contact_time_s(mass, curvature, speed, a, b));

  strike.impulse_N_s = static_cast<float>(impulse), strike.speed_m_s = static_cast<float>(speed);
  const Eigen::Vector3d point = to_eigen(event.point_m), normal = to_eigen(event.normal);
  const SourcePosition place = place_of(listener_, point, settings_.nearest_m);
  for (std::size_t i = 0; i < 2; ++i) {
    StrikeSide& side = strike.sides[i];
    side.voice = voice_id(ids[i]);
    side.resonators = &(*resonators_)[bodies[i]->number];
    side.gains = gains(ids[i], place_on_body(ids[i], point, i == 0 ? Eigen::Vector3d(-normal) : normal, pose));
    side.impulse = static_cast<float>(impulse);
    side.click = static_cast<float>(click_Pa(bodies[i]->sound, impulse, length_s));
    side.place = place;
  }
  // Full scale per Pa. The level is that of the undivided blow, between those of the two nearest whole numbers of samples: it rises
  // with the speed, also where repeated collisions set in and where the blow becomes one sample shorter.
  const double length = std::max(1.0, length_s * rate_Hz_), more = length - std::floor(length);
  const int shorter = static_cast<int>(length);
  double pressure = blow_Pa(strike, shorter, rate_Hz_);
  if (more > 0) pressure += more * (blow_Pa(strike, shorter + 1, rate_Hz_) - pressure);
  const double level = played_level(std::max(pressure, 1e-9), settings_);
  strike.pulse = pulse(*bodies[0], *bodies[1], length_s);
  const auto steepest_change = steepest(one_hump(strike.pulse[0].samples));
  for (StrikeSide& side : strike.sides) side.click /= steepest_change;
  const double played = std::max(peak_Pa(strike, rate_Hz_), 1e-9);
  const auto scale = static_cast<float>(settings_.gain * level / played);
  for (StrikeSide& side : strike.sides) side.impulse *= scale, side.click *= scale;
  const double peak_level = settings_.gain * level / static_cast<double>(place.distance_m);
  strike.min_audible_gain = static_cast<float>(settings_.inaudible_level / std::max(peak_level, 1e-12));
  return strike;
}

}  // namespace tactus::audio
