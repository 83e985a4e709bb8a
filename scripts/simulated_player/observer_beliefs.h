// All beliefs of the observer player: its hand, the balls, and the delay of each sense. Percepts are applied at their believed
// age; pairs of an own action and its effect change the believed ages. Pure.
#pragma once

#include <deque>
#include <functional>
#include <vector>

#include "scripts/simulated_player/believed_ball.h"
#include "scripts/simulated_player/believed_hand.h"
#include "scripts/simulated_player/observer/delay_belief.h"
#include "scripts/simulated_player/observer/hand.h"
#include "scripts/simulated_player/observer_senses.h"

namespace tactus::simulated_player {

// Area of ball `goal`, px, that an eye would see if the ball lay at this place.
using VisibleArea = std::function<double(std::size_t goal, const Eigen::Vector3d& at_m)>;

class ObserverBeliefs {
 public:
  ObserverBeliefs(const observer::PlayerParameters& player, const Rules& rules, const Viewer& viewer, VisibleArea visible_area,
                  const Eigen::Vector3d& hand_m, std::uint64_t seed);

  // Pairs of action and effect before the game, with pictures and sounds that come this late in addition to the natural latency.
  void practise(int pairs, double pictures_s, double sounds_s, double touch_s);
  // All percepts that have arrived. goal: of the attention; feels_ball: touch may belong to that ball.
  void perceive(double now_s, ObserverSenses& senses, int goal, bool feels_ball);
  // One step of kSampleStep_s with this command. goal: the ball that the hand may push.
  void predict(double now_s, const Eigen::Vector3d& command_N, int goal);

  BelievedHand& hand() { return hand_; }
  BelievedBall& ball(int goal) { return balls_[static_cast<std::size_t>(goal)]; }
  const observer::DelayBelief& sight_delay() const { return sight_delay_; }
  const observer::DelayBelief& touch_delay() const { return touch_delay_; }
  const observer::DelayBelief& sound_delay() const { return sound_delay_; }
  bool feels_contact() const { return now_s_ - contact_s_ < kContactValid_s; }
  const Eigen::Vector3d& force_N() const { return force_N_; }  // newest percept
  double last_free_s() const { return last_free_s_; }          // when it last felt less than kHeldForce_N
  // Distance from hand to ball at contact in the plane of the floor, for a hand at the height of a push, m.
  double contact_distance_m(int goal) const;
  double push_height_m(int goal) const;
  bool sees(int goal) const;

  static constexpr double kHeldForce_N = 4;       // design: things that can be pushed do not resist this long
  static constexpr double kContactValid_s = 0.1;  // design

 private:
  void apply(const SightPercept& sight, double arrival_s, int goal);
  void apply_ball(const SightPercept::Ball& seen, double age_s, int goal);
  void apply(const ForcePercept& touch, double arrival_s, int goal, bool feels_ball);
  void apply(const SoundPercept& sound, double arrival_s, int goal);
  void match_seen_hand(double arrival_s);
  Eigen::Vector3d expected_acceleration_m_s2(int goal);
  Eigen::Vector3d possible_push_m_s2(int goal);

  struct TimedPlace {
    double time_s;
    Eigen::Vector3d at_m;
    double sd_m = 0;
  };
  observer::PlayerParameters player_;
  Rules rules_;
  Viewer viewer_;
  VisibleArea visible_area_;
  BelievedHand hand_;
  std::vector<BelievedBall> balls_;
  observer::DelayBelief sight_delay_, touch_delay_, sound_delay_;
  observer::NoiseStream judgement_;
  std::deque<TimedPlace> meant_, shown_;  // of the hand: by its commands, and as seen, by time of arrival
  observer::HandPlant plant_;
  Eigen::Matrix<double, 4, 3> commanded_ = Eigen::Matrix<double, 4, 3>::Zero();  // the hand by its commands, one column an axis
  double now_s_ = 0, next_match_s_ = 0;
  double contact_s_ = -1e9, touching_s_ = -1e9, last_free_s_ = 0;  // felt contact; believed begin of contact; no large force
  double gap_m_ = 1;
  Eigen::Vector3d force_N_{0, 0, 0};
  long frames_ = 0;
};

}  // namespace tactus::simulated_player
