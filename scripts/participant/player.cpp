#include "scripts/participant/player.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::participant {
namespace {

using Eigen::Vector3d;

// All design.
constexpr double kThere_m = 0.006;      // near enough to a place
constexpr double kMoved_m = 0.03;       // a ball that has moved so far is gone after anew
constexpr double kFallen_m = -0.01;     // a ball whose centre is below that is in a hole
constexpr double kHeard_s = 1.0;        // a fall that was heard is believed against the eyes for so long
constexpr double kLost_s = 0.6;         // pushing without seeing or feeling for so long, the ball is gone
constexpr double kStuck_s = 1.5;        // what does not move for so long is no ball
constexpr double kTurn_m = 0.025;       // a search widens by so much each turn
constexpr double kWidest_m = 0.2;       // then it begins anew
constexpr double kSteer_1_s = 6;        // how quickly it goes sideways to get behind a ball
constexpr double kFirstGuess_m = 0.2;   // a ball that was never seen lies so far in front of its hole: as told beforehand

Vector3d flat(const Vector3d& v) { return {v.x(), v.y(), 0}; }

}  // namespace

Player::Player(Rules rules, const PlayerDef& def) : rules_(std::move(rules)), def_(def), beliefs_(rules_.goals.size()) {
  for (std::size_t i = 0; i < beliefs_.size(); ++i) beliefs_[i].at_m = rules_.goals[i].hole_m - Vector3d(kFirstGuess_m, 0, 0);
}

double Player::height() const { return std::max(0.6 * target().ball_radius_m, rules_.hand_radius_m + 0.004); }

Vector3d Player::way() {
  const Vector3d d = flat(target().hole_m - ball().at_m);
  return d.norm() > 1e-3 ? d.normalized() : Vector3d(1, 0, 0);
}

Vector3d Player::behind(double gap_m) {
  // The hand touches a ball below its middle: its centre is nearer than the sum of the radii.
  const double sum = target().ball_radius_m + rules_.hand_radius_m, up = target().ball_radius_m - height();
  const double away = std::sqrt(std::max(0.0, sum * sum - up * up)) + gap_m;
  Vector3d at = ball().at_m - away * way();
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
    now_s_ = p.time_s;
    wanted_m_ = begun_m_ = p.hand_m;
    since_s_ = now_s_;
  }
  dt_s_ = p.time_s - now_s_;
  now_s_ = p.time_s;
  seen_.push_back(p), felt_.push_back(p);
  for (; !seen_.empty() && seen_.front().time_s <= now_s_ - def_.reaction_s; seen_.pop_front()) perceive(seen_.front());
  for (; !felt_.empty() && felt_.front().time_s <= now_s_ - def_.touch_reaction_s; felt_.pop_front()) feel(felt_.front());
  choose();
  switch (doing_) {
    case Doing::kTravel: return wanted_m_ = travel(p);
    case Doing::kDescend: return wanted_m_ = descend(p);
    case Doing::kPush: return wanted_m_ = push(p);
    case Doing::kSearch: return wanted_m_ = search(p);
    case Doing::kRise:
    case Doing::kDone: return wanted_m_ = rise(p);
  }
  return wanted_m_;
}

void Player::perceive(const Percept& p) {
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    Belief& b = beliefs_[i];
    const Goal& goal = rules_.goals[i];
    if (i < p.fell.size() && p.fell[i]) b.heard_s = now_s_, b.in_hole = true;
    if (i >= p.balls_m.size() || !p.balls_m[i]) continue;
    b.at_m = *p.balls_m[i];
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
  if (force_N_ < def_.felt_N) return;
  felt_s_ = now_s_;
  if (goal_ >= static_cast<int>(beliefs_.size()) || sees() || (doing_ != Doing::kPush && doing_ != Doing::kSearch)) return;
  // What it cannot see lies where it pushes back from.
  Belief& b = ball();
  b.at_m = p.hand_m - force / force_N_ * (target().ball_radius_m + rules_.hand_radius_m);
  b.at_m.z() = target().ball_radius_m;
  b.known = true;
  b.since_s = now_s_;
  only_felt_ = true;
}

// The next ball that is not in its hole, when this one is.
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

Vector3d Player::rise(const Percept&) {
  Vector3d up = begun_m_;
  up.z() = def_.clear_m;
  if (doing_ == Doing::kRise && (wanted_m_ - up).norm() < kThere_m) begin(Doing::kTravel);
  return towards(up, def_.reach_m_s);
}

Vector3d Player::travel(const Percept&) {
  // Where nothing is known, a search begins behind the place.
  Vector3d to = behind(def_.gap_m);
  to.z() = def_.clear_m;
  if ((wanted_m_ - to).norm() < kThere_m) begin(Doing::kDescend);
  return towards(to, def_.reach_m_s);
}

Vector3d Player::descend(const Percept&) {
  const Vector3d to = behind(def_.gap_m);
  if (flat(wanted_m_ - to).norm() > kMoved_m) begin(Doing::kRise);
  else if ((wanted_m_ - to).norm() < kThere_m) begin(ball().known ? Doing::kPush : Doing::kSearch);
  return towards(to, 0.6 * def_.reach_m_s);
}

Vector3d Player::push(const Percept& p) {
  const Vector3d u = way(), from_ball = flat(p.hand_m - ball().at_m);
  const double sum = target().ball_radius_m + rules_.hand_radius_m;
  const Vector3d aside = from_ball - from_ball.dot(u) * u;
  const bool informed = sees() || feels();
  const bool past = from_ball.dot(u) > 0 || aside.norm() > 0.8 * sum;
  const bool beyond = flat(p.hand_m - target().hole_m).dot(u) > 0;
  const bool stuck = feels() && now_s_ - since_s_ > kStuck_s && flat(p.hand_m - begun_m_).norm() < 0.5 * def_.push_m_s * kStuck_s * 0.3;
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
  const Vector3d steer = sees() ? Vector3d(-kSteer_1_s * aside) : Vector3d::Zero();
  // Nobody pushes further ahead of his hand than this.
  Vector3d next = wanted_m_ + dt_s_ * (speed * u + steer);
  if (flat(next - p.hand_m).norm() > 0.03) next = p.hand_m + 0.03 * flat(next - p.hand_m).normalized();
  next.z() = height();
  return next;
}

Vector3d Player::search(const Percept&) {
  if (feels() || sees()) {
    begin(Doing::kRise);
    return wanted_m_;
  }
  // A spiral about where it was last, at the speed of a push.
  const Vector3d centre = flat(ball().at_m);
  const double radius = std::max(searched_m_, 0.01);
  turned_rad_ += dt_s_ * def_.push_m_s / radius;
  searched_m_ += dt_s_ * def_.push_m_s / radius * kTurn_m / (2 * std::numbers::pi);
  if (searched_m_ > kWidest_m) searched_m_ = turned_rad_ = 0;
  Vector3d to = centre + radius * Vector3d(std::cos(turned_rad_), std::sin(turned_rad_), 0);
  to.z() = height();
  return towards(to, 1.5 * def_.push_m_s);
}

}  // namespace tactus::participant
