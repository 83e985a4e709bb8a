// A hand that plays: finds each ball, goes behind it and pushes it into its hole, with nothing but what its senses
// say. Pure: time is an argument.
//
// What it does with them:
//   sight     where a ball is, and whether it lies in its hole. What was seen is as old as the picture; nothing
//   more is known. hearing   a ball that falls into a hole sounds as nothing else does; and about where one hits
//   that it cannot see. touch     that it pushes something: a hand that feels how hard pushes gently, one that
//   does not pushes on; where on the hand
//             it lies; and where a thing lies that it cannot see.
// A ball that it neither sees nor feels it looks for where it knew it last, in widening turns. On a slope it
// balances the ball on the hand, as a pole is balanced: what runs away to a side is overtaken. Sight and touch of
// where it lies are combined (Ernst and Banks 2002, Nature 415); who is given one of them late is not told so, and
// is misled.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "scripts/simulated_player/rules.h"

namespace tactus::participant {

// What the senses say at an instant.
struct Percept {
  double time_s = 0;
  Eigen::Vector3d hand_m{0, 0, 0};   // of the own arm, which needs no sense of the system
  Eigen::Vector3d force_N{0, 0, 0};  // on the hand, as the device exerts it
  std::vector<std::optional<Eigen::Vector3d>>
      balls_m{};             // one for each goal: where the picture shows it; none: it does not
  std::vector<bool> fell{};  // one for each goal: its fall into the hole was heard since the last percept
  std::vector<std::optional<Eigen::Vector3d>>
      heard_m{};  // one for each goal: where it was heard to hit something, about; none: it was not
};

// All design: how a careful person pushes a ball the size of an egg.
struct PlayerDef {
  double reaction_s = 0.15;        // from what is seen or heard to what is done about it
  double touch_reaction_s = 0.07;  // from what is felt
  double reach_m_s = 0.5;          // in the air
  double push_m_s = 0.16;          // at the ball
  double gentle_N = 1.5;           // a push that is felt to be harder slows down
  double felt_N = 0.15;    // less is not noticed (about the absolute threshold of a fingertip on a held tool)
  double clear_m = 0.13;   // height of travel over the floor
  double slow_m_s = 0.15;  // a ball that rolls faster is waited for
  double reckons_s =
      0.2;  // what is seen is this old when it is acted upon: the reaction, and a picture that is not degraded
  double gap_m = 0.02;  // from the ball, where the hand comes down behind it
};

class Player {
 public:
  enum class Doing : std::uint8_t { kTravel, kDescend, kPush, kSearch, kRise, kDone };

  Player(Rules rules, const PlayerDef& def);

  // Where the arm is to go from now on, m, world. Call with time growing.
  Eigen::Vector3d step(const Percept& percept);
  Doing doing() const { return doing_; }
  // Goal that it is at; the number of goals: it believes all to be reached.
  int goal() const { return goal_; }

 private:
  struct Belief {
    Eigen::Vector3d at_m{0, 0, 0};
    Eigen::Vector3d speed_m_s{0, 0, 0};  // as it was seen to move
    bool known = false, in_hole = false;
    double since_s = -1e9;             // it was last seen or felt
    double changed_s = -1e9;           // the picture last showed it elsewhere
    Eigen::Vector3d shown_m{0, 0, 0};  // there
    double heard_s = -1e9;             // it was heard to fall
  };
  void perceive(const Percept& p);
  void feel(const Percept& p);
  void choose();
  void begin(Doing doing);
  Eigen::Vector3d act(const Percept& p);
  Eigen::Vector3d travel(const Percept& p);
  Eigen::Vector3d descend(const Percept& p);
  Eigen::Vector3d push(const Percept& p);
  Eigen::Vector3d search(const Percept& p);
  Eigen::Vector3d rise(const Percept& p);
  // In push: the speed of the hand across its way, which keeps the ball before it.
  Eigen::Vector3d balance(const Percept& p, const Eigen::Vector3d& way);
  // From hand to ball where they touch, in the plane of the floor, m.
  double reach_m() const;
  // Where the ball is by now: who sees reckons with his own slowness.
  Eigen::Vector3d expected_m();
  // The ball is seen to roll.
  bool rolls();
  const Goal& target() const { return rules_.goals[static_cast<std::size_t>(goal_)]; }
  Belief& ball() { return beliefs_[static_cast<std::size_t>(goal_)]; }
  // Unit vector from the ball to its hole, in the plane of the floor.
  Eigen::Vector3d way();
  // Where the hand stands to push, so far behind the touch of ball and hand.
  Eigen::Vector3d behind(double gap_m);
  Eigen::Vector3d towards(const Eigen::Vector3d& to, double speed_m_s) const;
  double height() const;

  bool sees() { return now_s_ - ball().since_s < kSeen_s && !only_felt_; }
  // Something holds the hand back: it has gone where it cannot, as over a wall or into a hole.
  bool held() const { return now_s_ - free_s_ > kHeld_s; }
  // Over the floor, as near as can be.
  Eigen::Vector3d over_floor(const Eigen::Vector3d& at) const;

  bool feels() const { return now_s_ - felt_s_ < kFeltLately_s; }

  // What was seen so lately is seen still: a few pictures.
  static constexpr double kSeen_s = 0.1;
  static constexpr double kFeltLately_s = 0.1;
  static constexpr double kHeld_s = 0.4;

  Rules rules_;
  PlayerDef def_;
  std::deque<Percept> seen_, felt_;  // not yet heeded, oldest first
  std::vector<Belief> beliefs_;
  Doing doing_ = Doing::kTravel;
  int goal_ = 0;
  double now_s_ = 0, dt_s_ = 0;
  double since_s_ = 0;                         // it has been doing that
  double felt_s_ = -1e9;                       // it last felt something
  double force_N_ = 0;                         // that it feels, in the plane of the floor
  Eigen::Vector3d pull_N_{0, 0, 0};            // that it feels
  double free_s_ = -1e9;                       // it last felt nothing that could hold it
  bool only_felt_ = false;                     // what it knows of its ball it knows by touch, or by ear
  Eigen::Vector3d felt_from_hand_m_{0, 0, 0};  // where the ball lies on the hand, as it is felt
  Eigen::Vector3d felt_at_m_{0, 0, 0}, felt_speed_m_s_{0, 0, 0};  // of the ball
  Eigen::Vector3d begun_m_{0, 0, 0};                              // where the hand was then
  double searched_m_ = 0;                                         // radius of the turn that it is at
  double turned_rad_ = 0;
  Eigen::Vector3d wanted_m_{0, 0, 0};
  bool begun_ = false;
};

}  // namespace tactus::participant
