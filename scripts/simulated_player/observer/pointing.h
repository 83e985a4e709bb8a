// A player that points at targets along one line, with a picture of its hand that may be late: the task of
// MacKenzie and Ware 1993, "Lag as a determinant of human performance in interactive systems", INTERCHI 488-493.
// Pure.
//
// The hand is driven by optimal feedback (hand.h) from an estimate (delayed_kalman.h) of pictures and
// proprioception, each applied at its believed age (delay_belief.h). The player does three things that no formula
// of movement times contains:
//   pace      A mismatch of the believed delay is noticed as a miss. A loop with the unknown delay r is critically
//   damped at the rate
//             1/(e r), so the time constant of the approach grows with |r|.
//   stopping  It selects the target when its estimate is inside, with at least half of the certainty of a hand at
//             rest, and waiting would cost more time than the errors that it avoids.
//   waiting   Above the player's threshold of believed delay it moves, waits for the picture, and moves again.
#pragma once

#include <cstdint>

#include "scripts/simulated_player/observer/delay_belief.h"
#include "scripts/simulated_player/observer/hand.h"
#include "scripts/simulated_player/observer/percept_channel.h"

namespace tactus::observer {

struct PointingDef {
  double delay_s = 0;     // added to the picture; infinite: there is no picture
  double jitter_s = 0;    // half range of a uniform added delay for each frame; not larger than delay_s
  bool vision = true;     // false: the player does not look at the picture
  bool reckoning = true;  // false: the player takes each picture as current
  double distance_m = 0.2;
  double limit_s = 8;  // a trial without a selection ends here
  int exposure = 200;  // actions whose effect the player observed before the first trial
};

struct PointingTrial {
  double time_s = 0;      // from the start of the movement to the selection
  bool selected = false;  // before the limit
  bool hit = false;       // inside the target at the selection
};

// Width of the target for this index of difficulty, log2(D/W + 1).
double target_width_m(double distance_m, double difficulty_bit);

// Time that a player gives to avoid an error, s: the cost of an error (design), times the player's caution.
double error_cost_s(const PlayerParameters& player);
// The player compares selecting now with selecting this much later (design).
inline constexpr double kConsidered_s = 0.05;
// Probability that a hand at this place, known with this standard deviation, is outside a target of this width.
double miss_probability(double place_m, double sd_m, double width_m);

// Standard deviation of the believed place of a hand that rests at its target, when the picture is believed to have
// this age, m.
double settled_sd_m(const PlayerParameters& player, double believed_age_s);

class PointingSession {
 public:
  PointingSession(const PlayerParameters& player, const PointingDef& def, std::uint64_t seed);

  // One movement to a target of this width. Equal indices and seeds give equal noise, for all delays.
  PointingTrial trial(double width_m, std::uint64_t index);
  // Preferred rate of approach in this session, 1/s.
  double rate_1_s() const { return rate_1_s_; }
  const DelayBelief& belief() const { return belief_; }

 private:
  friend class PointingMovement;
  PlayerParameters player_;
  PointingDef def_;
  std::uint64_t seed_;
  DelayBelief belief_;
  double rate_1_s_ = 1;
  double settled_m_ = 0;  // scatter of the believed place at rest
  Vector feedback_;
  bool waits_ = false;
};

}  // namespace tactus::observer
