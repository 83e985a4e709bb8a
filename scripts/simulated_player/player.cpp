#include "scripts/simulated_player/player.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::simulated_player {
namespace {

using Eigen::Vector3d;

// All values are design choices.
constexpr double kArrived_m = 0.006;        // near enough to a place
constexpr double kBallMoved_m = 0.03;       // a ball that has moved this far is approached again
constexpr double kFallen_m = -0.01;         // a ball with its centre below this is in a hole
constexpr double kFallHeardValid_s = 1.0;   // a heard fall overrides sight for this time
constexpr double kLost_s = 0.6;             // after pushing for this time without sight or touch, the ball is lost
constexpr double kStuck_s = 1.5;            // an object that does not move for this time is not a ball
constexpr double kSearchPitch_m = 0.025;    // a search widens by this each revolution
constexpr double kMaxSearchRadius_m = 0.2;  // then it restarts
constexpr double kSteer_1_s = 6;            // rate of the sideways movement behind a ball
constexpr double kSeenSpeed_s = 0.05;       // averaging time of the seen speed
constexpr double kFeltSpeed_s = 0.06;       // averaging time of the felt speed
constexpr double kFeltPlace_s = 0.03;       // averaging time of the felt place on the hand
constexpr double kSightWeight = 0.5;        // weight of sight against touch, for the place of a ball on the hand
constexpr double kDamping_1_s = 1.5;        // rate at which the sideways speed of a ball is braked
// Rate at which the hand moves to the balance point: slower than the steering, because sight is late.
constexpr double kBalance_1_s = 4;
constexpr double kMaxPrediction_m = 0.05;  // limit of the prediction
// Limit of the ball's sideways offset on the hand, as a share of their distance.
constexpr double kMaxOffsetShare = 0.5;
constexpr double kHeldForce_N = 4;  // objects that can be pushed do not resist this long
constexpr double kYieldDistance_m = 0.05;
constexpr double kMinSlope_m_s2 = 0.05;  // on a smaller slope the ball needs no balance
// Distance of a ball that was never seen in front of its hole, as given before the game.
constexpr double kFirstGuess_m = 0.2;

Vector3d flat(const Vector3d& v) { return {v.x(), v.y(), 0}; }

}  // namespace

Player::Player(Rules rules, const PlayerDef& def)
    : rules_(std::move(rules)), def_(def), beliefs_(rules_.goals.size()) {
  for (std::size_t i = 0; i < beliefs_.size(); ++i)
    beliefs_[i].at_m = rules_.goals[i].hole_m - Vector3d(kFirstGuess_m, 0, 0);
}

double Player::push_height_m() const { return std::max(0.75 * target().ball_radius_m, rules_.hand_radius_m + 0.004); }

// The hand touches a ball below its middle, so its centre is nearer than the sum of the radii.
double Player::contact_distance_m() const {
  const double sum = target().ball_radius_m + rules_.hand_radius_m, up = target().ball_radius_m - push_height_m();
  return std::sqrt(std::max(0.0, sum * sum - up * up));
}

Vector3d Player::direction_to_hole() {
  const Vector3d d = flat(target().hole_m - ball().at_m);
  return d.norm() > 1e-3 ? d.normalized() : Vector3d(1, 0, 0);
}

Vector3d Player::predicted_ball_m() {
  const Vector3d ahead = sees_ball() ? Vector3d(def_.sight_delay_s * ball().speed_m_s) : Vector3d(Vector3d::Zero());
  return ball().at_m + std::min(1.0, kMaxPrediction_m / std::max(ahead.norm(), 1e-9)) * ahead;
}

bool Player::ball_rolls() { return sees_ball() && ball().speed_m_s.norm() > def_.slow_ball_m_s; }

Vector3d Player::position_behind(double gap_m) {
  Vector3d at = predicted_ball_m() - (contact_distance_m() + gap_m) * direction_to_hole();
  at.z() = push_height_m();
  return at;
}

Vector3d Player::step_towards(const Vector3d& to, double speed_m_s) const {
  const Vector3d d = to - target_m_;
  const double max_m = speed_m_s * dt_s_;
  return d.norm() <= max_m ? to : Vector3d(target_m_ + max_m * d.normalized());
}

void Player::start(Action action) {
  action_ = action;
  action_start_s_ = now_s_;
  action_start_m_ = target_m_;
}

Vector3d Player::step(const Percept& p) {
  if (!std::exchange(started_, true)) {
    last_free_s_ = p.time_s;
    now_s_ = p.time_s;
    target_m_ = action_start_m_ = p.hand_m;
    action_start_s_ = now_s_;
  }
  dt_s_ = p.time_s - now_s_;
  now_s_ = p.time_s;
  seen_.push_back(p), felt_.push_back(p);
  for (; !seen_.empty() && seen_.front().time_s <= now_s_ - def_.reaction_s; seen_.pop_front())
    perceive(seen_.front());
  for (; !felt_.empty() && felt_.front().time_s <= now_s_ - def_.touch_reaction_s; felt_.pop_front())
    feel(felt_.front());
  select_goal();
  if (is_held() && action_ != Action::kRise && action_ != Action::kDone) start(Action::kRise);
  target_m_ = clamped_to_floor(step_action(p));
  return target_m_;
}

Vector3d Player::step_action(const Percept& p) {
  switch (action_) {
    case Action::kTravel: return travel(p);
    case Action::kDescend: return descend(p);
    case Action::kPush: return push(p);
    case Action::kSearch: return search(p);
    case Action::kRise:
    case Action::kDone: return rise(p);
  }
  return target_m_;
}

Vector3d Player::clamped_to_floor(const Vector3d& at) const {
  if (rules_.floor_m.isEmpty()) return at;
  // design: the hand does not touch the walls
  const Eigen::Vector2d edge = Eigen::Vector2d::Constant(2 * rules_.hand_radius_m);
  const Eigen::Vector2d on =
      at.head<2>().cwiseMax(rules_.floor_m.min() + edge).cwiseMin(rules_.floor_m.max() - edge);
  return {on.x(), on.y(), at.z()};
}

void Player::perceive(const Percept& p) {
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    Belief& b = beliefs_[i];
    const Goal& goal = rules_.goals[i];
    if (i < p.fell.size() && p.fell[i]) b.fall_heard_s = now_s_, b.in_hole = true;
    if (i < p.heard_m.size() && p.heard_m[i] && now_s_ - b.last_sensed_s > kSightValid_s && !b.in_hole) {
      b.at_m = *p.heard_m[i];
      b.at_m.z() = goal.ball_radius_m;
      b.known = true;
      if (static_cast<int>(i) == goal_) only_felt_ = true, search_radius_m_ = search_angle_rad_ = 0;
    }
    if (i >= p.balls_m.size() || !p.balls_m[i]) continue;
    b.at_m = *p.balls_m[i];
    if ((b.at_m - b.shown_m).norm() > 0 || p.time_s - b.last_change_s > kSightValid_s) {  // a picture stays until the next
      const double dt_s = p.time_s - b.last_change_s;
      const bool follows = dt_s < 0.5;
      const double share = std::min(1.0, dt_s / kSeenSpeed_s);
      b.speed_m_s = follows ? Vector3d(b.speed_m_s + share * (flat(b.at_m - b.shown_m) / dt_s - b.speed_m_s))
                            : Vector3d(Vector3d::Zero());
      b.shown_m = b.at_m, b.last_change_s = p.time_s;
    }
    b.known = true;
    b.last_sensed_s = now_s_;
    if (static_cast<int>(i) == goal_) only_felt_ = false;
    if (now_s_ - b.fall_heard_s < kFallHeardValid_s) continue;
    b.in_hole = b.at_m.z() < kFallen_m && flat(b.at_m - goal.hole_m).norm() < goal.hole_radius_m;
  }
}

void Player::feel(const Percept& p) {
  const Vector3d force = flat(p.force_N);
  force_N_ = force.norm();
  pull_N_ = p.force_N;
  if (pull_N_.norm() < kHeldForce_N) last_free_s_ = now_s_;
  if (force_N_ < def_.touch_threshold_N || goal_ >= static_cast<int>(beliefs_.size())) return;
  const bool begins = !feels_contact();
  felt_s_ = now_s_;
  const Vector3d from_hand = -contact_distance_m() * force / force_N_;
  felt_from_hand_m_ += (begins ? 1 : std::min(1.0, dt_s_ / kFeltPlace_s)) * (from_hand - felt_from_hand_m_);
  const Vector3d at = flat(p.hand_m) + felt_from_hand_m_;
  if (begins)
    felt_speed_m_s_.setZero();
  else if (dt_s_ > 0)
    felt_speed_m_s_ += std::min(1.0, dt_s_ / kFeltSpeed_s) * ((at - felt_at_m_) / dt_s_ - felt_speed_m_s_);
  felt_at_m_ = at;
  if (sees_ball() || (action_ != Action::kPush && action_ != Action::kSearch)) return;
  // An unseen ball lies where the reaction force comes from.
  Belief& b = ball();
  b.at_m = p.hand_m - force / force_N_ * (target().ball_radius_m + rules_.hand_radius_m);
  b.at_m.z() = target().ball_radius_m;
  b.known = true;
  b.last_sensed_s = now_s_;
  only_felt_ = true;
}

// Selects the next ball that is not in its hole, when the current one is.
void Player::select_goal() {
  const int count = static_cast<int>(beliefs_.size());
  if (goal_ < count && !ball().in_hole) return;
  int next = 0;
  while (next < count && beliefs_[static_cast<std::size_t>(next)].in_hole) ++next;
  if (next == goal_) return;
  goal_ = next;
  search_radius_m_ = search_angle_rad_ = 0;
  only_felt_ = false;
  start(goal_ == count ? Action::kDone : Action::kRise);
}

Vector3d Player::rise(const Percept& p) {
  // A hand that is held yields in the direction of the pull until it is free.
  if (is_held()) return action_start_m_ = step_towards(p.hand_m + kYieldDistance_m * pull_N_.normalized(), def_.air_speed_m_s);
  Vector3d up = action_start_m_;
  up.z() = def_.travel_height_m;
  if (action_ == Action::kRise && (target_m_ - up).norm() < kArrived_m) start(Action::kTravel);
  return step_towards(up, def_.air_speed_m_s);
}

Vector3d Player::travel(const Percept&) {
  // Without any belief about the ball, a search begins behind its place.
  Vector3d to = clamped_to_floor(position_behind(def_.gap_m));
  to.z() = def_.travel_height_m;
  // It waits above a rolling ball until the ball is slow, so that the hand does not come down on the ball.
  if ((target_m_ - to).norm() < kArrived_m && !ball_rolls()) start(Action::kDescend);
  return step_towards(to, def_.air_speed_m_s);
}

Vector3d Player::descend(const Percept&) {
  const Vector3d to = clamped_to_floor(position_behind(def_.gap_m));
  if (flat(target_m_ - to).norm() > kBallMoved_m || ball_rolls())
    start(Action::kRise);
  else if ((target_m_ - to).norm() < kArrived_m)
    start(ball().known ? Action::kPush : Action::kSearch);
  return step_towards(to, 0.6 * def_.air_speed_m_s);
}

Vector3d Player::push(const Percept& p) {
  const Vector3d u = direction_to_hole(), from_ball = flat(p.hand_m - predicted_ball_m());
  const double sum = target().ball_radius_m + rules_.hand_radius_m;
  const Vector3d aside = from_ball - from_ball.dot(u) * u;
  const bool informed = sees_ball() || feels_contact();
  const bool past = from_ball.dot(u) > 0 || aside.norm() > 0.8 * sum;
  const bool beyond = flat(p.hand_m - target().hole_m).dot(u) > 0;
  const bool stuck = feels_contact() && now_s_ - action_start_s_ > kStuck_s &&
                     flat(p.hand_m - action_start_m_).norm() < 0.5 * def_.push_speed_m_s * kStuck_s * 0.3;
  if (informed && (past || beyond)) start(Action::kRise);
  if (!informed && now_s_ - std::max({action_start_s_ + def_.gap_m / def_.push_speed_m_s, felt_s_, ball().last_sensed_s}) > kLost_s) {
    ball().known = false;
    start(Action::kSearch);
  }
  if (stuck) {
    if (!sees_ball()) ball().known = false, search_radius_m_ += kSearchPitch_m;
    start(Action::kRise);
  }
  double speed = def_.push_speed_m_s;
  if (feels_contact() && force_N_ > def_.gentle_force_N) speed *= def_.gentle_force_N / force_N_;
  const Vector3d steer = rules_.slope_m_s2.norm() > kMinSlope_m_s2 ? balance(p, u)
                         : sees_ball() ? Vector3d(-kSteer_1_s * aside)
                                                                  : Vector3d::Zero();
  // Limits the distance by which the target leads the hand.
  Vector3d next = target_m_ + dt_s_ * (speed * u + steer);
  if (flat(next - p.hand_m).norm() > 0.03) next = p.hand_m + 0.03 * flat(next - p.hand_m).normalized();
  next.z() = push_height_m();
  return next;
}

// On a slope the hand carries the ball's weight along it, N = m g_u / c_u; sideways it gives N c_a, so the ball's sideways
// acceleration is 5/7 (g_a + g_u c_a / c_u) (a rolling sphere has 7/5 of its mass). The controller sets it so that it brakes
// the sideways motion.
Vector3d Player::balance(const Percept& p, const Vector3d& u) {
  const Vector3d a(-u.y(), u.x(), 0);
  const bool seen = sees_ball(), felt = feels_contact();
  if (!seen && !felt) return Vector3d::Zero();
  const double sight = !felt ? 1 : seen ? kSightWeight : 0;
  const double offset_m = (sight * flat(predicted_ball_m() - p.hand_m) + (1 - sight) * felt_from_hand_m_).dot(a);
  const double speed_m_s = (sight * ball().speed_m_s + (1 - sight) * felt_speed_m_s_).dot(a);
  const double against = -rules_.slope_m_s2.dot(u);
  // Without contact: the next push gives the ball its own speed in the direction to the hole.
  double tangent = -speed_m_s / def_.push_speed_m_s;
  if (felt && against > kMinSlope_m_s2)
    tangent = (-1.4 * kDamping_1_s * speed_m_s - rules_.slope_m_s2.dot(a)) / against;
  const double wanted_offset_m = contact_distance_m() * std::clamp(tangent, -kMaxOffsetShare, kMaxOffsetShare);
  return (kBalance_1_s * (offset_m - wanted_offset_m) + speed_m_s) * a;
}

Vector3d Player::search(const Percept&) {
  if (feels_contact() || sees_ball()) {
    start(Action::kRise);
    return target_m_;
  }
  // A spiral about its last place, at the speed of a push.
  const Vector3d centre = flat(ball().at_m);
  const double radius = std::max(search_radius_m_, 0.01);
  search_angle_rad_ += dt_s_ * def_.push_speed_m_s / radius;
  search_radius_m_ += dt_s_ * def_.push_speed_m_s / radius * kSearchPitch_m / (2 * std::numbers::pi);
  if (search_radius_m_ > kMaxSearchRadius_m) search_radius_m_ = search_angle_rad_ = 0;
  Vector3d to = centre + radius * Vector3d(std::cos(search_angle_rad_), std::sin(search_angle_rad_), 0);
  to.z() = push_height_m();
  return step_towards(to, 1.5 * def_.push_speed_m_s);
}

}  // namespace tactus::simulated_player
