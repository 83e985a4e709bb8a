#include "scripts/simulated_player/observer_senses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "scripts/simulated_player/observer/vision.h"
#include "sync/random/keyed_random.h"

namespace tactus::simulated_player {
namespace {

using Eigen::Vector3d;
using observer::NoiseStream;

constexpr std::uint64_t kSightStream = 101, kHearingNoiseStream = 102, kTouchStream = 103, kBodyStream = 104, kBiasStream = 105;
// Correlation time of the noise of a felt force: its mean over a duration T has the standard deviation of independent looks,
// sqrt(2 tau / T) = sqrt(look / T).
constexpr double kTouchCorrelation_s = kLookDuration_s / 2;
constexpr double kPictureContrast = 0.5;  // of a ball against its floor (design; the renderers report no contrast)
// Share of the impact sounds whose material is identified: De Pra, Fontana and Papetti 2020, ACM TAP 17, "Does it ping or pong?"
// (read in the abstract).
constexpr double kMaterialHeard = 0.9;
constexpr double kGapRange_m = 0.15;  // a larger gap is judged by two directions (design)

std::uint64_t in_ms(double time_s) { return static_cast<std::uint64_t>(std::llround(std::max(0.0, time_s) * 1e3)); }

}  // namespace

ObserverSenses::ObserverSenses(const observer::PlayerParameters& player, const Rules& rules, const Viewer& viewer, std::uint64_t seed)
    : player_(player), rules_(rules), viewer_(viewer), seed_(seed), touch_noise_(seed, kTouchStream), body_noise_(seed, kBodyStream) {
  NoiseStream noise(seed, kBiasStream);
  for (int i = 0; i < 3; ++i) bias_m_[i] = noise.normal();
  bias_m_ *= player.proprioceptive_bias_m / std::max(bias_m_.norm(), 1e-9);
}

std::optional<SightPercept::Ball> ObserverSenses::look_at(const Picture& picture, std::size_t ball, const Vector3d& gaze_m,
                                                          NoiseStream& noise) const {
  const double across[]{noise.normal(), noise.normal()}, gap[]{noise.normal(), noise.normal()}, notice = noise.uniform();
  if (!picture.balls[ball]) return std::nullopt;
  const Picture::Ball& shown = *picture.balls[ball];
  if (notice >= observer::detection_probability(shown.visible_px, kPictureContrast)) return std::nullopt;
  const SightLine line = viewer_.line_to(shown.at_m);
  const double looks = std::sqrt(std::max(1.0, kLookDuration_s / picture.interval_s));
  const double off_gaze_m = (shown.at_m - gaze_m).cross((shown.at_m - viewer_.eye_m).normalized()).norm();
  SightPercept::Ball seen;
  seen.sd_m = looks * observer::seen_sd_m(player_, line.distance_m, off_gaze_m);
  seen.point_m = shown.at_m + seen.sd_m * (across[0] * line.right + across[1] * line.up);
  if (!picture.hand_m) return seen;
  const Vector3d between = shown.at_m - *picture.hand_m;
  if (between.norm() > kGapRange_m) return seen;
  seen.gap_sd_m = looks * observer::seen_gap_sd_m(player_, line.distance_m, between.norm());
  seen.gap_m = Eigen::Vector2d(between.dot(line.right) + seen.gap_sd_m * gap[0], between.dot(line.up) + seen.gap_sd_m * gap[1]);
  return seen;
}

void ObserverSenses::show(const Picture& picture, const Vector3d& gaze_m) {
  const std::uint64_t frame = sync::mixed(kSightStream, in_ms(picture.shown_s));
  NoiseStream noise(seed_, frame);
  const double off[]{noise.normal(), noise.normal(), noise.normal()};
  if (noise.uniform() < player_.lapse) return;
  SightPercept percept;
  for (std::size_t i = 0; i < picture.balls.size(); ++i) {
    NoiseStream own(sync::mixed(seed_, frame), i);
    percept.picture = percept.picture || picture.balls[i].has_value();
    percept.balls.push_back(look_at(picture, i, gaze_m, own));
  }
  if (picture.hand_m) {
    const double looks = std::sqrt(std::max(1.0, kLookDuration_s / picture.interval_s));
    const double distance_m = (*picture.hand_m - viewer_.eye_m).norm();
    percept.hand_sd_m = looks * observer::seen_sd_m(player_, distance_m, (*picture.hand_m - gaze_m).norm());
    percept.hand_depth_sd_m = looks * observer::seen_depth_sd_m(false);  // a monitor: one view for both eyes
    percept.hand_m = *picture.hand_m + viewer_.axes * Vector3d(percept.hand_sd_m * off[0], percept.hand_sd_m * off[1], percept.hand_depth_sd_m * off[2]);
  }
  sight.push(picture.shown_s + player_.visual_latency_s, std::move(percept));
}

void ObserverSenses::play(const Sound& sound) {
  NoiseStream noise(seed_, sync::mixed(kHearingNoiseStream, sound.event));
  const Vector3d from = viewer_.axes.transpose() * (sound.from_m - viewer_.eye_m);  // right, up, forward
  const double level_m = std::hypot(from.x(), from.z());
  observer::SourcePlace source;
  source.azimuth_deg = std::atan2(-from.x(), from.z()) * 180 / std::numbers::pi;
  source.elevation_deg = std::atan2(from.y(), level_m) * 180 / std::numbers::pi;
  source.distance_m = from.norm();
  SoundPercept percept{observer::heard_place(player_, source, noise), sound.dull};
  if (noise.uniform() > kMaterialHeard) percept.dull = !percept.dull;
  if (noise.uniform() >= player_.lapse) hearing.push(sound.at_s + player_.auditory_latency_s, percept);
}

void ObserverSenses::press(double at_s, const Vector3d& force_N) {
  const double keeps = std::exp(-kSampleStep_s / kTouchCorrelation_s);
  for (int i = 0; i < 3; ++i) touch_state_[i] = keeps * touch_state_[i] + std::sqrt(1 - keeps * keeps) * touch_noise_.normal();
  const double size = force_N.norm();
  ForcePercept percept;
  if (size >= player_.force_floor_N) {
    const double turn_sd = player_.force_direction_sd_deg * std::numbers::pi / 180 / std::numbers::sqrt2;
    const Vector3d direction = force_N / size, one = direction.unitOrthogonal(), other = direction.cross(one);
    const Vector3d turn = turn_sd * (touch_state_[1] * one + touch_state_[2] * other);
    const Vector3d felt = Eigen::AngleAxisd(turn.norm(), turn.norm() > 0 ? Vector3d(turn.normalized()) : one) * direction;
    percept.force_N = std::max(0.0, size * (1 + observer::weber_sd(player_.force_weber) * touch_state_[0])) * felt;
  }
  touch.push(at_s + player_.touch_latency_s, percept);
}

void ObserverSenses::place_hand(double at_s, const Vector3d& hand_m) {
  PlacePercept percept{hand_m + bias_m_, player_.proprioceptive_sd_m * std::sqrt(kLookDuration_s / kSampleStep_s)};
  for (int i = 0; i < 3; ++i) percept.hand_m[i] += body_noise_.normal(percept.sd_m);
  body.push(at_s + player_.touch_latency_s, percept);
}

}  // namespace tactus::simulated_player
