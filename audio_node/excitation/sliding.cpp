#include "audio_node/excitation/sliding.h"

#include <algorithm>
#include <cmath>
#include <tactus/body_def_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <utility>

#include "audio_node/excitation/contact_patch.h"
#include "audio_node/modal/finish.h"
#include "audio_node/signal/loudness.h"
#include "audio_node/signal/plausible.h"
#include "audio_node/excitation/scrape.h"
#include "lcmtypes/vectors.h"

namespace tactus::audio {
namespace {

using Eigen::Vector3d;

// Upper bounds of loudness and speed, beyond those of any hand, for any input from the bus.
constexpr double kMaxSpeed_m_s = 5, kMaxForce_N = 50;
constexpr double kEdge_1_m = 1000;  // fallback: a corner rounded by 1 mm (design)
// Gains depend on the place: they are recomputed after this distance or time. Design: below a tenth of the bending
// waves of a floor board with 64 modes.
constexpr double kGainsValid_m = 0.002, kGainsValid_s = 0.05;
// Above this number, contacts are processed only at the rate of their snapshots. Design: 0.1 ms.
constexpr std::size_t kManyContacts = 50;
// An audible contact is replaced only by one that is stronger by this factor. Design.
constexpr double kReplacementFactor = 2;
// Reference for the law of level: 1 N at 0.1 m/s, with friction 0.5, W^(1/2) (design).
constexpr double kReferenceForce_N = 1, kReferenceSpeed_m_s = 0.1, kReferenceStrength = 0.22360679774997896;
// Crest factor of noise: peak over rms (design).
constexpr double kCrest = 3;
constexpr double kHearingThreshold_Pa = 20e-6;  // threshold at 1 kHz (ISO 226): weaker sounds are not raised further
// The heavier side of a rolling body. Design: not an axis of a box.
const Vector3d kHeavySide = Vector3d(2, -1, 2) / 3;

Vector3d clamped(const Vector3d& v, double max_norm) { return v.norm() > max_norm ? Vector3d(v * (max_norm / v.norm())) : v; }

}  // namespace

double sliding_strength(double friction, double force_N, double speed_m_s) {
  return std::sqrt(friction * force_N * speed_m_s);
}

Sliding::Sliding(const scene_t& scene, std::shared_ptr<const AudioSurfaces> surfaces,
                 const sync::BodyHistory& bodies, const Impacts& impacts, const Settings& settings, double rate_Hz)
    : settings_(settings),
      rate_Hz_(rate_Hz),
      listener_(to_eigen(scene.listener)),
      surfaces_(std::move(surfaces)),
      bodies_(bodies),
      impacts_(impacts),
      materials_(scene.materials),
      masses_kg_(scene.bodies.size()),
      curvatures_1_m_(scene.bodies.size()) {
  for (const body_def_t& b : scene.bodies) {
    if (b.is_static) static_orientations_[b.id] = to_eigen(b.pose.orientation);
    if (!b.is_static && b.id >= 0 && static_cast<std::size_t>(b.id) < masses_kg_.size())
      masses_kg_[static_cast<std::size_t>(b.id)] = b.mass_kg;
  }
  for (const shape_def_t& s : scene.shapes) {
    const bool round =
        s.kind == shape_def_t::SPHERE || s.kind == shape_def_t::CYLINDER || s.kind == shape_def_t::CAPSULE;
    if (round && s.body >= 0 && static_cast<std::size_t>(s.body) < curvatures_1_m_.size() && s.size_m.x > 0)
      curvatures_1_m_[static_cast<std::size_t>(s.body)] = 1 / s.size_m.x;
  }
}

Elastic Sliding::elastic_of(std::int32_t material, std::int32_t body) const {
  const auto i = static_cast<std::size_t>(material);
  return material >= 0 && i < materials_.size() ? elastic(materials_[i]) : impacts_.body(body).material;
}

Sliding::ContactSurface Sliding::contact_surface(const contact_t& c, std::size_t side, sync::SimTime t) const {
  ContactSurface g{side == 0 ? c.body_a : c.body_b, side == 0 ? c.material_a : c.material_b, nullptr, {}};
  g.maps = surfaces_->of(g.material);
  if (const auto static_orientation = static_orientations_.find(g.body); static_orientation != static_orientations_.end())
    g.to_body = static_orientation->second.conjugate();
  else if (const auto pose = bodies_.pose(g.body, t); pose.status != sync::SampleStatus::kNone)
    g.to_body = pose.value.orientation.conjugate();
  return g;
}

// The contact patch of round bodies is computed from their shape; otherwise the simulation reports its area. The
// profile does not lift a rolling body: the rms force is at most the load.
Sliding::Patch Sliding::patch(const contact_t& c, double force_N, double speed_m_s, double rms_slope) const {
  double curvature = 0, mobility_1_kg = 0;
  for (const std::int32_t body : {c.body_a, c.body_b}) {
    const auto i = static_cast<std::size_t>(body);
    if (body < 0 || i >= curvatures_1_m_.size()) continue;
    curvature += curvatures_1_m_[i];
    if (masses_kg_[i] > 0) mobility_1_kg += 1 / masses_kg_[i];
  }
  const double reduced =
      reduced_modulus_Pa(elastic_of(c.material_a, c.body_a), elastic_of(c.material_b, c.body_b));
  if (curvature == 0 && !(c.area_m2 > 0)) curvature = kEdge_1_m;
  const double radius = curvature > 0 ? patch_radius_m(force_N, curvature, reduced)
                                      : std::sqrt(static_cast<double>(c.area_m2) / M_PI);
  const double mass = mobility_1_kg > 0 ? 1 / mobility_1_kg : 1;
  return {patch_cutoff_Hz(speed_m_s, radius),
          std::min(rolling_force_N(radius, reduced, mass, speed_m_s), force_N / std::max(rms_slope, 1e-9))};
}

// Rms slope of the finish of both surfaces. Only a surface with known orientation contributes.
double Sliding::rms_slope(const std::array<ContactSurface, 2>& surfaces) const {
  double sum = 0;
  for (const ContactSurface& g : surfaces)
    if (g.to_body) sum += mean_square_slope({finish_m(elastic_of(g.material, g.body)), 0});
  return std::sqrt(sum);
}

// Imbalance of a rolling body: its weight varies once per revolution with the side in contact.
double Sliding::imbalance_gain(const Candidate& c) const {
  double factor = 1;
  const Vector3d normal = to_eigen(c.contact->normal);
  for (std::size_t i = 0; i < 2; ++i) {
    const ContactSurface& g = c.surfaces[i];
    if (!g.to_body || static_orientations_.contains(g.body)) continue;
    factor *= 1 + settings_.turn_depth * (*g.to_body * (i == 0 ? normal : Vector3d(-normal))).dot(kHeavySide);
  }
  return factor;
}

std::optional<Sliding::Candidate> Sliding::candidate(const contact_t& c, sync::SimTime t, double dt_s) {
  const Vector3d sliding_velocity = clamped(to_eigen(c.sliding_velocity_m_s), kMaxSpeed_m_s);
  if (c.points.empty() || !sliding_velocity.allFinite()) return std::nullopt;
  Candidate k{&c, nullptr, {contact_surface(c, 0, t), contact_surface(c, 1, t)}, 1, 0, 0, 0};
  const auto rank = [&](const ContactSurface& g) {
    return g.to_body ? 1 + (g.maps ? 2 : 0) + (static_orientations_.contains(g.body) ? 1 : 0) : 0;
  };
  const std::size_t best = rank(k.surfaces[1]) > rank(k.surfaces[0]) ? 1 : 0;
  if (!k.surfaces[best].to_body) return std::nullopt;
  k.state = &contacts_[c.contact_id];
  k.state->present = true;
  ContactMotion& motion = k.state->motion;
  motion.step(c, {k.surfaces[0].to_body, k.surfaces[1].to_body}, best, sliding_velocity, dt_s);
  const double force_N = std::clamp<double>(static_cast<double>(c.normal_force_N), 0, kMaxForce_N);
  double mu = 1;  // a body without a material takes the friction of the other
  for (const ContactSurface& g : k.surfaces) {
    const auto i = static_cast<std::size_t>(g.material);
    if (g.material >= 0 && i < materials_.size()) mu *= materials_[i].friction_dynamic;
  }
  k.friction = std::clamp(std::sqrt(std::max(0.0, mu)), 0.0, kMaxFriction);
  const double rolling = std::min(motion.velocity().rolling.norm(), kMaxSpeed_m_s);
  k.slide = motion.sliding_degree() * settings_.scrape_force_N * sliding_strength(k.friction, force_N, sliding_velocity.norm());
  if (motion.rolling_degree() > 0) {
    const Patch contact_patch = patch(c, force_N, rolling, rms_slope(k.surfaces));
    k.roll = motion.rolling_degree() * contact_patch.force_N * imbalance_gain(k);
    k.cutoff_Hz = contact_patch.cutoff_Hz;
  }
  if (!(k.strength() > 0) || !std::isfinite(k.strength()) || !std::isfinite(k.cutoff_Hz)) return std::nullopt;
  return k;
}

void Sliding::update_gains(const Candidate& k, sync::SimTime t, double dt_s) const {
  ContactState& state = *k.state;
  const contact_t& c = *k.contact;
  const Vector3d point = to_eigen(c.points[state.motion.point()].a_world_m), normal = to_eigen(c.normal);
  state.since_s += dt_s;
  if (state.gains_point_m && (*state.gains_point_m - point).norm() < kGainsValid_m && state.since_s < kGainsValid_s) return;
  const bool first = !state.gains_point_m;
  state.gains_point_m = point, state.since_s = 0;
  const PoseOf pose = [&](int body) -> std::optional<Eigen::Isometry3d> {
    const auto p = bodies_.pose(body, t);
    if (p.status == sync::SampleStatus::kNone) return std::nullopt;
    return Eigen::Translation3d(p.value.position) * p.value.orientation;
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const int body = k.surfaces[i].body;
    state.gains[i] = impacts_.gains(body, impacts_.place_on_body(body, point, i == 0 ? Vector3d(-normal) : normal, pose));
    if (first) estimate_loudness(k, i);
  }
}

// Uses the gains at an average place: on a nodal line the contact must be quiet.
void Sliding::estimate_loudness(const Candidate& k, std::size_t side) const {
  const int body = k.surfaces[side].body;
  const PerMode gains = impacts_.gains(body, std::nullopt);
  const Resonators& r = impacts_.resonators(body);
  const auto count = static_cast<std::size_t>(r.count);
  // A mode driven by white noise of variance 1 per sample has the variance g^2 / (1 - r^2) / 2, for an oscillation
  // whose envelope falls by r a sample.
  const Patch reference = patch(*k.contact, kReferenceForce_N, kReferenceSpeed_m_s, 0);
  const auto patch_gain = [&](double f_Hz) { return 1 / (1 + std::pow(f_Hz / reference.cutoff_Hz, 4)); };
  double all = 0, last = 0, rolling = 0;
  for (std::size_t m = 0; m < count; ++m) {
    const double variance =
        0.5 * std::pow(static_cast<double>(gains[m]), 2) / std::max(1e-9, 1 - static_cast<double>(r.damping[m]));
    all += variance;
    rolling += variance * patch_gain(impacts_.body(body).modes[m].frequency_Hz);
    if (4 * m >= 3 * count) last += variance;
  }
  // A plate has constant modal density in Hz, and its modes lose sound with the square of their frequency (beta of
  // Rayleigh). All modes above the highest rendered one together have the variance of `count` modes like the
  // highest: four times `last`, the sum over the highest quarter of the rendered modes. They decay before they are
  // distinguishable. A measured body has only its recorded modes.
  const bool measured = impacts_.body(body).radiation_frequency_Hz.has_value();
  const bool truncated = !measured && count > 0 && r.count >= std::min(settings_.max_modes, kMaxModes);
  const double residual = truncated ? 4 * last : 0;
  k.state->sliding_Pa_N[side] = std::sqrt(all + residual) / rate_Hz_;
  k.state->residual_Pa_N[side] = std::sqrt(residual) / rate_Hz_;
  if (residual > 0) rolling += residual * patch_gain(impacts_.body(body).modes.back().frequency_Hz);
  k.state->rolling_Pa_N[side] = std::sqrt(rolling) / rate_Hz_;
}

ScrapeSide Sliding::side(const Candidate& k, std::size_t i) const {
  const ContactSurface& g = k.surfaces[i];
  const ContactVelocity& velocity = k.state->motion.velocity();
  ScrapeSide s;
  s.voice = impacts_.voice_id(g.body);
  s.resonators = impacts_.resonators(g.body);
  s.gains = k.state->gains[i];
  if (k.state->residual_Pa_N[i] > 0) {
    // Per N s and sample, like the gains.
    s.residual_gain = static_cast<float>(k.state->residual_Pa_N[i] * rate_Hz_);
    s.residual_Hz = impacts_.body(g.body).modes.back().frequency_Hz;
  }
  if (!g.to_body) return s;
  s.known = true;
  s.outward = *g.to_body * Vector3d((i == 0 ? 1 : -1) * to_eigen(k.contact->normal));
  s.axes = bump_axes(s.outward);
  if (g.maps) s.relief = g.maps->relief.get(), s.friction = g.maps->friction.get();
  s.roughness = {finish_m(elastic_of(g.material, g.body)), s.relief ? s.relief->texel_m() : 0};
  s.place_m = k.state->motion.place_m(i);
  s.velocity_m_s = *g.to_body * velocity.surface[i];
  const double sliding = (velocity.surface[0] - velocity.surface[1]).norm(), rolling = velocity.rolling.norm();
  if (sliding > 0) s.slide_vector = (*g.to_body * (velocity.surface[i] - velocity.rolling) / sliding).cast<float>();
  if (rolling > 0) s.roll_vector = (*g.to_body * velocity.rolling / rolling).cast<float>();
  return s;
}

Scrape Sliding::scrape(const Candidate& k, sync::SimTime t, sync::HostTime at, double dt_s) {
  update_gains(k, t, dt_s);
  const contact_t& c = *k.contact;
  Scrape s;
  s.id = c.contact_id;
  s.at = at;
  s.update_interval_s = period_s();
  s.cutoff_Hz = k.cutoff_Hz;
  double sliding_slope_squared = 0, sliding_Pa2_N2 = 0, rolling_Pa2_N2 = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    ScrapeSide& side = s.sides[i] = this->side(k, i);
    sliding_Pa2_N2 += k.state->sliding_Pa_N[i] * k.state->sliding_Pa_N[i];
    rolling_Pa2_N2 += k.state->rolling_Pa_N[i] * k.state->rolling_Pa_N[i];
    // The reference level is that without a map: a map makes the sound louder, but does not reduce the roughness.
    if (side.known)
      sliding_slope_squared += static_cast<double>(side.slide_vector.squaredNorm()) * mean_square_slope({side.roughness.height_m, 0});
  }
  // Full scale per N: the reference over these two bodies is as loud as a blow of friction_level times the expected
  // pressure; other contacts scale by their force. Friction is that of the surfaces without their maps, which the callback reads
  // along the path.
  const auto scale = [&](double force_N, double slope, double Pa2_N2) {
    const double expected = std::max(kHearingThreshold_Pa, kCrest * force_N * slope * std::sqrt(Pa2_N2));
    return settings_.gain * played_level(settings_.friction_level * expected, settings_) / expected / rate_Hz_;
  };
  if (k.slide > 0)
    s.slide = static_cast<float>(k.slide *
                                 scale(settings_.scrape_force_N * kReferenceStrength, std::sqrt(sliding_slope_squared), sliding_Pa2_N2));
  if (k.roll > 0) {
    const double steep = rms_slope(k.surfaces);
    const Patch reference = patch(c, kReferenceForce_N, kReferenceSpeed_m_s, steep);
    s.roll = static_cast<float>(k.roll * scale(reference.force_N, steep, rolling_Pa2_N2));
  }
  s.place = place_of(listener_, to_eigen(c.points[k.state->motion.point()].a_world_m), settings_.nearest_m);
  return s;
}

const std::vector<Scrape>& Sliding::scrapes(const sync::Contacts& contacts, sync::SimTime t, sync::HostTime at,
                                            double dt_s) {
  out_.clear();
  candidates_.clear();
  dt_s = std::clamp(dt_s, 0.0, 0.1);
  many_contacts_ = contacts.size() > kManyContacts;
  for (auto& [id, state] : contacts_) state.present = false;
  for (const contact_t& c : contacts)
    if (plausible(c))
      if (auto found = candidate(c, t, dt_s)) candidates_.push_back(*found);
  const auto max_count = std::min<std::size_t>(candidates_.size(), kMaxScrapes);
  const auto priority = [](const Candidate& k) { return k.strength() * (k.state->audible ? kReplacementFactor : 1); };
  std::partial_sort(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(max_count),
                    candidates_.end(), [&](const Candidate& a, const Candidate& b) { return priority(a) > priority(b); });
  candidates_.resize(max_count);
  // Contacts that are not selected end first, to free places.
  for (auto& [id, state] : contacts_) {
    const auto is_selected = [&, state = &state](const Candidate& k) { return k.state == state; };
    if (!std::exchange(state.audible, std::any_of(candidates_.begin(), candidates_.end(), is_selected)) || state.audible)
      continue;
    Scrape end;
    end.id = id, end.at = at, end.ends = true;
    out_.push_back(end);
  }
  for (const Candidate& k : candidates_) out_.push_back(scrape(k, t, at, dt_s));
  std::erase_if(contacts_, [](const auto& l) { return !l.second.present; });
  return out_;
}

}  // namespace tactus::audio
