#include "scripts/simulated_player/observer_beliefs.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scripts/simulated_player/observer/cue_combination.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::simulated_player {
namespace {

using Eigen::Vector3d;

constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kGuessDistance_m = 0.2, kGuessSd_m = 0.12;  // of a ball that was never seen: in front of its hole (design)
constexpr double kJudgement_s = 0.02;   // of the time between action and effect (design, as in observer/pointing.cpp)
constexpr double kMatchWindow_s = 1, kMatchPeriod_s = 0.5, kLongestMatch_s = 1.2, kLeastMotion_m = 0.03;
constexpr double kTouchesAt_m = 0.002, kPushed_s = 0.05, kRollingShare = 5.0 / 7;  // a rolling sphere has 7/5 of its mass
constexpr double kLargestPush_m_s2 = 5, kRests_m_s = 0.06;
constexpr long kGlance = 6;             // every sixth picture also shows the balls beside the gaze (design)
constexpr double kSeenRecently_s = 0.2, kRollsUnseen_s = 0.5;
constexpr double kSoundOnset_s = 0.03, kBelievedEvent_s = 0.06;  // of the judged times of a sound and of a believed event
constexpr double kBinding_s = 3;        // an older event has no believed time
constexpr double kHoleSpread_deg = 20;  // of the directions of sounds (design)
constexpr double kDullIsFall = 0.9;     // as heard: De Pra, Fontana and Papetti 2020
constexpr double kLostSd_m = 0.08;
constexpr double kOnFloor = 0.1;        // a ball on the floor: the probability that it is in its hole is below this (design)
constexpr std::uint64_t kJudgementStream = 111;

Vector3d level(const Vector3d& v) { return {v.x(), v.y(), 0}; }

}  // namespace

ObserverBeliefs::ObserverBeliefs(const observer::PlayerParameters& player, const Rules& rules, const Viewer& viewer,
                                 VisibleArea visible_area, const Vector3d& hand_m, std::uint64_t seed)
    : player_(player),
      rules_(rules),
      viewer_(viewer),
      visible_area_(std::move(visible_area)),
      hand_(player, viewer.axes, hand_m),
      sight_delay_({player.visual_latency_s, player.initial_delay_error_s, player.adaptation_rate, player.motor_adaptation}),
      touch_delay_({player.touch_latency_s, 0, player.adaptation_rate, player.motor_adaptation}),
      sound_delay_({player.auditory_latency_s, player.initial_delay_error_s, player.adaptation_rate, player.perceptual_adaptation}),
      judgement_(seed, kJudgementStream),
      plant_(observer::hand_plant(player.mass_kg, player.muscle_s, kSampleStep_s)) {
  for (const Goal& goal : rules.goals) balls_.emplace_back(goal, viewer, goal.hole_m - Vector3d(kGuessDistance_m, 0, 0), kGuessSd_m);
  commanded_.row(observer::kPlace) = hand_m.transpose();
}

void ObserverBeliefs::practise(int pairs, double pictures_s, double sounds_s, double touch_s) {
  for (int i = 0; i < pairs; ++i) {
    sight_delay_.observe(player_.visual_latency_s + pictures_s + judgement_.normal(kJudgement_s), kJudgement_s);
    sound_delay_.observe(player_.auditory_latency_s + sounds_s + judgement_.normal(kJudgement_s), kJudgement_s);
    touch_delay_.observe(player_.touch_latency_s + touch_s + judgement_.normal(kJudgement_s), kJudgement_s);
  }
}

double ObserverBeliefs::push_height_m(int goal) const {
  return std::max(0.75 * rules_.goals[static_cast<std::size_t>(goal)].ball_radius_m, rules_.hand_radius_m + 0.004);
}

double ObserverBeliefs::contact_distance_m(int goal) const {
  const double radius = rules_.goals[static_cast<std::size_t>(goal)].ball_radius_m, sum = radius + rules_.hand_radius_m;
  const double up = radius - push_height_m(goal);
  return std::sqrt(std::max(0.0, sum * sum - up * up));
}

bool ObserverBeliefs::sees(int goal) const { return now_s_ - balls_[static_cast<std::size_t>(goal)].last_seen_s < kSeenRecently_s; }

void ObserverBeliefs::perceive(double now_s, ObserverSenses& senses, int goal, bool feels_ball) {
  now_s_ = now_s;
  while (const auto p = senses.body.take(now_s)) hand_.feel_place(player_.touch_latency_s, p->second.hand_m, p->second.sd_m);
  while (const auto p = senses.touch.take(now_s)) apply(p->second, p->first, goal, feels_ball);
  while (const auto p = senses.sight.take(now_s)) apply(p->second, p->first, goal);
  while (const auto p = senses.hearing.take(now_s)) apply(p->second, p->first, goal);
}

void ObserverBeliefs::apply(const SightPercept& sight, double arrival_s, int goal) {
  const double age_s = sight_delay_.believed_s();
  const bool glances = frames_++ % kGlance == 0;
  if (sight.hand_m) {
    const double blur_m = hand_.speed_m_s().norm() * sight_delay_.variability_s();
    hand_.see(age_s, *sight.hand_m, std::hypot(sight.hand_sd_m, blur_m), std::hypot(sight.hand_depth_sd_m, blur_m));
    shown_.push_back({arrival_s, *sight.hand_m, sight.hand_sd_m});
    while (arrival_s - shown_.front().time_s > kMatchWindow_s) shown_.pop_front();
    match_seen_hand(arrival_s);
  }
  if (!sight.picture) return;
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const bool gaze = static_cast<int>(i) == goal;
    if (!gaze && !glances) continue;
    if (sight.balls[i]) {
      apply_ball(*sight.balls[i], age_s, static_cast<int>(i));
      balls_[i].last_seen_s = arrival_s;
    } else {
      balls_[i].miss(age_s, (1 - player_.lapse) * observer::detection_probability(visible_area_(i, balls_[i].place_m()), 1));
    }
  }
}

// The line of sight meets the height at which a ball on the floor has its centre. The gap between ball and hand in the picture is
// finer than the direction of either: it locates the hand, whose place is less sure, beside the ball. So an error of the believed
// place of the hand does not become one of the ball, and both agree where they meet.
void ObserverBeliefs::apply_ball(const SightPercept::Ball& seen, double age_s, int goal) {
  const Goal& rules = rules_.goals[static_cast<std::size_t>(goal)];
  const double height_m = rules.hole_m.z() + rules.ball_radius_m;
  const SightLine line = viewer_.line_to(seen.point_m);
  const double sine = std::max(line.sine, 0.1), steep = line.cosine / sine;
  BelievedBall& ball = balls_[static_cast<std::size_t>(goal)];
  const double blur_m = ball.speed_m_s().norm() * sight_delay_.variability_s();
  const double down_m = seen.point_m.z() - height_m;
  const Vector3d at = seen.point_m + down_m * steep * line.away;
  ball.see(age_s, at, line.away, std::hypot(seen.sd_m / sine, blur_m), std::hypot(seen.sd_m, blur_m));
  if (!seen.gap_m || ball.in_hole() > kOnFloor) return;
  const Vector3d hand = hand_.place_before_m(age_s), sight = line.right.cross(line.up);
  Vector3d beside = ball.place_before_m(age_s) - seen.gap_m->x() * line.right - seen.gap_m->y() * line.up;
  beside += sight.dot(hand - beside) * sight;  // the picture does not show its depth
  hand_.see_across(age_s, beside, std::hypot(seen.gap_sd_m, ball.sd_m() * sine, blur_m));
}

void ObserverBeliefs::apply(const ForcePercept& touch, double arrival_s, int goal, bool feels_ball) {
  force_N_ = touch.force_N;
  hand_.feel_load(force_N_);
  if (force_N_.norm() < kHeldForce_N) last_free_s_ = arrival_s;
  const Vector3d force = level(force_N_);
  if (goal >= static_cast<int>(balls_.size()) || force.norm() < std::max(player_.force_floor_N, 0.3 * std::abs(force_N_.z()))) return;
  const bool begins = !feels_contact();
  contact_s_ = arrival_s;
  if (!feels_ball) return;
  // The believed begin of the contact and its felt begin are a pair, if they have one cause.
  const double late_s = arrival_s - touching_s_;
  if (begins && late_s < kLongestMatch_s &&
      observer::same_event_probability(player_, late_s - touch_delay_.believed_s(), kSoundOnset_s, kBelievedEvent_s) > 0.5)
    touch_delay_.observe(late_s, kBelievedEvent_s);
  const double age_s = touch_delay_.believed_s(), distance_m = contact_distance_m(goal);
  const Vector3d at = hand_.place_before_m(age_s) - distance_m * force.normalized();
  const double sd = distance_m * player_.force_direction_sd_deg * kDegree_rad * std::sqrt(kLookDuration_s / kSampleStep_s);
  const double blur_m = hand_.speed_m_s().norm() * touch_delay_.variability_s();
  ball(goal).locate(age_s, at, Vector3d::UnitX(), std::hypot(sd, blur_m), std::hypot(sd, blur_m));
}

void ObserverBeliefs::apply(const SoundPercept& sound, double arrival_s, int goal) {
  const double time_s = arrival_s - sound_delay_.believed_s();
  const double sd_deg = observer::azimuth_sd_deg(player_, sound.place.azimuth_deg);
  const auto azimuth_deg = [&](const Vector3d& at) {
    const Vector3d from = viewer_.axes.transpose() * (at - viewer_.eye_m);
    return std::atan2(-from.x(), from.z()) / kDegree_rad;
  };
  const auto common = [&](const Vector3d& centre, const Vector3d& other, double other_sd_m) {
    const double middle = azimuth_deg(centre), other_deg = other_sd_m / (other - viewer_.eye_m).norm() / kDegree_rad;
    return observer::infer_cause({sound.place.azimuth_deg - middle, sd_deg * sd_deg}, {azimuth_deg(other) - middle, other_deg * other_deg + 1},
                                 kHoleSpread_deg * kHoleSpread_deg, player_.common_cause)
        .common;
  };
  if (sound.dull) {
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      BelievedBall& ball = balls_[i];
      const bool timed = std::abs(time_s - ball.at_hole_s) < kBinding_s;
      const double in_time = timed ? observer::same_event_probability(player_, time_s - ball.at_hole_s, kSoundOnset_s, kBelievedEvent_s)
                                   : ball.at_hole_probability(0);
      ball.hear_fall(kDullIsFall * in_time * common(rules_.goals[i].hole_m, ball.place_m(), ball.sd_m()));
    }
    return;
  }
  // A lost ball: the direction and the distance of a sound that may be its own.
  if (goal >= static_cast<int>(balls_.size()) || ball(goal).sd_m() < kLostSd_m || sees(goal)) return;
  const double bound = common(ball(goal).place_m(), ball(goal).place_m(), ball(goal).sd_m());
  if (bound < 0.5) return;
  const double azimuth = sound.place.azimuth_deg * kDegree_rad;
  const Vector3d away = level(-std::sin(azimuth) * viewer_.axes.col(0) + std::cos(azimuth) * viewer_.axes.col(2)).normalized();
  const double distance_m = sound.place.distance_m, down_m = viewer_.eye_m.z() - ball(goal).place_m().z();
  const Vector3d at = level(viewer_.eye_m) + std::sqrt(std::max(0.0, distance_m * distance_m - down_m * down_m)) * away;
  ball(goal).locate(sound_delay_.believed_s(), at, away, distance_m * observer::weber_sd(player_.distance_weber),
                    distance_m * std::tan(sd_deg * kDegree_rad));
}

// The delay at which the seen path of the hand fits its commanded path best: one pair of action and effect for each movement.
void ObserverBeliefs::match_seen_hand(double arrival_s) {
  if (arrival_s < next_match_s_ || shown_.size() < 8 || arrival_s - shown_.front().time_s < 0.8 * kMatchWindow_s) return;
  next_match_s_ = arrival_s + kMatchPeriod_s;
  // Across the line of sight only: the seen depth is coarse.
  const auto across = [&](const Vector3d& v) { return (viewer_.axes.leftCols<2>().transpose() * v).eval(); };
  const double count = static_cast<double>(shown_.size());
  Eigen::Vector2d mean(0, 0);
  for (const TimedPlace& p : shown_) mean += across(p.at_m) / count;
  double motion = 0;  // beyond the noise of the eye in both directions
  for (const TimedPlace& p : shown_) motion += ((across(p.at_m) - mean).squaredNorm() - 2 * p.sd_m * p.sd_m) / count;
  if (motion < kLeastMotion_m * kLeastMotion_m) return;
  double best_s = -1, best = 1e9;
  for (double delay_s = 0; delay_s < kLongestMatch_s; delay_s += kSampleStep_s) {
    Eigen::Vector2d offset(0, 0);
    std::vector<Eigen::Vector2d> off;
    for (const TimedPlace& p : shown_) {
      const auto back = static_cast<long>(std::lround((meant_.back().time_s - (p.time_s - delay_s)) / kSampleStep_s));
      if (back < 0 || back >= static_cast<long>(meant_.size())) break;
      off.push_back(across(p.at_m - meant_[meant_.size() - 1 - static_cast<std::size_t>(back)].at_m));
      offset += off.back() / count;
    }
    if (off.size() < shown_.size()) continue;
    double misfit = 0;
    for (const Eigen::Vector2d& d : off) misfit += (d - offset).squaredNorm() / count;
    if (misfit < best) best = misfit, best_s = delay_s;
  }
  if (best_s < 0) return;
  // A place that is off by its noise shifts the fit by that over the speed.
  const double speed_m_s = std::sqrt(motion) / kMatchWindow_s * 2;
  const double sd_s = std::hypot(kJudgement_s, shown_.back().sd_m / std::sqrt(count) / speed_m_s);
  sight_delay_.observe(best_s + judgement_.normal(kJudgement_s), sd_s);
}

// A ball against the hand follows it; a free one rolls down the slope.
Vector3d ObserverBeliefs::expected_acceleration_m_s2(int goal) {
  BelievedBall& it = ball(goal);
  const Vector3d to_ball = level(it.place_m() - hand_.place_m());
  gap_m_ = to_ball.norm() - contact_distance_m(goal);
  Vector3d roll = kRollingShare * rules_.slope_m_s2;
  if (gap_m_ > kTouchesAt_m || to_ball.norm() < 1e-6 || hand_.place_m().z() > 2 * rules_.goals[static_cast<std::size_t>(goal)].ball_radius_m)
    return roll;
  const Vector3d n = to_ball.normalized();
  roll -= std::min(0.0, roll.dot(n)) * n;
  const double closing = (hand_.speed_m_s() - it.speed_m_s()).dot(n);
  return roll + std::clamp(closing / kPushed_s, 0.0, kLargestPush_m_s2) * n;
}

// Standard deviation of the push of a hand that may or may not touch the ball: the places of both are unsure, and so is the
// direction of the contact. Without it the player would trust its prediction more than its eyes after each push.
Vector3d ObserverBeliefs::possible_push_m_s2(int goal) {
  BelievedBall& it = ball(goal);
  const Vector3d to_ball = level(it.place_m() - hand_.place_m());
  const double distance_m = std::max(to_ball.norm(), 1e-6), contact_m = contact_distance_m(goal);
  const Vector3d n = to_ball / distance_m;
  const double unsure_m = std::hypot(std::sqrt(hand_.variance_m2(n)), it.sd_m());
  if (std::abs(distance_m - contact_m) > 2 * unsure_m || hand_.place_m().z() > 2 * rules_.goals[static_cast<std::size_t>(goal)].ball_radius_m)
    return Vector3d::Zero();
  const double push = std::min(level(hand_.speed_m_s() - it.speed_m_s()).norm() / kPushed_s, kLargestPush_m_s2), turn = std::min(1.0, unsure_m / contact_m);
  return push * Vector3d(std::hypot(n.x(), turn), std::hypot(n.y(), turn), 0);
}

void ObserverBeliefs::predict(double now_s, const Vector3d& command_N, int goal) {
  now_s_ = now_s;
  for (int i = 0; i < static_cast<int>(balls_.size()); ++i) {
    BelievedBall& it = ball(i);
    const double seen_ago_s = now_s - it.last_seen_s;
    // A ball that rests on a slope is held by something.
    const bool rolls = seen_ago_s < kRollsUnseen_s && it.speed_m_s().norm() > kRests_m_s;
    Vector3d acceleration = rolls ? Vector3d(kRollingShare * rules_.slope_m_s2) : Vector3d(Vector3d::Zero());
    Vector3d push = Vector3d::Zero();
    if (i == goal) {
      push = possible_push_m_s2(i);
      const double before_m = gap_m_;
      const Vector3d expected = expected_acceleration_m_s2(i);
      if (rolls || gap_m_ <= kTouchesAt_m) acceleration = expected;
      if (gap_m_ <= kTouchesAt_m && before_m > kTouchesAt_m) touching_s_ = now_s;
    }
    it.predict(acceleration, push);
    if (it.at_hole_probability(0) > 0.5) {
      if (now_s - it.at_hole_s > kBinding_s) it.at_hole_s = now_s;
    }
  }
  hand_.predict(command_N);
  // The hand by its commands alone. Its speed leaks to the believed one, so that noise does not add up.
  commanded_ = (plant_.a * commanded_ + plant_.b * command_N.transpose()).eval();
  commanded_.row(observer::kSpeed) += kSampleStep_s * (hand_.speed_m_s().transpose() - commanded_.row(observer::kSpeed));
  meant_.push_back({now_s + kSampleStep_s, commanded_.row(observer::kPlace).transpose(), 0});
  if (meant_.size() > static_cast<std::size_t>((kMatchWindow_s + kLongestMatch_s + 0.2) / kSampleStep_s)) meant_.pop_front();
}

}  // namespace tactus::simulated_player
