#include "audio_node/excitation/sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tactus/contact_t.hpp>
#include <tactus/material_def_t.hpp>

#include "audio_node/signal/plausible.h"
#include "audio_node/samples/loops.h"
#include "lcmtypes/vectors.h"

namespace tactus::audio {
namespace {

// Maximum level of a blow: 12 dB above its recording. Computed blows have the same limit above the reference
// (design).
constexpr double kMaxLevel = 4;
// At most one octave up or down; beyond it a recording sounds like another material (design).
constexpr double kMinPitch = 0.5, kMaxPitch = 2;
// The same limits as for scrapes: below the minimum there is no sliding or rolling; above the maximum loudness and
// speed are clamped (design).
constexpr double kMinSpeed_m_s = 1e-3, kMaxRecordedSpeed_m_s = 5, kMaxRecordedForce_N = 50;
// Between two updates of contacts; a longer interval is a gap (design).
constexpr double kMaxStep_s = 0.1;
constexpr float kHalfPower = std::numbers::sqrt2_v<float> / 2;

// Size of a pair: the smaller of the two, by which a ball on a floor or a hand on a bar is recognised (design).
double size_of(const BodySound& a, const BodySound& b) { return std::min(a.radius_m, b.radius_m); }

}  // namespace

MethodGains gains_of(const Settings& s) {
  if (s.method == "samples") return {0, 1};
  if (s.method != "both") return {1, 0};
  // Exactly zero for the unwanted method, which then costs nothing.
  if (s.mix <= 0) return {1, 0};
  if (s.mix >= 1) return {0, 1};
  const double angle = s.mix * std::numbers::pi / 2;
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

double recorded_blow_level(double impulse_N_s, const Settings& s) {
  const double relative = std::max(impulse_N_s, 0.0) / s.recorded_impulse_Ns;
  return s.gain * s.recorded_level * std::min(kMaxLevel, std::pow(relative, s.loudness_exponent));
}

double pitch_of(double size_m, double recorded_size_m) {
  return std::clamp(recorded_size_m / std::max(size_m, 1e-6), kMinPitch, kMaxPitch);
}

Sampler::Sampler(const scene_t& scene, const Settings& settings)
    : settings_(settings), listener_(to_eigen(scene.listener)) {
  for (const material_def_t& m : scene.materials) {
    materials_.push_back(m.name);
    mu_.push_back(m.friction_dynamic);
  }
}

std::string Sampler::material(std::int32_t i) const {
  return i >= 0 && static_cast<std::size_t>(i) < materials_.size() ? materials_[static_cast<std::size_t>(i)] : "";
}

void Sampler::report_missing(const std::string& a, const std::string& b, Interaction interaction,
                  const Database::Found& found) {
  if (found.pair || !reported_missing_.insert({pair_of(a, b), interaction}).second) return;
  const auto named = [](const std::string& m) { return m.empty() ? std::string("(no material)") : m; };
  const std::string of = named(a) + " on " + named(b) + ": no recording of this " + name(interaction);
  if (!found.any()) return messages_.push_back(of + "; it is computed");
  std::string materials = found.alone[0] ? a : b;
  if (found.alone[0] && found.alone[1]) materials += " and of " + b;
  messages_.push_back(of + "; that of " + materials + " alone is played");
}

Database::Found Sampler::find(std::int32_t a, std::int32_t b, Interaction interaction) {
  if (!enabled()) return {};
  const std::string of_a = material(a), of_b = material(b);
  const Database::Found found = database_->find(of_a, of_b, interaction);
  report_missing(of_a, of_b, interaction, found);
  return found;
}

void Sampler::add_recordings(Strike& strike, const contact_event_t& event, const Impacts& impacts) {
  const Database::Found found = find(event.material_a, event.material_b, Interaction::kImpact);
  if (!found.any() || !plausible(event)) return;
  const MethodGains method = gains_of(settings_);
  const double level = recorded_blow_level(static_cast<double>(strike.impulse_N_s), settings_);
  const BodySound &a = impacts.body(event.body_a), &b = impacts.body(event.body_b);
  std::size_t next = 0;
  float peak = 0;
  const auto add = [&](const Layers& layers, double size_m, float share) {
    const LayerMix mix = mix_of(layers, static_cast<double>(strike.speed_m_s));
    for (std::size_t k = 0; k < 2; ++k) {
      if (mix.layer[k] < 0) continue;
      const Layer& layer = layers.by_speed[static_cast<std::size_t>(mix.layer[k])];
      const Recording& take = select_take(layer, event.event_id);
      const float gain = static_cast<float>(level) * share * layer.gain * mix.gain[k] * method.recorded;
      strike.recorded.shots[next++] = {&take, gain, static_cast<float>(pitch_of(size_m, layers.size_m))};
      peak += gain * take.peak;
    }
  };
  if (found.pair) add(*found.pair, size_of(a, b), 1);
  const float each = found.alone[0] && found.alone[1] ? kHalfPower : 1;
  if (found.alone[0]) add(*found.alone[0], a.radius_m, each);
  if (found.alone[1]) add(*found.alone[1], b.radius_m, each);
  strike.recorded.database = database_number_;
  strike.recorded.place = strike.sides[0].place;
  for (StrikeSide& side : strike.sides) {
    side.impulse *= method.modal, side.click *= method.modal;
    if (method.modal <= 0) side.voice = -1;  // costs nothing
  }
  // Both are known by their peaks; the sum is at least as loud as the louder one.
  const auto inaudible = static_cast<float>(settings_.inaudible_level);
  const float computed = inaudible / std::max(strike.min_audible_gain, 1e-12f) * method.modal;
  strike.min_audible_gain = inaudible / std::max({computed, peak / strike.recorded.place.distance_m, 1e-12f});
}

void Sampler::add_contact(const contact_t& c, Interaction interaction, double speed_m_s, double level, sync::HostTime at) {
  // A contact that does not move needs no recording and prints no message.
  const Database::Found found = level > 0
                                    ? find(c.material_a, c.material_b, interaction)
                                    : database_->find(material(c.material_a), material(c.material_b), interaction);
  const std::array<const Layers*, 3> all{found.pair, found.alone[0], found.alone[1]};
  const float each = found.alone[0] && found.alone[1] ? kHalfPower : 1;
  if (found.any()) recorded_.insert({c.contact_id, interaction});
  if (!(level > 0)) return;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i]) continue;
    RecordedContact r;
    r.contact = c.contact_id;
    r.part = static_cast<std::int32_t>(2 * static_cast<std::size_t>(interaction) + (i == 2));
    r.database = database_number_;
    r.at = at;
    r.update_interval_s = std::max(r.update_interval_s, period_s_);
    r.layers = all[i];
    r.speed_m_s = speed_m_s;
    r.level = each * gains_of(settings_).recorded *
              static_cast<float>(settings_.gain * settings_.recorded_level * level);
    r.place = place_of(listener_, 0.5 * (to_eigen(c.points[0].a_world_m) + to_eigen(c.points[0].b_world_m)),
                       settings_.nearest_m);
    contacts_.push_back(r);
  }
}

// Contacts beyond the number of audible loops are computed instead.
void Sampler::keep_loudest() {
  constexpr auto max_contacts = static_cast<std::ptrdiff_t>(Loops::kMax);
  if (static_cast<std::ptrdiff_t>(contacts_.size()) <= max_contacts) return;
  std::partial_sort(contacts_.begin(), contacts_.begin() + max_contacts, contacts_.end(),
                    [](const RecordedContact& a, const RecordedContact& b) { return a.level > b.level; });
  for (auto r = contacts_.begin() + max_contacts; r != contacts_.end(); ++r)
    recorded_.erase({r->contact, static_cast<Interaction>(r->part / 2)});
  contacts_.erase(contacts_.begin() + max_contacts, contacts_.end());
}

void Sampler::end_stopped_contacts(sync::HostTime at) {
  std::set<std::pair<std::int64_t, std::int32_t>> playing;
  for (const RecordedContact& r : contacts_) playing.insert({r.contact, r.part});
  std::vector<RecordedContact> ends;
  for (const auto& [contact, part] : playing_) {
    if (playing.contains({contact, part})) continue;
    RecordedContact& end = ends.emplace_back();
    end.contact = contact, end.part = part, end.database = database_number_, end.at = at, end.ends = true;
  }
  // First, to free places.
  contacts_.insert(contacts_.begin(), ends.begin(), ends.end());
  playing_ = std::move(playing);
}

const std::vector<RecordedContact>& Sampler::recorded_contacts(const sync::Contacts& contacts, sync::HostTime at) {
  contacts_.clear();
  recorded_.clear();
  const double dt_s = std::clamp(sync::to_seconds(at - updated_at_), 0.0, kMaxStep_s);
  updated_at_ = at;
  if (!enabled()) {
    motions_.clear();
    playing_.clear();
    return contacts_;
  }
  for (auto& [id, motion] : motions_) motion.present = false;
  const auto mu = [&](std::int32_t m) {
    return m >= 0 && static_cast<std::size_t>(m) < mu_.size() ? mu_[static_cast<std::size_t>(m)] : 1.0;
  };
  for (const contact_t& c : contacts) {
    if (c.points.empty() || !plausible(c)) continue;
    const double force_N = std::clamp<double>(static_cast<double>(c.normal_force_N), 0, kMaxRecordedForce_N);
    const Eigen::Vector3d sliding = to_eigen(c.sliding_velocity_m_s), rolling_velocity = to_eigen(c.rolling_velocity_m_s);
    const double slides = std::min(sliding.norm(), kMaxRecordedSpeed_m_s), rolls = std::min(rolling_velocity.norm(), kMaxRecordedSpeed_m_s);
    Motion& motion = motions_[c.contact_id];
    motion.present = true;
    motion.slides.step(sliding, dt_s), motion.rolls.step(rolling_velocity, dt_s);
    // Proportional to the root of the friction power (van den Doel, Kry and Pai 2001, section 4.2).
    const double friction = std::min(std::sqrt(mu(c.material_a) * mu(c.material_b)), kMaxFriction);
    const double power_W = friction * force_N * slides;
    const double scraping = slides >= kMinSpeed_m_s ? motion.slides.moving() : 0;
    add_contact(c, Interaction::kScrape, slides, scraping * settings_.recorded_scrape_level * std::sqrt(power_W), at);
    // The contact point of a sliding body moves too; this is not rolling.
    const double rolling = rolls >= kMinSpeed_m_s && rolls > slides ? motion.rolls.moving() : 0;
    add_contact(c, Interaction::kRoll, rolls, rolling * settings_.recorded_roll_level * std::sqrt(force_N * rolls), at);
  }
  std::erase_if(motions_, [](const auto& m) { return !m.second.present; });
  keep_loudest();
  end_stopped_contacts(at);
  return contacts_;
}

float Sampler::modal_gain(std::int64_t contact, Interaction interaction) const {
  return recorded_.contains({contact, interaction}) ? gains_of(settings_).modal : 1;
}

}  // namespace tactus::audio
