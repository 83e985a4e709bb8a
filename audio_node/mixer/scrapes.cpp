#include "audio_node/mixer/scrapes.h"

#include <algorithm>
#include <cmath>

namespace tactus::audio {
namespace {

// A received place differs from the extrapolated one: time constant of the correction. Design: touch and the
// simulation have ticks of 1 ms each and occasionally slip by one.
constexpr double kCorrection_s = 0.01;
// A larger difference means that it was repositioned.
constexpr double kMaxCorrection_m = 0.005;  // design
// Minimum ramp time of a strength at begin, change and end. Design: shorter is audible as a click.
constexpr double kMinRamp_s = 0.002;
// A contact without updates and without an end fades out.
constexpr sync::Nanoseconds kUpdateTimeout{30'000'000};  // design: a few lost messages are not a gap
constexpr double kMinInterval_s = 0.5e-3;              // design: half a step of the world's grid
constexpr double kMaxTimeout_s = 0.5;                 // design: or twice the update interval, but at most this

// Plausible range. Design: far beyond any scene, so that no number overflows.
constexpr double kMaxPlace_m = 1e7, kMaxSpeed_m_s = 1e3, kMaxMotion = 10, kMaxStrength = 10;

// False for NaN and infinity.
bool within(const Eigen::Vector3d& v, double max) { return v.allFinite() && v.cwiseAbs().maxCoeff() <= max; }

bool is_plausible(const Scrape& s) {
  bool all = std::abs(s.slide) <= kMaxStrength && std::abs(s.roll) <= kMaxStrength && std::isfinite(s.cutoff_Hz);
  for (const ScrapeSide& side : s.sides)
    all = all && within(side.place_m, kMaxPlace_m) && within(side.velocity_m_s, kMaxSpeed_m_s) &&
          within(side.slide_vector.cast<double>(), kMaxMotion) && within(side.roll_vector.cast<double>(), kMaxMotion) &&
          std::isfinite(side.residual_gain) && std::isfinite(side.residual_Hz) &&
          std::all_of(side.gains.begin(), side.gains.end(), [](float g) { return std::isfinite(g); });
  return all && std::isfinite(s.update_interval_s) && s.place.distance_m > 0;
}

// Slope limit for a step in a map: 76 degrees (design).
constexpr float kMaxSlope = 4;

bool moves_over(const ScrapeSide& side) { return !side.slide_vector.isZero(0) || !side.roll_vector.isZero(0); }

Eigen::Vector2d on_map(const ScrapeSide& side, const Eigen::Vector3d& v) {
  const Relief& r = side.relief->finest();
  return {v[side.axes.u] / static_cast<double>(r.size_m.x()), v[side.axes.v] / static_cast<double>(r.size_m.y())};
}

// Adds the slope of the relief along the directions of sliding and of rolling.
void add_relief(const ScrapeSide& side, const Track& track, int frames, float* slope, float* slope_rolling) {
  const auto along = [&](const Eigen::Vector3f& vector) -> Eigen::Vector2d {
    return vector.cast<double>()({side.axes.u, side.axes.v});
  };
  const Eigen::Vector2d slide_vector = along(side.slide_vector), roll_vector = along(side.roll_vector);
  const Eigen::Vector2d step =
      on_map(side, track.step).cwiseAbs().cwiseMax(on_map(side, track.step + 2 * frames * track.bend).cwiseAbs());
  for (int n = 0; n < frames; ++n) {
    const Eigen::Vector2d s = side.relief->slope(on_map(side, track.at(n)), step);
    slope[n] += static_cast<float>(s.dot(slide_vector));
    slope_rolling[n] += static_cast<float>(s.dot(roll_vector));
  }
}

}  // namespace

float Scrapes::Ramp::next() {
  if (left <= 0) return value;
  value = left == 1 ? target : value + (target - value) / static_cast<float>(left);
  --left;
  return value;
}

int Scrapes::frames_of(double interval_s) const { return std::max(1, static_cast<int>(std::lround(interval_s * rate_Hz_))); }

void Scrapes::begin(Contact& c, const Scrape& scrape) const {
  c.now = scrape;
  c.on = c.fresh = true;
  c.ended = false;
  c.slide = c.roll = {};
  c.patch = {};
  c.force.fill(0);
  for (std::size_t i = 0; i < 2; ++i) {
    c.sides[i].place_m = scrape.sides[i].place_m;
    c.sides[i].in_use = 0;
    c.sides[i].gains[0] = scrape.sides[i].gains;
    c.sides[i].changed = false;
    c.sides[i].residual = {};
    c.sides[i].residual.set(scrape.sides[i].residual_Hz, rate_Hz_);
  }
}

void Scrapes::update(const Scrape& scrape) {
  if (!is_plausible(scrape)) return;
  const bool silent = scrape.slide == 0 && scrape.roll == 0;
  Contact* known = nullptr;
  Contact* free = nullptr;
  for (Contact& c : contacts_) {
    if (c.on && c.now.id == scrape.id) known = &c;
    if (!c.on && !free) free = &c;
  }
  const int within = frames_of(std::max(kMinRamp_s, scrape.update_interval_s));
  if (scrape.ends) {
    if (known) known->slide.set_target(0, within), known->roll.set_target(0, within);
    return;
  }
  if (known) {
    for (std::size_t i = 0; i < 2; ++i)
      known->sides[i].changed |= known->now.sides[i].gains != scrape.sides[i].gains;
    known->now = scrape;
    known->ended = false;
  } else if (free && !silent) {
    begin(*(known = free), scrape);
  } else {
    return;
  }
  known->updated_at = scrape.at;
  known->updated = true;
  known->slide.set_target(scrape.slide, within), known->roll.set_target(scrape.roll, within);
}

// Extrapolates the received place to the next sample. The difference is corrected until the next scrape, by the share of the time
// constant.
void Scrapes::aim(const ScrapeSide& received, Side& side, double since_s, double interval_s, bool fresh) const {
  Eigen::Vector3d lag = received.place_m + since_s * received.velocity_m_s - side.place_m;
  if (fresh || lag.norm() > kMaxCorrection_m) side.place_m += lag, lag.setZero();
  const double share = -std::expm1(-interval_s / kCorrection_s);
  side.target_step_m = (received.velocity_m_s + lag * (share / interval_s)) / rate_Hz_;
  if (fresh) side.step_m = side.target_step_m;
  side.to_target = frames_of(interval_s);
}

// The track of the next samples. Without a new scrape in time, the contact continues with its velocity.
Track Scrapes::follow(const ScrapeSide& received, Side& side, int frames, int interval) const {
  if (side.to_target <= 0) side.target_step_m = received.velocity_m_s / rate_Hz_, side.to_target = interval;
  const Track track{side.place_m, side.step_m, (side.target_step_m - side.step_m) / (2 * std::max(side.to_target, frames))};
  side.place_m = track.at(frames);
  side.step_m += 2 * frames * track.bend;
  side.to_target -= frames;
  return track;
}

void Scrapes::render(Contact& c, int offset, int frames, sync::HostTime first) const {
  const Scrape& s = c.now;
  if (first - c.updated_at >= std::max(kUpdateTimeout, sync::from_seconds(std::min(2 * s.update_interval_s, kMaxTimeout_s))) &&
      (c.slide.target != 0 || c.roll.target != 0))
    c.slide.set_target(0, static_cast<int>(kMinRamp_s * rate_Hz_)),
        c.roll.set_target(0, static_cast<int>(kMinRamp_s * rate_Hz_));
  const double since_s = sync::to_seconds(first - s.at), interval_s = std::clamp(s.update_interval_s, kMinInterval_s, kMaxTimeout_s);
  Block slope{}, rolling{}, friction, steep;
  friction.fill(1);
  std::array<Track, 2> tracks;
  for (std::size_t i = 0; i < 2; ++i) {
    const ScrapeSide& side = s.sides[i];
    if (!side.known) continue;
    if (c.updated) aim(side, c.sides[i], since_s, interval_s, c.fresh);
    tracks[i] = follow(side, c.sides[i], frames, frames_of(interval_s));
    if (side.relief && moves_over(side)) add_relief(side, tracks[i], frames, slope.data(), rolling.data());
    for (int n = 0; side.friction && n < frames; ++n)
      friction[static_cast<std::size_t>(n)] *=
          static_cast<float>(side.friction->factor(side.outward, tracks[i].at(n)));
  }
  // On a slope both the path and the force across it are longer by sqrt(1 + slope^2), and so is the root of their
  // product.
  for (int n = 0; n < frames; ++n) {
    const auto k = static_cast<std::size_t>(n);
    steep[k] = std::sqrt(1 + std::min(slope[k] * slope[k], kMaxSlope * kMaxSlope));
  }
  for (std::size_t i = 0; i < 2; ++i)
    if (const ScrapeSide& side = s.sides[i]; side.known && moves_over(side))
      add_slopes(side.roughness, tracks[i], side.slide_vector, side.roll_vector, frames, slope.data(), rolling.data());
  const bool mapped = s.sides[0].friction || s.sides[1].friction;
  c.patch.set(s.cutoff_Hz, rate_Hz_);
  for (int n = 0; n < frames; ++n) {
    const auto k = static_cast<std::size_t>(n);
    // The factor of a pair is the root of the product, and the strength is proportional to the root of the power.
    const float friction_gain = mapped ? std::sqrt(static_cast<float>(pair_factor(static_cast<double>(friction[k])))) : 1;
    c.force[static_cast<std::size_t>(offset + n)] = c.slide.next() * friction_gain * steep[k] * slope[k] + c.roll.next() * c.patch.next(rolling[k]).low;
  }
  c.fresh = c.updated = false;
  c.ended = c.slide.value == 0 && c.roll.value == 0 && c.slide.target == 0 && c.roll.target == 0;
}

void Scrapes::drive(Contact& c, std::size_t i, Voices& voices, int frames) {
  const ScrapeSide& received = c.now.sides[i];
  Side& side = c.sides[i];
  for (int n = 0; n < frames; ++n) {
    const auto k = static_cast<std::size_t>(n);
    side.direct[k] = received.residual_gain * side.residual.next(c.force[k]).high;
  }
  const auto with = [&](const PerMode& gains, const Block& force, const float* direct) {
    voices.drive({received.voice, &received.resonators, &gains, c.now.place, force.data(), direct});
  };
  if (!side.changed) return with(side.gains[side.in_use], c.force, side.direct.data());
  // Crossfades linearly between the sets of gains. Both bodies use the same shares.
  for (int n = 0; n < frames; ++n) {
    const auto k = static_cast<std::size_t>(n);
    c.in[k] = c.force[k] * static_cast<float>(n) / static_cast<float>(frames);
    c.out[k] = c.force[k] - c.in[k];
  }
  with(side.gains[side.in_use], c.out, side.direct.data());
  side.in_use = 1 - side.in_use;
  side.gains[side.in_use] = received.gains;
  with(side.gains[side.in_use], c.in, nullptr);
  side.changed = false;
}

void Scrapes::render(int offset, int frames, sync::HostTime first) {
  for (Contact& c : contacts_) {
    if (offset == 0) c.force.fill(0);
    if (c.on && !c.ended) render(c, offset, frames, first);
  }
}

void Scrapes::drive(Voices& voices, int frames) {
  for (Contact& c : contacts_) {
    if (!c.on) continue;
    c.on = !c.ended;
    const auto silent = [](float x) { return x == 0; };
    if (std::all_of(c.force.begin(), c.force.begin() + frames, silent)) continue;
    for (std::size_t i = 0; i < 2; ++i) drive(c, i, voices, frames);
  }
}

std::optional<std::int64_t> Scrapes::oldest() const {
  std::optional<std::int64_t> oldest;
  for (const Contact& c : contacts_)
    if (c.on && (!oldest || c.now.number < *oldest)) oldest = c.now.number;
  return oldest;
}

int Scrapes::active() const {
  return static_cast<int>(
      std::count_if(contacts_.begin(), contacts_.end(), [](const Contact& c) { return c.on; }));
}

const float* Scrapes::force(std::int64_t id) const {
  for (const Contact& c : contacts_)
    if (c.now.id == id) return c.force.data();
  return nullptr;
}

}  // namespace tactus::audio
