#include "scripts/simulated_player/observer/pointing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scripts/simulated_player/observer/delayed_kalman.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::observer {
namespace {

constexpr double kStep_s = 0.005;
constexpr int kFrameSteps = 3;  // a picture every 15 ms
constexpr int kTouchSteps = 2;  // proprioception every 10 ms
// The standard deviations of the population hold for a look of this duration (design: one fixation of a pursuit).
constexpr double kLook_s = 0.1;
constexpr double kViewing_m = 0.6;
// Standard deviation of the judged time between an action and its seen effect (design, from 20-60 ms for judged
// order).
constexpr double kJudgedDelaySd_s = 0.02;
// Time constant of the approach as a share of that of the pace: the last corrections take the rest, so that the
// slope of time over difficulty is the pace of the typical player (design).
constexpr double kApproach = 0.75;
constexpr double kErrorCost_s = 2.5;    // time that the typical player gives to avoid an error (design)
// Growth of the approach's time constant for each second of noticed mismatch: between e, which damps a loop with
// that delay critically, and 1 + e, which also makes up for the faster approach that the mismatch causes (design).
constexpr double kSlowing = 3.4;
constexpr double kRestSpeed_m_s = 0.01;  // a movement has ended below this speed
constexpr std::uint64_t kExposureStream = 31, kTrialStream = 32;
constexpr int kBias = kHandStates;  // the state after those of the hand

HandModel believed_model(const PlayerParameters& player, const Hand& hand) {
  HandModel model;
  model.dt_s = kStep_s;
  model.a = Matrix::Identity(kHandStates + 1, kHandStates + 1);
  model.a.topLeftCorner(kHandStates, kHandStates) = hand.plant().a;
  model.b = Vector::Zero(kHandStates + 1);
  model.b.head(kHandStates) = hand.plant().b;
  model.noise = Matrix::Identity(kHandStates + 1, kHandStates + 1) * 1e-14;
  model.control_share = hand.share();
  model.control_sd = hand.constant_N();
  model.speed_noise_m2_s = player.process_noise_m2_s;
  return model;
}

double tail(double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); }

// Variance of the place at which the button goes down, one muscle time after the decision.
double pressed_variance_m2(const PlayerParameters& player, const Matrix& covariance) {
  const double press_s = player.muscle_s;
  return covariance(kPlace, kPlace) + 2 * press_s * covariance(kPlace, kSpeed) +
         press_s * press_s * covariance(kSpeed, kSpeed);
}

// Standard deviation of one picture of a gap, and of one percept of the body.
double picture_sd_m(const PlayerParameters& player, double gap_m) {
  return seen_gap_sd_m(player, kViewing_m, gap_m) * std::sqrt(kLook_s / (kFrameSteps * kStep_s));
}
double body_sd_m(const PlayerParameters& player) {
  return player.proprioceptive_sd_m * std::sqrt(kLook_s / (kTouchSteps * kStep_s));
}

}  // namespace

double error_cost_s(const PlayerParameters& player) { return kErrorCost_s * player.caution; }

double miss_probability(double place_m, double sd_m, double width_m) {
  return tail((width_m / 2 - place_m) / sd_m) + tail((width_m / 2 + place_m) / sd_m);
}

double settled_sd_m(const PlayerParameters& player, double believed_age_s) {
  constexpr double kRest_s = 1.5;  // several times the largest age, until the covariance is constant
  Matrix start = Matrix::Identity(kHandStates + 1, kHandStates + 1) * 1e-8;
  start(kBias, kBias) = player.proprioceptive_bias_m * player.proprioceptive_bias_m;
  DelayedKalman estimate(believed_model(player, Hand(player, kStep_s, 0)), Vector::Zero(kHandStates + 1), start);
  Vector seen = Vector::Zero(kHandStates + 1), felt = seen;
  seen[kPlace] = felt[kPlace] = felt[kBias] = 1;
  const double seen_m = picture_sd_m(player, 0), felt_m = body_sd_m(player);
  for (int i = 0; i < kRest_s / kStep_s; ++i) {
    if (i % kFrameSteps == 0) estimate.measure(believed_age_s, seen, 0, seen_m * seen_m);
    if (i % kTouchSteps == 0) estimate.measure(player.touch_latency_s, felt, 0, felt_m * felt_m);
    estimate.predict(0);
  }
  return std::sqrt(std::max(pressed_variance_m2(player, estimate.covariance()), 1e-12));
}

double target_width_m(double distance_m, double difficulty_bit) {
  return distance_m / (std::exp2(difficulty_bit) - 1);
}

PointingSession::PointingSession(const PlayerParameters& player, const PointingDef& def, std::uint64_t seed)
    : player_(player),
      def_(def),
      seed_(seed),
      belief_({player.visual_latency_s, player.initial_delay_error_s, player.adaptation_rate,
               player.motor_adaptation}) {
  NoiseStream noise(seed, kExposureStream);
  for (int i = 0; i < def.exposure && def.vision; ++i) {
    const double jitter = def.jitter_s * (2 * noise.uniform() - 1), judgement = noise.normal(kJudgedDelaySd_s);
    belief_.observe(player.visual_latency_s + def.delay_s + jitter + judgement, kJudgedDelaySd_s);
  }
  const double believed = def.reckoning ? belief_.believed_s() : 0;
  const double unknown =
      def.reckoning ? std::abs(belief_.noticed_s()) : belief_.believed_s() + belief_.noticed_s();
  waits_ = def.vision && believed > player.wait_threshold_s;
  const double preferred_s = kApproach * player.pace_s_bit / std::numbers::ln2;
  rate_1_s_ = 1 / (preferred_s + (waits_ ? 0 : kSlowing * unknown));
  feedback_ = approach_feedback(player, rate_1_s_, kStep_s);
  settled_m_ = settled_sd_m(player, believed);
}

// One movement.
class PointingMovement {
 public:
  PointingMovement(const PointingSession& session, double width_m, std::uint64_t index)
      : s_(session),
        width_m_(width_m),
        seed_(sync::mixed(sync::mixed(session.seed_, kTrialStream), index)),
        motor_(seed_, 1),
        eyes_noise_(seed_, 2),
        body_noise_(seed_, 3),
        rest_noise_(seed_, 4),
        hand_(session.player_, kStep_s, -session.def_.distance_m),
        bias_m_(NoiseStream(session.seed_, 33).uniform() < 0.5 ? -session.player_.proprioceptive_bias_m
                                                               : session.player_.proprioceptive_bias_m),
        eyes_(session.player_.visual_latency_s),
        body_(session.player_.touch_latency_s),
        estimate_(believed_model(session.player_, hand_), start_mean(), start_covariance()) {
    closed_ = hand_.plant().a - hand_.plant().b * session.feedback_.transpose();
    later_ = Matrix::Identity(kHandStates, kHandStates);
    for (int i = 0; i < std::lround(kConsidered_s / kStep_s); ++i) later_ = (closed_ * later_).eval();
    press_ = Matrix::Identity(kHandStates, kHandStates);
    for (int i = 0; i < press_steps(); ++i) press_ = (closed_ * press_).eval();
  }

  PointingTrial run() {
    // The hand rested before: pictures of that time arrive during the movement.
    const double oldest_s = std::isfinite(s_.def_.delay_s) ? s_.def_.delay_s + s_.player_.visual_latency_s : 0;
    for (int i = -static_cast<int>(oldest_s / kStep_s); i < 0; ++i) show(i, rest_noise_);
    const int limit = static_cast<int>(s_.def_.limit_s / kStep_s);
    int selected = -1;
    for (int i = 0; i < limit; ++i) {
      now_s_ = i * kStep_s;
      show(i, eyes_noise_);
      feel(i);
      sense();
      if (selected < 0 && selects()) selected = i;
      if (selected >= 0 && i >= selected + press_steps())
        return {now_s_, true, std::abs(hand_.state()[kPlace]) <= width_m_ / 2};
      const double u = command();
      hand_.step(u, 0, motor_);
      estimate_.predict(u);
    }
    return {s_.def_.limit_s, false, false};
  }

 private:
  int press_steps() const { return static_cast<int>(std::lround(s_.player_.muscle_s / kStep_s)); }

  Vector start_mean() const {
    Vector mean = Vector::Zero(kHandStates + 1);
    mean[kPlace] = -s_.def_.distance_m;
    return mean;
  }

  Matrix start_covariance() const {
    Matrix covariance = Matrix::Identity(kHandStates + 1, kHandStates + 1) * 1e-10;
    const double seen_m = seen_gap_sd_m(s_.player_, kViewing_m, s_.def_.distance_m);
    covariance(kPlace, kPlace) = seen_m * seen_m;
    covariance(kBias, kBias) = s_.player_.proprioceptive_bias_m * s_.player_.proprioceptive_bias_m;
    return covariance;
  }

  // The display presents the place of the hand.
  void show(int step, NoiseStream& noise) {
    if (step % kFrameSteps != 0) return;
    const double place_m = hand_.state()[kPlace];
    const double sd = picture_sd_m(s_.player_, std::abs(place_m));
    const double off = noise.normal(sd), jitter = s_.def_.jitter_s * (2 * noise.uniform() - 1);
    const bool attended = noise.uniform() >= s_.player_.lapse;
    if (attended && s_.def_.vision)
      eyes_.present(step * kStep_s + s_.def_.delay_s + jitter, Eigen::Vector3d(place_m + off, 0, 0), sd);
  }

  // The body senses the place of the hand.
  void feel(int step) {
    if (step % kTouchSteps != 0) return;
    const double sd = body_sd_m(s_.player_);
    body_.present(step * kStep_s, Eigen::Vector3d(hand_.state()[kPlace] + bias_m_ + body_noise_.normal(sd), 0, 0),
                  sd);
  }

  void sense() {
    Vector seen = Vector::Zero(kHandStates + 1), felt = seen;
    seen[kPlace] = felt[kPlace] = felt[kBias] = 1;
    while (const auto p = body_.take(now_s_))
      estimate_.measure(s_.player_.touch_latency_s, felt, p->value.x(), p->sd * p->sd);
    const double believed = s_.def_.reckoning ? s_.belief_.believed_s() : 0;
    while (const auto p = eyes_.take(now_s_)) {
      if (s_.waits_ && !picture_is_settled()) continue;
      const double age = s_.waits_ ? 0 : believed;
      // Jitter is noise in proportion to the speed. A constant mismatch is not: the estimate is wrong by it.
      const double blur = s_.waits_ ? 0 : estimate_.mean_before(age)[kSpeed] * s_.belief_.variability_s();
      estimate_.measure(age, seen, p->value.x(), p->sd * p->sd + blur * blur);
    }
  }

  // Move and wait: the picture shows the hand at rest when the whole observed delay has passed since the end of
  // the movement.
  bool picture_is_settled() const {
    return rest_s_ >= 0 && now_s_ - rest_s_ > s_.belief_.believed_s() + s_.belief_.noticed_s();
  }

  double command() {
    const Vector x = estimate_.mean().head(kHandStates);
    if (!s_.waits_) return -s_.feedback_.dot(x);
    if (rest_s_ >= 0 && now_s_ - rest_s_ > s_.belief_.believed_s() + s_.belief_.noticed_s() + kLook_s)
      rest_s_ = -1;  // the next movement
    else if (rest_s_ < 0 && std::abs(x[kSpeed]) < kRestSpeed_m_s &&
             std::abs(x[kPlace]) < std::max(width_m_ / 4, 0.001))
      rest_s_ = now_s_;
    Vector held = x;
    if (rest_s_ >= 0) held[kPlace] = 0;  // stays where it is
    return -s_.feedback_.dot(held);
  }

  bool selects() {
    const Vector x = estimate_.mean().head(kHandStates);
    if (s_.waits_ && !(picture_is_settled() &&
                       now_s_ - rest_s_ > s_.belief_.believed_s() + s_.belief_.noticed_s() + kLook_s / 2))
      return false;
    const Vector pressed = press_ * x;
    const double variance = pressed_variance_m2(s_.player_, estimate_.covariance());
    // The noticed mismatch of the delay makes a moving hand uncertain.
    const double mismatch = x[kSpeed] * s_.belief_.noticed_s();
    const double sd = std::sqrt(std::max(variance, 1e-12) + mismatch * mismatch);
    const double now = miss_probability(pressed[kPlace], sd, width_m_),
                 then = miss_probability(Vector(later_ * pressed)[kPlace], sd, width_m_);
    // Half of the certainty of a hand at rest suffices: a hand whose noise exceeds the target never has more.
    const double attainable = 1 - miss_probability(0, s_.settled_m_, width_m_);
    return std::abs(pressed[kPlace]) <= width_m_ / 2 && 1 - now > attainable / 2 &&
           error_cost_s(s_.player_) * (now - then) <= kConsidered_s;
  }

  const PointingSession& s_;
  double width_m_;
  std::uint64_t seed_;
  NoiseStream motor_, eyes_noise_, body_noise_, rest_noise_;
  Hand hand_;
  double bias_m_;
  PerceptChannel eyes_, body_;
  DelayedKalman estimate_;
  Matrix closed_, press_, later_;
  double now_s_ = 0, rest_s_ = -1;
};

PointingTrial PointingSession::trial(double width_m, std::uint64_t index) {
  return PointingMovement(*this, width_m, index).run();
}

}  // namespace tactus::observer
