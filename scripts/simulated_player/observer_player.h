// The observer player in a game of a scene: each ball into its hole. It acts on its beliefs alone (observer_beliefs.h), by optimal
// feedback of an arm with two-pole muscles. Pure: times are arguments, in s since the start of the game.
//
// It moves the hand behind a ball, comes down and pushes it towards its hole; it searches for a ball whose place is too unsure;
// it steers a pushed ball with a feedback that is optimal for ball and hand together. Its pace follows from the difficulty: time
// for each bit in aimed movements, and for each contact width in a push (steering law: Accot and Zhai 1997). A noticed mismatch of
// the delay of sight slows it; above a believed delay it moves and waits.
#pragma once

#include <cstdint>
#include <optional>

#include "scripts/simulated_player/observer_beliefs.h"
#include "scripts/simulated_player/observer_senses.h"

namespace tactus::simulated_player {

class ObserverPlayer {
 public:
  enum class Action : std::uint8_t { kTravel, kDescend, kPush, kSearch, kRise, kDone };

  // seed: of player and game. hand_m: where the hand rests.
  ObserverPlayer(const observer::PlayerParameters& player, const Rules& rules, const Viewer& viewer, VisibleArea visible_area,
                 const Eigen::Vector3d& hand_m, std::uint64_t seed);

  // The senses; the caller presents pictures and sounds to them.
  ObserverSenses& senses() { return senses_; }
  ObserverBeliefs& beliefs() { return beliefs_; }
  // Every tick, in order of time: the command to the muscles, N. hand_m: of the own arm; perceived_N: the force on the hand, as the
  // stage `percept` leaves it. The command changes every kSampleStep_s. limit: without a game the hand rests.
  Eigen::Vector3d step(double now_s, const Eigen::Vector3d& hand_m, const Eigen::Vector3d& perceived_N, bool game_runs = true);
  // Where the eye looks.
  Eigen::Vector3d gaze_m();
  Action action() const { return action_; }
  // The goal of the hand, m; for inspection.
  const Eigen::Vector3d& target_m() const { return target_m_; }
  // The current goal; the number of goals: all are believed to be reached.
  int goal() const { return goal_; }

 private:
  void select_goal();
  // A planned next action, or one that a percept causes: that one takes the time of a decision.
  void begin(Action action);
  void decide(Action action, int choices = 1);
  void act();
  void rise();
  void travel();
  void follow();
  void descend();
  void push();
  void search();
  void update_pace();
  Eigen::Vector3d command();
  double lateral_command_N(const Eigen::Vector3d& aside);
  observer::Vector balance_feedback(double against_m_s2) const;
  const Goal& target() const { return rules_.goals[static_cast<std::size_t>(goal_)]; }
  bool has_goal() const { return goal_ < static_cast<int>(rules_.goals.size()); }
  Eigen::Vector3d clamped_to_floor(const Eigen::Vector3d& at) const;
  Eigen::Vector3d behind_ball_m(double gap_m);
  Eigen::Vector3d direction_to_hole();
  bool arrived(const Eigen::Vector3d& at, double tolerance_m);
  bool is_held() const;
  double travel_height_m() const;

  observer::PlayerParameters player_;
  Rules rules_;
  ObserverSenses senses_;
  ObserverBeliefs beliefs_;
  observer::NoiseStream decisions_;
  Action action_ = Action::kRise;
  std::optional<Action> decided_{};  // begins at decided_s_
  double decided_s_ = 0;
  int goal_ = 0;
  double now_s_ = 0, next_sample_s_ = 0, begun_s_ = 0;  // begun_s_: start of the current action
  bool started_ = false;
  double rate_1_s_ = 0;  // of the approach, for feedback_
  observer::Vector feedback_, balance_;
  double balance_against_ = -1;
  Eigen::Vector3d target_m_, target_m_s_{0, 0, 0}, from_m_, command_N_{0, 0, 0};  // from_m_: the hand at the start of the action
  bool steers_ = false;                                                           // the lateral feedback of a push
  Eigen::Vector3d direction_{1, 0, 0};                                            // of the push
  double aside_m_ = 0;                                                            // wanted offset of the ball across it
  double search_radius_m_ = 0, search_angle_rad_ = 0;
  double pushed_m_ = 0, wait_until_s_ = 0;  // move and wait
  double over_m_ = 0;                       // added to the height of a way on which something held the hand
};

}  // namespace tactus::simulated_player
