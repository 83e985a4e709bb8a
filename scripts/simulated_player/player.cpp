#include "scripts/simulated_player/player.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::simulated_player {
namespace {

using Eigen::Vector3d;

// All values are design.
constexpr double kThere_m = 0.006;     // near enough to a place
constexpr double kMoved_m = 0.03;      // a ball that has moved this far is approached again
constexpr double kFallen_m = -0.01;    // a ball with its centre below this is in a hole
constexpr double kHeard_s = 1.0;       // a heard fall overrides sight for this time
constexpr double kLost_s = 0.6;        // after pushing for this time without sight or touch, the ball is lost
constexpr double kStuck_s = 1.5;       // an object that does not move for this time is no ball
constexpr double kTurn_m = 0.025;      // a search widens by this each revolution
constexpr double kWidest_m = 0.2;      // then it restarts
constexpr double kSteer_1_s = 6;       // rate of the sideways movement behind a ball
constexpr double kSeenSpeed_s = 0.05;  // averaging time of the seen speed
constexpr double kFeltSpeed_s = 0.06;  // averaging time of the felt speed
constexpr double kFeltPlace_s = 0.03;  // averaging time of the felt place on the hand
constexpr double kSightWeight = 0.5;   // weight of sight against touch, for the place of a ball on the hand
constexpr double kDamping_1_s = 1.5;    // rate at which the sideways speed of a ball is braked
// Rate at which the hand moves to the balance point: slower than the steering, because sight is late.
constexpr double kBalance_1_s = 4;
constexpr double kFurthest_m = 0.05;  // limit of the prediction
// Limit of the ball's sideways offset on the hand, as a share of their distance.
constexpr double kSteepest = 0.5;
constexpr double kHolds_N = 4;  // objects that can be pushed do not resist this long
constexpr double kGives_m = 0.05;
constexpr double kLevel_m_s2 = 0.05;  // less of a slope needs no balance
// Distance of a ball that was never seen in front of its hole, as given before the game.
constexpr double kFirstGuess_m = 0.2;

Vector3d flat(const Vector3d& v) { return {v.x(), v.y(), 0}; }

}  // namespace

Player::Player(Rules rules, const PlayerDef& def)
    : rules_(std::move(rules)), def_(def), beliefs_(rules_.goals.size()) {
  for (std::size_t i = 0; i < beliefs_.size(); ++i)
    beliefs_[i].at_m = rules_.goals[i].hole_m - Vector3d(kFirstGuess_m, 0, 0);
}

double Player::height() const { return std::max(0.75 * target().ball_radius_m, rules_.hand_radius_m + 0.004); }

// The hand touches a ball below its middle, so its centre is nearer than the sum of the radii.
double Player::reach_m() const {
  const double sum = target().ball_radius_m + rules_.hand_radius_m, up = target().ball_radius_m - height();
  return std::sqrt(std::max(0.0, sum * sum - up * up));
}

Vector3d Player::way() {
  const Vector3d d = flat(target().hole_m - ball().at_m);
  return d.norm() > 1e-3 ? d.normalized() : Vector3d(1, 0, 0);
}

Vector3d Player::expected_m() {
  const Vector3d ahead = sees() ? Vector3d(def_.reckons_s * ball().speed_m_s) : Vector3d(Vector3d::Zero());
  return ball().at_m + std::min(1.0, kFurthest_m / std::max(ahead.norm(), 1e-9)) * ahead;
}

bool Player::rolls() { return sees() && ball().speed_m_s.norm() > def_.slow_m_s; }

Vector3d Player::behind(double gap_m) {
  Vector3d at = expected_m() - (reach_m() + gap_m) * way();
  at.z() = height();
  return at;
}

Vector3d Player::towards(const Vector3d& to, double speed_m_s) const {
  const Vector3d d = to - wanted_m_;
  const double most = speed_m_s * dt_s_;
  return d.norm() <= most ? to : Vector3d(wanted_m_ + most * d.normalized());
}

void Player::begin(Doing doing) {
  doing_ = doing;
  since_s_ = now_s_;
  begun_m_ = wanted_m_;
}

Vector3d Player::step(const Percept& p) {
  if (!std::exchange(begun_, true)) {
    free_s_ = p.time_s;
    now_s_ = p.time_s;
    wanted_m_ = begun_m_ = p.hand_m;
    since_s_ = now_s_;
  }
  dt_s_ = p.time_s - now_s_;
  now_s_ = p.time_s;
  seen_.push_back(p), felt_.push_back(p);
  for (; !seen_.empty() && seen_.front().time_s <= now_s_ - def_.reaction_s; seen_.pop_front())
    perceive(seen_.front());
  for (; !felt_.empty() && felt_.front().time_s <= now_s_ - def_.touch_reaction_s; felt_.pop_front())
    feel(felt_.front());
  choose();
  if (held() && doing_ != Doing::kRise && doing_ != Doing::kDone) begin(Doing::kRise);
  wanted_m_ = over_floor(act(p));
  return wanted_m_;
}

Vector3d Player::act(const Percept& p) {
  switch (doing_) {
    case Doing::kTravel: return travel(p);
    case Doing::kDescend: return descend(p);
    case Doing::kPush: return push(p);
    case Doing::kSearch: return search(p);
    case Doing::kRise:
    case Doing::kDone: return rise(p);
  }
  return wanted_m_;
}

Vector3d Player::over_floor(const Vector3d& at) const {
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
    if (i < p.fell.size() && p.fell[i]) b.heard_s = now_s_, b.in_hole = true;
    if (i < p.heard_m.size() && p.heard_m[i] && now_s_ - b.since_s > kSeen_s && !b.in_hole) {
      b.at_m = *p.heard_m[i];
      b.at_m.z() = goal.ball_radius_m;
      b.known = true;
      if (static_cast<int>(i) == goal_) only_felt_ = true, searched_m_ = turned_rad_ = 0;
    }
    if (i >= p.balls_m.size() || !p.balls_m[i]) continue;
    b.at_m = *p.balls_m[i];
    if ((b.at_m - b.shown_m).norm() > 0 || p.time_s - b.changed_s > kSeen_s) {  // a picture stays until the next
      const double dt_s = p.time_s - b.changed_s;
      const bool follows = dt_s < 0.5;
      const double share = std::min(1.0, dt_s / kSeenSpeed_s);
      b.speed_m_s = follows ? Vector3d(b.speed_m_s + share * (flat(b.at_m - b.shown_m) / dt_s - b.speed_m_s))
                            : Vector3d(Vector3d::Zero());
      b.shown_m = b.at_m, b.changed_s = p.time_s;
    }
    b.known = true;
    b.since_s = now_s_;
    if (static_cast<int>(i) == goal_) only_felt_ = false;
    if (now_s_ - b.heard_s < kHeard_s) continue;
    b.in_hole = b.at_m.z() < kFallen_m && flat(b.at_m - goal.hole_m).norm() < goal.hole_radius_m;
  }
}

void Player::feel(const Percept& p) {
  const Vector3d force = flat(p.force_N);
  force_N_ = force.norm();
  pull_N_ = p.force_N;
  if (pull_N_.norm() < kHolds_N) free_s_ = now_s_;
  if (force_N_ < def_.felt_N || goal_ >= static_cast<int>(beliefs_.size())) return;
  const bool begins = !feels();
  felt_s_ = now_s_;
  const Vector3d from_hand = -reach_m() * force / force_N_;
  felt_from_hand_m_ += (begins ? 1 : std::min(1.0, dt_s_ / kFeltPlace_s)) * (from_hand - felt_from_hand_m_);
  const Vector3d at = flat(p.hand_m) + felt_from_hand_m_;
  if (begins)
    felt_speed_m_s_.setZero();
  else if (dt_s_ > 0)
    felt_speed_m_s_ += std::min(1.0, dt_s_ / kFeltSpeed_s) * ((at - felt_at_m_) / dt_s_ - felt_speed_m_s_);
  felt_at_m_ = at;
  if (sees() || (doing_ != Doing::kPush && doing_ != Doing::kSearch)) return;
  // An unseen ball lies where the reaction force comes from.
  Belief& b = ball();
  b.at_m = p.hand_m - force / force_N_ * (target().ball_radius_m + rules_.hand_radius_m);
  b.at_m.z() = target().ball_radius_m;
  b.known = true;
  b.since_s = now_s_;
  only_felt_ = true;
}

// Selects the next ball that is not in its hole, when the present one is.
void Player::choose() {
  const int count = static_cast<int>(beliefs_.size());
  if (goal_ < count && !ball().in_hole) return;
  int next = 0;
  while (next < count && beliefs_[static_cast<std::size_t>(next)].in_hole) ++next;
  if (next == goal_) return;
  goal_ = next;
  searched_m_ = turned_rad_ = 0;
  only_felt_ = false;
  begin(goal_ == count ? Doing::kDone : Doing::kRise);
}

Vector3d Player::rise(const Percept& p) {
  // A hand that is held yields in the direction of the pull until it is free.
  if (held()) return begun_m_ = towards(p.hand_m + kGives_m * pull_N_.normalized(), def_.reach_m_s);
  Vector3d up = begun_m_;
  up.z() = def_.clear_m;
  if (doing_ == Doing::kRise && (wanted_m_ - up).norm() < kThere_m) begin(Doing::kTravel);
  return towards(up, def_.reach_m_s);
}

Vector3d Player::travel(const Percept&) {
  // Without any belief about the ball, a search begins behind its place.
  Vector3d to = over_floor(behind(def_.gap_m));
  to.z() = def_.clear_m;
  // It waits above a rolling ball until the ball is slow, so that it does not come down on it.
  if ((wanted_m_ - to).norm() < kThere_m && !rolls()) begin(Doing::kDescend);
  return towards(to, def_.reach_m_s);
}

Vector3d Player::descend(const Percept&) {
  const Vector3d to = over_floor(behind(def_.gap_m));
  if (flat(wanted_m_ - to).norm() > kMoved_m || rolls())
    begin(Doing::kRise);
  else if ((wanted_m_ - to).norm() < kThere_m)
    begin(ball().known ? Doing::kPush : Doing::kSearch);
  return towards(to, 0.6 * def_.reach_m_s);
}

Vector3d Player::push(const Percept& p) {
  const Vector3d u = way(), from_ball = flat(p.hand_m - expected_m());
  const double sum = target().ball_radius_m + rules_.hand_radius_m;
  const Vector3d aside = from_ball - from_ball.dot(u) * u;
  const bool informed = sees() || feels();
  const bool past = from_ball.dot(u) > 0 || aside.norm() > 0.8 * sum;
  const bool beyond = flat(p.hand_m - target().hole_m).dot(u) > 0;
  const bool stuck = feels() && now_s_ - since_s_ > kStuck_s &&
                     flat(p.hand_m - begun_m_).norm() < 0.5 * def_.push_m_s * kStuck_s * 0.3;
  if (informed && (past || beyond)) begin(Doing::kRise);
  if (!informed && now_s_ - std::max({since_s_ + def_.gap_m / def_.push_m_s, felt_s_, ball().since_s}) > kLost_s) {
    ball().known = false;
    begin(Doing::kSearch);
  }
  if (stuck) {
    if (!sees()) ball().known = false, searched_m_ += kTurn_m;
    begin(Doing::kRise);
  }
  double speed = def_.push_m_s;
  if (feels() && force_N_ > def_.gentle_N) speed *= def_.gentle_N / force_N_;
  const Vector3d steer = rules_.slope_m_s2.norm() > kLevel_m_s2 ? balance(p, u)
                         : sees()                               ? Vector3d(-kSteer_1_s * aside)
                                                                : Vector3d::Zero();
  // Limits the distance by which the target leads the hand.
  Vector3d next = wanted_m_ + dt_s_ * (speed * u + steer);
  if (flat(next - p.hand_m).norm() > 0.03) next = p.hand_m + 0.03 * flat(next - p.hand_m).normalized();
  next.z() = height();
  return next;
}

// On a slope the hand carries the ball's weight along it, N = m g_u / c_u; sideways it gives N c_a, so the ball's sideways
// acceleration is 5/7 (g_a + g_u c_a / c_u) (a rolling sphere has 7/5 of its mass). The controller sets it so that it brakes
// the sideways motion.
Vector3d Player::balance(const Percept& p, const Vector3d& u) {
  const Vector3d a(-u.y(), u.x(), 0);
  const bool seen = sees(), felt = feels();
  if (!seen && !felt) return Vector3d::Zero();
  const double sight = !felt ? 1 : seen ? kSightWeight : 0;
  const double offset_m = (sight * flat(expected_m() - p.hand_m) + (1 - sight) * felt_from_hand_m_).dot(a);
  const double speed_m_s = (sight * ball().speed_m_s + (1 - sight) * felt_speed_m_s_).dot(a);
  const double against = -rules_.slope_m_s2.dot(u);
  // Without contact: the next push gives the ball its own speed along the way.
  double tangent = -speed_m_s / def_.push_m_s;
  if (felt && against > kLevel_m_s2)
    tangent = (-1.4 * kDamping_1_s * speed_m_s - rules_.slope_m_s2.dot(a)) / against;
  const double wanted_m = reach_m() * std::clamp(tangent, -kSteepest, kSteepest);
  return (kBalance_1_s * (offset_m - wanted_m) + speed_m_s) * a;
}

Vector3d Player::search(const Percept&) {
  if (feels() || sees()) {
    begin(Doing::kRise);
    return wanted_m_;
  }
  // A spiral about its last place, at the speed of a push.
  const Vector3d centre = flat(ball().at_m);
  const double radius = std::max(searched_m_, 0.01);
  turned_rad_ += dt_s_ * def_.push_m_s / radius;
  searched_m_ += dt_s_ * def_.push_m_s / radius * kTurn_m / (2 * std::numbers::pi);
  if (searched_m_ > kWidest_m) searched_m_ = turned_rad_ = 0;
  Vector3d to = centre + radius * Vector3d(std::cos(turned_rad_), std::sin(turned_rad_), 0);
  to.z() = height();
  return towards(to, 1.5 * def_.push_m_s);
}

}  // namespace tactus::simulated_player
