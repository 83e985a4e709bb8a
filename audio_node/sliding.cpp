#include "audio_node/sliding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "audio_node/contact_patch.h"
#include "audio_node/finish.h"
#include "audio_node/loudness.h"
#include "audio_node/plausible.h"
#include "audio_node/scrapes.h"
#include "lcmtypes/vectors.h"

namespace tactus::audio {
namespace {

using Eigen::Vector3d;

// Beyond these nothing becomes louder or faster: no hand does so, and nothing on the bus shall.
constexpr double kMostSpeed_m_s = 5, kMostForce_N = 50;
// Gains go with the place: anew when it has gone so far, or so long ago. Design: below a tenth of the bending
// waves that 64 modes of a floor board have.
constexpr double kNear_m = 0.002, kGainsFor_s = 0.05;
// More contacts than these are looked at as often as they are told. Design: 0.1 ms.
constexpr std::size_t kMany = 50;
// Who is heard gives way to who is so much stronger. Design.
constexpr double kGivesWay = 2;
// W^(1/2), of 1 N at 0.1 m/s with friction 0.5 (design).
constexpr double kReferenceStrength = 0.22360679774997896;
// Of noise, over its rms (design).
constexpr double kCrest = 3;
constexpr double kHearing_Pa = 20e-6;  // threshold at 1 kHz (ISO 226): weaker ones are no more raised than that
// The heavier side of a body that rolls. Design: an axis of no box.
const Vector3d kHeavySide = Vector3d(2, -1, 2) / 3;

Vector3d bounded(const Vector3d& v, double most) { return v.norm() > most ? Vector3d(v * (most / v.norm())) : v; }

}  // namespace

double sliding_strength(double friction, double force_N, double speed_m_s) {
  return std::sqrt(friction * force_N * speed_m_s);
}

Sliding::Sliding(const scene_t& scene, std::shared_ptr<const HeardSurfaces> surfaces,
                 const sync::BodyHistory& bodies, const Impacts& impacts, const Settings& settings, double rate_Hz)
    : settings_(settings),
      rate_Hz_(rate_Hz),
      listener_(to_eigen(scene.listener)),
      surfaces_(std::move(surfaces)),
      bodies_(bodies),
      impacts_(impacts),
      materials_(scene.materials),
      curvatures_1_m_(scene.bodies.size()) {
  for (const body_def_t& b : scene.bodies)
    if (b.is_static) standing_[b.id] = to_eigen(b.pose.orientation);
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

Sliding::Ground Sliding::ground(const contact_t& c, std::size_t side, sync::SimTime t) const {
  Ground g{side == 0 ? c.body_a : c.body_b, side == 0 ? c.material_a : c.material_b, nullptr, {}};
  g.surface = surfaces_->of(g.material);
  if (const auto stands = standing_.find(g.body); stands != standing_.end())
    g.to_body = stands->second.conjugate();
  else if (const auto pose = bodies_.pose(g.body, t); pose.how != sync::How::kNone)
    g.to_body = pose.value.orientation.conjugate();
  return g;
}

// Of what is round by its shape; else as large as the simulation says.
double Sliding::cutoff_Hz(const contact_t& c, double force_N, double speed_m_s) const {
  double curvature = 0;
  for (const std::int32_t body : {c.body_a, c.body_b})
    if (body >= 0 && static_cast<std::size_t>(body) < curvatures_1_m_.size())
      curvature += curvatures_1_m_[static_cast<std::size_t>(body)];
  const double reduced =
      reduced_modulus_Pa(elastic_of(c.material_a, c.body_a), elastic_of(c.material_b, c.body_b));
  const double radius = curvature > 0 ? patch_radius_m(force_N, curvature, reduced)
                                      : std::sqrt(std::max(0.0, static_cast<double>(c.area_m2)) / M_PI);
  return patch_cutoff_Hz(speed_m_s, radius);
}

// Once a turn a body that rolls is heavier: as it lies on the place that it touches with.
double Sliding::turn(const Candidate& c) const {
  double factor = 1;
  const Vector3d normal = to_eigen(c.contact->normal);
  for (std::size_t i = 0; i < 2; ++i) {
    const Ground& g = c.grounds[i];
    if (!g.to_body || standing_.contains(g.body)) continue;
    factor *= 1 + settings_.turn_depth * (*g.to_body * (i == 0 ? normal : Vector3d(-normal))).dot(kHeavySide);
  }
  return factor;
}

std::optional<Sliding::Candidate> Sliding::candidate(const contact_t& c, sync::SimTime t, double dt_s) {
  const Vector3d past = bounded(to_eigen(c.sliding_velocity_m_s), kMostSpeed_m_s);
  if (c.points.empty() || !past.allFinite()) return std::nullopt;
  Candidate k{&c, nullptr, {ground(c, 0, t), ground(c, 1, t)}, 1, 0, 0, 0};
  const auto surest = [&](const Ground& g) {
    return g.to_body ? 1 + (g.surface ? 2 : 0) + (standing_.contains(g.body) ? 1 : 0) : 0;
  };
  const std::size_t best = surest(k.grounds[1]) > surest(k.grounds[0]) ? 1 : 0;
  if (!k.grounds[best].to_body) return std::nullopt;
  k.live = &live_[c.contact_id];
  k.live->seen = true;
  ContactWay& way = k.live->way;
  way.step(c, {k.grounds[0].to_body, k.grounds[1].to_body}, best, past, dt_s);
  const double force_N = std::clamp<double>(static_cast<double>(c.normal_force_N), 0, kMostForce_N);
  double mu = 1;  // one without a material: that of the other counts
  for (const Ground& g : k.grounds) {
    const auto i = static_cast<std::size_t>(g.material);
    if (g.material >= 0 && i < materials_.size()) mu *= materials_[i].friction_dynamic;
  }
  k.friction = std::clamp(std::sqrt(std::max(0.0, mu)), 0.0, kMostFriction);
  const double rolling = std::min(way.over().rolling.norm(), kMostSpeed_m_s);
  k.slide = way.slides() * sliding_strength(k.friction, force_N, past.norm());
  k.roll = way.rolls() * sliding_strength(settings_.rolling_resistance, force_N, rolling) * turn(k);
  k.cutoff_Hz = cutoff_Hz(c, force_N, rolling);
  if (!(k.strength() > 0) || !std::isfinite(k.strength()) || !std::isfinite(k.cutoff_Hz)) return std::nullopt;
  return k;
}

void Sliding::find_gains(const Candidate& k, sync::SimTime t, double dt_s) const {
  Live& live = *k.live;
  const contact_t& c = *k.contact;
  const Vector3d point = to_eigen(c.points[live.way.point()].a_world_m), normal = to_eigen(c.normal);
  live.since_s += dt_s;
  if (live.struck_m && (*live.struck_m - point).norm() < kNear_m && live.since_s < kGainsFor_s) return;
  const bool first = !live.struck_m;
  live.struck_m = point, live.since_s = 0;
  const PoseOf pose = [&](int body) -> std::optional<Eigen::Isometry3d> {
    const auto p = bodies_.pose(body, t);
    if (p.how == sync::How::kNone) return std::nullopt;
    return Eigen::Translation3d(p.value.position) * p.value.orientation;
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const int body = k.grounds[i].body;
    live.gains[i] = impacts_.gains(body, impacts_.on_body(body, point, i == 0 ? Vector3d(-normal) : normal, pose));
    if (first) find_loudness(k, i);
  }
}

// By gains as of anywhere: on a nodal line it shall be quiet.
void Sliding::find_loudness(const Candidate& k, std::size_t side) const {
  const int body = k.grounds[side].body;
  const PerMode gains = impacts_.gains(body, std::nullopt);
  const Resonators& r = impacts_.resonators(body);
  const auto count = static_cast<std::size_t>(r.count);
  // A mode that is pushed by white noise of variance 1 a sample has the variance g^2 / (1 - r^2) / 2 of an
  // oscillation whose envelope falls by r a sample.
  double all = 0, last = 0;
  for (std::size_t m = 0; m < count; ++m) {
    const double one =
        0.5 * std::pow(static_cast<double>(gains[m]), 2) / std::max(1e-9, 1 - static_cast<double>(r.damping[m]));
    all += one;
    if (4 * m >= 3 * count) last += one;
  }
  // A plate has as many modes in each Hz, which lose sound as the square of their frequency (beta of Rayleigh):
  // all above the highest that is rendered have together the variance of `count` such as it, of which a quarter
  // was added up. They die away before anybody could tell them apart.
  // A measured body has the modes that it was heard to have.
  const bool measured = impacts_.body(body).radiates_as_Hz.has_value();
  const bool cut = !measured && count > 0 && r.count >= std::min(settings_.max_modes, kMaxModes);
  const double beyond = cut ? 4 * last : 0;
  k.live->heard_Pa_N[side] = std::sqrt(all + beyond) / rate_Hz_;
  k.live->beyond_Pa_N[side] = std::sqrt(beyond) / rate_Hz_;
}

ScrapeSide Sliding::side(const Candidate& k, std::size_t i) const {
  const Ground& g = k.grounds[i];
  const Over& over = k.live->way.over();
  ScrapeSide s;
  s.voice = impacts_.voice_id(g.body);
  s.resonators = impacts_.resonators(g.body);
  s.gains = k.live->gains[i];
  if (k.live->beyond_Pa_N[i] > 0) {
    // Per N s a sample, as gains are.
    s.beyond = static_cast<float>(k.live->beyond_Pa_N[i] * rate_Hz_);
    s.beyond_Hz = impacts_.body(g.body).modes.back().frequency_Hz;
  }
  if (!g.to_body) return s;
  s.known = true;
  s.outward = *g.to_body * Vector3d((i == 0 ? 1 : -1) * to_eigen(k.contact->normal));
  s.axes = bump_axes(s.outward);
  if (g.surface) s.relief = g.surface->relief.get(), s.friction = g.surface->friction.get();
  s.roughness = {finish_m(elastic_of(g.material, g.body)), s.relief ? s.relief->texel_m() : 0};
  s.place_m = k.live->way.place_m(i);
  s.velocity_m_s = *g.to_body * over.surface[i];
  const double sliding = (over.surface[0] - over.surface[1]).norm(), rolling = over.rolling.norm();
  if (sliding > 0) s.slides = (*g.to_body * (over.surface[i] - over.rolling) / sliding).cast<float>();
  if (rolling > 0) s.rolls = (*g.to_body * over.rolling / rolling).cast<float>();
  return s;
}

Scrape Sliding::scrape(const Candidate& k, sync::SimTime t, sync::HostTime at, double dt_s) {
  find_gains(k, t, dt_s);
  const contact_t& c = *k.contact;
  Scrape s;
  s.id = c.contact_id;
  s.at = at;
  s.over_s = period_s();
  s.cutoff_Hz = k.cutoff_Hz;
  double steep = 0, pressure = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    ScrapeSide& side = s.sides[i] = this->side(k, i);
    pressure += k.live->heard_Pa_N[i] * k.live->heard_Pa_N[i];
    if (!side.known) continue;
    const double share = static_cast<double>(std::max(side.slides.squaredNorm(), side.rolls.squaredNorm()));
    // As of its material alone: a map makes it louder, not its roughness quieter.
    steep += share * mean_square_slope({side.roughness.height_m, 0});
  }
  // Full scale per Pa: the reference stroke over these two is as loud as a blow of the pressure that is to be
  // expected, were the force white; others by their strength. Friction is that of the surfaces without their maps,
  // which the callback reads on the way.
  const double expected =
      std::max(kHearing_Pa, kCrest * settings_.scrape_force_N * kReferenceStrength * std::sqrt(steep * pressure));
  const double scale =
      settings_.gain * level_of(expected, settings_) / expected * settings_.scrape_force_N / rate_Hz_;
  s.slide = static_cast<float>(scale * k.slide);
  s.roll = static_cast<float>(scale * k.roll);
  s.place = place_of(listener_, to_eigen(c.points[k.live->way.point()].a_world_m), settings_.nearest_m);
  return s;
}

const std::vector<Scrape>& Sliding::scrapes(const sync::Contacts& contacts, sync::SimTime t, sync::HostTime at,
                                            double dt_s) {
  out_.clear();
  candidates_.clear();
  dt_s = std::clamp(dt_s, 0.0, 0.1);
  many_ = contacts.size() > kMany;
  for (auto& [id, live] : live_) live.seen = false;
  for (const contact_t& c : contacts)
    if (plausible(c))
      if (auto found = candidate(c, t, dt_s)) candidates_.push_back(*found);
  const auto most = std::min<std::size_t>(candidates_.size(), Scrapes::kMost);
  const auto kept = [](const Candidate& k) { return k.strength() * (k.live->heard ? kGivesWay : 1); };
  std::partial_sort(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(most),
                    candidates_.end(), [&](const Candidate& a, const Candidate& b) { return kept(a) > kept(b); });
  candidates_.resize(most);
  // Who is not among them ends first, to make room.
  for (auto& [id, live] : live_) {
    const auto is_it = [&, live = &live](const Candidate& k) { return k.live == live; };
    if (!std::exchange(live.heard, std::any_of(candidates_.begin(), candidates_.end(), is_it)) || live.heard)
      continue;
    Scrape end;
    end.id = id, end.at = at, end.ends = true;
    out_.push_back(end);
  }
  for (const Candidate& k : candidates_) out_.push_back(scrape(k, t, at, dt_s));
  std::erase_if(live_, [](const auto& l) { return !l.second.seen; });
  return out_;
}

}  // namespace tactus::audio
