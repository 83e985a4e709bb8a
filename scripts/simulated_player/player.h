// A simulated player: finds each ball, moves the hand behind it and pushes it into its hole, using only the percepts of its
// modalities. Pure: time is an argument.
//
// Use of the modalities:
//   sight     the place of a ball, and whether it lies in its hole, as old as the picture
//   hearing   the distinct sound of a ball that falls into a hole; the approximate place where an unseen ball hits
//   touch     contact with an object, and its force: with force feedback the hand pushes gently, without it steadily;
//             the place of the ball on the hand; the place of an unseen object
// It searches for a ball that it neither sees nor feels around its last known place, in a widening spiral. On a slope it
// balances the ball on the hand like an inverted pendulum: the hand moves beyond a ball that escapes to a side. It combines
// sight and touch of the ball's place (Ernst and Banks 2002, Nature 415); it cannot correct an additional delay of one of
// them, which misleads it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "scripts/simulated_player/rules.h"

namespace tactus::simulated_player {

// The percepts of all modalities at an instant.
struct Percept {
  double time_s = 0;
  Eigen::Vector3d hand_m{0, 0, 0};   // of its own arm, independent of the system
  Eigen::Vector3d force_N{0, 0, 0};  // on the hand, as perceived; the arm moves under the force of the device
  std::vector<std::optional<Eigen::Vector3d>>
      balls_m{};             // one for each goal: its place in the picture; nullopt: not visible
  std::vector<bool> fell{};  // one for each goal: its fall into the hole was heard since the last percept
  std::vector<std::optional<Eigen::Vector3d>>
      heard_m{};  // one for each goal: approximate place of a heard hit; nullopt: none
};

// All values are design choices: a careful person who pushes a ball the size of an egg.
struct PlayerDef {
  double reaction_s = 0.15;         // from sight or sound to action
  double touch_reaction_s = 0.07;   // from touch to action
  double air_speed_m_s = 0.5;       // in the air
  double push_speed_m_s = 0.16;     // at the ball
  double gentle_force_N = 1.5;      // a push with more force slows down
  double touch_threshold_N = 0.15;  // a smaller force is not noticed (about the absolute threshold of a fingertip on a held tool)
  double travel_height_m = 0.13;    // height of travel over the floor
  double slow_ball_m_s = 0.15;      // it waits for a ball that rolls faster
  // Predicted age of sight at the time of action: the reaction time plus the age of an undegraded picture.
  double sight_delay_s = 0.2;
  double gap_m = 0.02;  // distance behind the ball at which the hand comes down
};

class Player {
 public:
  enum class Action : std::uint8_t { kTravel, kDescend, kPush, kSearch, kRise, kDone };

  Player(Rules rules, const PlayerDef& def);

  // The target of the arm from now on, m, world. Call it in order of time.
  Eigen::Vector3d step(const Percept& percept);
  Action action() const { return action_; }
  // The current goal; the number of goals: all are believed to be reached.
  int goal() const { return goal_; }

 private:
  struct Belief {
    Eigen::Vector3d at_m{0, 0, 0};
    Eigen::Vector3d speed_m_s{0, 0, 0};  // as seen
    bool known = false, in_hole = false;
    double last_sensed_s = -1e9;       // when it was last seen or felt
    double last_change_s = -1e9;       // when the picture last showed it elsewhere
    Eigen::Vector3d shown_m{0, 0, 0};  // its place then
    double fall_heard_s = -1e9;        // when its fall was heard
  };
  void perceive(const Percept& p);
  void feel(const Percept& p);
  void select_goal();
  void start(Action action);
  Eigen::Vector3d step_action(const Percept& p);
  Eigen::Vector3d travel(const Percept& p);
  Eigen::Vector3d descend(const Percept& p);
  Eigen::Vector3d push(const Percept& p);
  Eigen::Vector3d search(const Percept& p);
  Eigen::Vector3d rise(const Percept& p);
  // In push: the speed of the hand across the direction to the hole, which keeps the ball in front of it.
  Eigen::Vector3d balance(const Percept& p, const Eigen::Vector3d& direction);
  // Distance from hand to ball at contact, in the plane of the floor, m.
  double contact_distance_m() const;
  // The predicted current place of the ball: sight compensates for its own delay.
  Eigen::Vector3d predicted_ball_m();
  // True while the ball is seen to roll.
  bool ball_rolls();
  const Goal& target() const { return rules_.goals[static_cast<std::size_t>(goal_)]; }
  Belief& ball() { return beliefs_[static_cast<std::size_t>(goal_)]; }
  // Unit vector from the ball to its hole, in the plane of the floor.
  Eigen::Vector3d direction_to_hole();
  // The place of the hand for a push, with this gap to the contact of ball and hand.
  Eigen::Vector3d position_behind(double gap_m);
  Eigen::Vector3d step_towards(const Eigen::Vector3d& to, double speed_m_s) const;
  double push_height_m() const;

  bool sees_ball() { return now_s_ - ball().last_sensed_s < kSightValid_s && !only_felt_; }
  // True while an obstacle holds the hand back, such as a wall or the rim of a hole.
  bool is_held() const { return now_s_ - last_free_s_ > kHeld_s; }
  // The nearest place over the floor.
  Eigen::Vector3d clamped_to_floor(const Eigen::Vector3d& at) const;

  bool feels_contact() const { return now_s_ - felt_s_ < kTouchValid_s; }

  // A ball seen within this time counts as visible: a few pictures.
  static constexpr double kSightValid_s = 0.1;
  static constexpr double kTouchValid_s = 0.1;
  static constexpr double kHeld_s = 0.4;

  Rules rules_;
  PlayerDef def_;
  std::deque<Percept> seen_, felt_;  // waiting for their reaction time, oldest first
  std::vector<Belief> beliefs_;
  Action action_ = Action::kTravel;
  int goal_ = 0;
  double now_s_ = 0, dt_s_ = 0;
  double action_start_s_ = 0;                                     // start of the current action
  double felt_s_ = -1e9;                                          // when it last felt a contact
  double force_N_ = 0;                                            // felt, in the plane of the floor
  Eigen::Vector3d pull_N_{0, 0, 0};                               // felt
  double last_free_s_ = -1e9;                                     // when it last felt no force that could hold it
  bool only_felt_ = false;                                        // the belief about the ball comes from touch or hearing alone
  Eigen::Vector3d felt_from_hand_m_{0, 0, 0};                     // place of the ball relative to the hand, as felt
  Eigen::Vector3d felt_at_m_{0, 0, 0}, felt_speed_m_s_{0, 0, 0};  // of the ball
  Eigen::Vector3d action_start_m_{0, 0, 0};                       // place of the hand at the start of the current action
  double search_radius_m_ = 0;                                    // radius of the current revolution of the search
  double search_angle_rad_ = 0;
  Eigen::Vector3d target_m_{0, 0, 0};
  bool started_ = false;
};

}  // namespace tactus::simulated_player
