#include "scripts/simulated_player/observer_player.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scripts/simulated_player/observer/hand.h"
#include "scripts/simulated_player/observer/lqg.h"
#include "scripts/simulated_player/observer/reaction.h"
#include "sync/random/keyed_random.h"

namespace tactus::simulated_player {
namespace {

using Eigen::Vector3d;

// Design, as for pointing (observer/pointing.cpp): growth of the time constant for each second of noticed mismatch.
constexpr double kSlowsDown = 3.2;
constexpr double kPaceStep = 1.05;  // the feedback is computed again after this change of the rate
constexpr double kTravelHeight_m = 0.13, kPassed_m = 0.05, kBehindGap_m = 0.02, kStill_m_s = 0.08;
constexpr double kMoved_m = 0.03;          // a ball that has moved this far is approached again
constexpr double kRolls_m_s = 0.4;         // the hand does not come down on a ball that rolls faster: it could not follow
constexpr double kOver_m = 0.08, kHighestOver_m = 0.32;  // over things that held the hand on its way
constexpr double kTolerance_m = 0.010;     // beside a place, for the typical caution
constexpr double kLead_m = 0.03;           // of the moving target of a push before the hand
constexpr double kGentle_N = 1.5;          // a push with more force slows down
constexpr double kFreeze_m = 0.05;         // nearer to its hole a ball is not steered any more
constexpr double kMayBeLost_s = 0.6, kMayBeLost_m = 0.05, kStuckFor_s = 1.5, kHeldFor_s = 0.4, kYields_m = 0.05;
constexpr double kSpiralPitch_m = 0.025, kWidestSpiral_m = 0.2, kSpiral_m_s = 0.2;
constexpr double kBlocked_m = 0.006, kWallSide = 0.3;  // of the place behind a ball at a wall; share of the contact distance aside
constexpr double kBelieves = 0.9;          // a ball is in its hole above this probability, and out of it below the rest
constexpr double kMoveAndWait_m = 0.05;    // of a push before the wait
constexpr double kRollingLoss_1_s = 1;     // a pushed ball on a level floor needs this acceleration for each unit of speed
constexpr double kSpeedWeight_s = 0.15, kVigourOfPush_N_m = 250;  // of the balance: costs of speed and effort
constexpr std::uint64_t kDecisionStream = 121;

Vector3d on_floor(const Vector3d& v) { return {v.x(), v.y(), 0}; }

}  // namespace

ObserverPlayer::ObserverPlayer(const observer::PlayerParameters& player, const Rules& rules, const Viewer& viewer, VisibleArea visible_area,
                               const Vector3d& hand_m, std::uint64_t seed)
    : player_(player),
      rules_(rules),
      senses_(player, rules, viewer, seed),
      beliefs_(player, rules, viewer, std::move(visible_area), hand_m, seed),
      decisions_(seed, kDecisionStream),
      target_m_(hand_m),
      from_m_(hand_m) {}

Vector3d ObserverPlayer::step(double now_s, const Vector3d& hand_m, const Vector3d& perceived_N, bool game_runs) {
  if (now_s + 1e-9 < next_sample_s_) return command_N_;
  next_sample_s_ += kSampleStep_s * std::max(1.0, std::ceil((now_s - next_sample_s_) / kSampleStep_s));
  now_s_ = now_s;
  senses_.press(now_s, perceived_N);
  senses_.place_hand(now_s, hand_m);
  const bool pushes = action_ == Action::kPush || action_ == Action::kSearch;
  beliefs_.perceive(now_s, senses_, goal_, pushes);
  if (game_runs) {
    if (!std::exchange(started_, true)) begun_s_ = now_s;
    update_pace();
    select_goal();
    if (decided_ && now_s >= decided_s_) begin(*std::exchange(decided_, {}));
    target_m_s_.setZero(), steers_ = false;
    if (!decided_) act();
    command_N_ = command();
  }
  beliefs_.predict(now_s, command_N_, goal_);
  return command_N_;
}

Vector3d ObserverPlayer::gaze_m() { return has_goal() ? beliefs_.ball(goal_).place_m() : beliefs_.hand().place_m(); }

void ObserverPlayer::begin(Action action) {
  action_ = action;
  begun_s_ = now_s_;
  from_m_ = beliefs_.hand().place_m();
  pushed_m_ = 0, wait_until_s_ = 0;
  if (action == Action::kPush) target_m_ = from_m_;
}

// The natural latency has passed and the muscle follows: the rest of a simple reaction is the decision.
void ObserverPlayer::decide(Action action, int choices) {
  if (decided_) return;
  const double decision_s = observer::simple_reaction_s(player_, observer::Stimulus::kVision, decisions_) - player_.visual_latency_s - player_.muscle_s;
  decided_ = action;
  decided_s_ = now_s_ + decision_s + observer::choice_time_s(choices);
  target_m_ = beliefs_.hand().place_m();
}

void ObserverPlayer::select_goal() {
  const int count = static_cast<int>(rules_.goals.size());
  if (has_goal() && beliefs_.ball(goal_).in_hole() < kBelieves) return;
  int next = count, left = 0;
  for (int i = count - 1; i >= 0; --i)
    if (beliefs_.ball(i).in_hole() < 1 - kBelieves || (i != goal_ && beliefs_.ball(i).in_hole() < kBelieves)) next = i, ++left;
  if (next == goal_) return;
  goal_ = next;
  search_radius_m_ = search_angle_rad_ = 0;
  balance_against_ = -1;
  decided_.reset();
  decide(next == count ? Action::kDone : Action::kRise, left);
}

void ObserverPlayer::update_pace() {
  const double unknown_s = std::abs(beliefs_.sight_delay().noticed_s());
  const double rate = 1 / (player_.pace_s_bit / std::numbers::ln2 + kSlowsDown * unknown_s);
  if (rate_1_s_ > 0 && std::abs(std::log(rate / rate_1_s_)) < std::log(kPaceStep)) return;
  rate_1_s_ = rate;
  feedback_ = observer::approach_feedback(player_, rate, kSampleStep_s);
}

bool ObserverPlayer::is_held() const { return now_s_ - beliefs_.last_free_s() > kHeldFor_s; }

double ObserverPlayer::travel_height_m() const { return kTravelHeight_m + over_m_; }

Vector3d ObserverPlayer::direction_to_hole() {
  const Vector3d ball = beliefs_.ball(goal_).place_m(), d = on_floor(target().hole_m - ball);
  if (d.norm() < 1e-3 || (d.norm() < kFreeze_m && action_ == Action::kPush)) return direction_;
  direction_ = d.normalized();
  aside_m_ = 0;
  // Between a ball and a wall there is no room for the hand: it pushes along the wall, from the side of the wall.
  const double reach_m = beliefs_.contact_distance_m(goal_);
  const Vector3d blocked = on_floor(clamped_to_floor(ball - reach_m * direction_) - (ball - reach_m * direction_));
  if (blocked.norm() < kBlocked_m) return direction_;
  const Vector3d inwards = blocked.normalized(), along = direction_ - direction_.dot(inwards) * inwards;
  if (along.norm() < 0.1) return direction_;
  direction_ = along.normalized();
  aside_m_ = kWallSide * reach_m * inwards.dot(Vector3d(-direction_.y(), direction_.x(), 0));
  return direction_;
}

Vector3d ObserverPlayer::behind_ball_m(double gap_m) {
  const Vector3d u = direction_to_hole(), across(-u.y(), u.x(), 0);
  Vector3d at = beliefs_.ball(goal_).place_m() - (beliefs_.contact_distance_m(goal_) + gap_m) * u - aside_m_ * across;
  at.z() = target().hole_m.z() + beliefs_.push_height_m(goal_);
  return at;
}

Vector3d ObserverPlayer::clamped_to_floor(const Vector3d& at) const {
  if (rules_.floor_m.isEmpty()) return at;
  const Eigen::Vector2d edge = Eigen::Vector2d::Constant(2 * rules_.hand_radius_m);  // design: the hand does not touch the walls
  const Eigen::Vector2d on = at.head<2>().cwiseMax(rules_.floor_m.min() + edge).cwiseMin(rules_.floor_m.max() - edge);
  return {on.x(), on.y(), at.z()};
}

bool ObserverPlayer::arrived(const Vector3d& at, double tolerance_m) {
  return (beliefs_.hand().place_m() - at).norm() < tolerance_m / std::sqrt(player_.caution) && (beliefs_.hand().speed_m_s() - target_m_s_).norm() < kStill_m_s;
}

void ObserverPlayer::act() {
  if (is_held() && action_ != Action::kRise && action_ != Action::kDone) {
    // Something stands in the way: the next way leads over it.
    if (action_ == Action::kTravel) over_m_ = std::min(over_m_ + kOver_m, kHighestOver_m);
    begin(Action::kRise);
  }
  switch (action_) {
    case Action::kTravel: return travel();
    case Action::kDescend: return descend();
    case Action::kPush: return push();
    case Action::kSearch: return search();
    case Action::kRise:
    case Action::kDone: return rise();
  }
}

void ObserverPlayer::rise() {
  if (is_held()) {  // yields in the direction of the force until the hand is free
    target_m_ = beliefs_.hand().place_m() + kYields_m * beliefs_.force_N().normalized();
    return;
  }
  target_m_ = from_m_;
  target_m_.z() = travel_height_m();
  if (action_ == Action::kRise && has_goal() && std::abs(beliefs_.hand().place_m().z() - travel_height_m()) < kPassed_m) begin(Action::kTravel);
}

void ObserverPlayer::travel() {
  target_m_ = clamped_to_floor(behind_ball_m(kBehindGap_m));
  const Vector3d on_the_way = on_floor(beliefs_.hand().place_m() - target_m_);
  target_m_.z() = travel_height_m();
  follow();
  const bool rolls = beliefs_.sees(goal_) && beliefs_.ball(goal_).speed_m_s().norm() > kRolls_m_s;
  if (on_the_way.norm() < kTolerance_m / std::sqrt(player_.caution) && !rolls) begin(Action::kDescend), over_m_ = 0;
}

// Pursues a seen ball that rolls: the hand moves with its speed, so that it does not stay behind.
void ObserverPlayer::follow() {
  if (beliefs_.sees(goal_)) target_m_s_ = beliefs_.ball(goal_).speed_m_s();
}

void ObserverPlayer::descend() {
  target_m_ = clamped_to_floor(behind_ball_m(kBehindGap_m));
  follow();
  const bool rolls = beliefs_.sees(goal_) && beliefs_.ball(goal_).speed_m_s().norm() > kRolls_m_s;
  if (on_floor(beliefs_.hand().place_m() - target_m_).norm() > kMoved_m || rolls)
    decide(Action::kRise);
  else if (arrived(target_m_, kTolerance_m))
    begin(beliefs_.ball(goal_).sd_m() < kMayBeLost_m * player_.search_spread || beliefs_.sees(goal_) ? Action::kPush : Action::kSearch);
}

void ObserverPlayer::push() {
  const Vector3d u = direction_to_hole(), hand = beliefs_.hand().place_m();
  BelievedBall& ball = beliefs_.ball(goal_);
  const Vector3d from_ball = on_floor(hand - ball.place_m()), aside = from_ball - from_ball.dot(u) * u;
  const double distance_m = beliefs_.contact_distance_m(goal_);
  const bool informed = beliefs_.sees(goal_) || beliefs_.feels_contact();
  steers_ = true;
  if (informed && (from_ball.dot(u) > 0 || aside.norm() > 0.9 * distance_m || on_floor(hand - target().hole_m).dot(u) > 0)) {
    decide(Action::kRise);
    return;
  }
  if (!informed && now_s_ - begun_s_ > kMayBeLost_s && now_s_ - ball.last_seen_s > kMayBeLost_s + beliefs_.sight_delay().believed_s() &&
      ball.sd_m() > kMayBeLost_m * player_.search_spread) {
    decide(Action::kSearch);
    return;
  }
  const bool stuck = now_s_ - begun_s_ > kStuckFor_s && on_floor(hand - from_m_).norm() < 0.015;
  if (stuck) {
    if (!beliefs_.sees(goal_)) search_radius_m_ += kSpiralPitch_m;
    decide(Action::kRise);
    return;
  }
  // The steering law: the time for each contact width is the pace of a bit.
  double speed_m_s = distance_m * rate_1_s_ / std::numbers::ln2;
  // A light thing leaves an elastic impact with up to twice the closing speed. At half of the speed of the push it does not run
  // away from the hand, which could not steer it then.
  speed_m_s = std::min(speed_m_s, std::max(0.0, ball.speed_m_s().dot(u)) + speed_m_s / 2);
  const double force_N = on_floor(beliefs_.force_N()).norm();
  if (beliefs_.feels_contact() && force_N > kGentle_N) speed_m_s *= kGentle_N / force_N;
  const double whole_delay_s = beliefs_.sight_delay().believed_s() + beliefs_.sight_delay().noticed_s();
  if (beliefs_.sight_delay().believed_s() > player_.wait_threshold_s) {
    if (pushed_m_ > kMoveAndWait_m) pushed_m_ = 0, wait_until_s_ = now_s_ + whole_delay_s + kLookDuration_s;
    if (now_s_ < wait_until_s_) speed_m_s = 0;
    pushed_m_ += kSampleStep_s * speed_m_s;
  }
  const double lead_m = std::min(u.dot(target_m_ - hand) + kSampleStep_s * speed_m_s, kLead_m);
  target_m_ = hand + lead_m * u;
  target_m_.z() = target().hole_m.z() + beliefs_.push_height_m(goal_);
  target_m_s_ = speed_m_s * u;
}

void ObserverPlayer::search() {
  if (beliefs_.feels_contact() || beliefs_.sees(goal_)) {
    search_radius_m_ = search_angle_rad_ = 0;
    decide(Action::kRise);
    return;
  }
  const double radius_m = std::max(search_radius_m_, 0.01);
  search_angle_rad_ += kSampleStep_s * kSpiral_m_s / radius_m;
  search_radius_m_ += kSampleStep_s * kSpiral_m_s / radius_m * kSpiralPitch_m * player_.search_spread / (2 * std::numbers::pi);
  if (search_radius_m_ > kWidestSpiral_m * player_.search_spread) search_radius_m_ = search_angle_rad_ = 0;
  target_m_ = clamped_to_floor(beliefs_.ball(goal_).place_m() + radius_m * Vector3d(std::cos(search_angle_rad_), std::sin(search_angle_rad_), 0));
  target_m_.z() = target().hole_m.z() + beliefs_.push_height_m(goal_);
}

// Ball and hand across the push: the offset r of the ball, its speed, and speed, force and excitation of the hand. A ball that the
// hand holds against an acceleration a leans to a side like an inverted pendulum, r'' = a r / D - (acceleration of the hand).
observer::Vector ObserverPlayer::balance_feedback(double against_m_s2) const {
  const observer::Hand hand(player_, kSampleStep_s, 0);
  observer::LqgProblem p;
  p.a = observer::Matrix::Identity(5, 5);
  p.a(0, 1) = kSampleStep_s, p.a(0, 2) = -kSampleStep_s;
  p.a(1, 0) = kSampleStep_s * against_m_s2 / beliefs_.contact_distance_m(goal_);
  p.a.bottomRightCorner(3, 3) = hand.plant().a.bottomRightCorner(3, 3);
  p.b = observer::Vector::Zero(5);
  p.b.tail(3) = hand.plant().b.tail(3);
  p.control_share = hand.share();
  p.running_cost = p.final_cost = observer::Matrix::Zero(5, 5);
  p.running_cost(0, 0) = 1;
  p.running_cost(1, 1) = kSpeedWeight_s * kSpeedWeight_s;
  p.effort = 1 / (kVigourOfPush_N_m * kVigourOfPush_N_m);
  return observer::steady_feedback(p);
}

double ObserverPlayer::lateral_command_N(const Vector3d& aside) {
  const double rolling = 5.0 / 7 * -rules_.slope_m_s2.dot(direction_), speed_m_s = target_m_s_.norm();
  const double against = std::max({rolling, kRollingLoss_1_s * speed_m_s, 0.05});
  if (balance_against_ < 0 || std::abs(std::log(against / balance_against_)) > 0.1) {
    balance_ = balance_feedback(against);
    balance_against_ = against;
  }
  BelievedBall& ball = beliefs_.ball(goal_);
  const HandState hand = beliefs_.hand().state_along(aside, Vector3d::Zero());
  observer::Vector state(5);
  state << aside.dot(ball.place_m() - beliefs_.hand().place_m()) - aside_m_, aside.dot(ball.speed_m_s()), hand[observer::kSpeed],
      hand[observer::kForce], hand[observer::kExcitation];
  return -balance_.dot(state);
}

Vector3d ObserverPlayer::command() {
  const Vector3d across(-direction_.y(), direction_.x(), 0);
  const Vector3d axes[]{steers_ ? direction_ : Vector3d::UnitX(), steers_ ? across : Vector3d::UnitY(), Vector3d::UnitZ()};
  Vector3d command = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    HandState state = beliefs_.hand().state_along(axes[i], target_m_);
    state[observer::kSpeed] -= axes[i].dot(target_m_s_);
    command += (steers_ && i == 1 ? lateral_command_N(across) : -feedback_.dot(observer::Vector(state))) * axes[i];
  }
  return command;
}

}  // namespace tactus::simulated_player
