// The energy of contact with movable bodies in an episode, and the factor on their coupling that keeps it passive
// (passivity.h). Pure.
#pragma once

#include <algorithm>

namespace tactus::haptic {

// Energy in the springs of the coupling to movable bodies or to walls, at full stiffness.
struct StoredEnergy {
  double energy_J = 0;
  bool pressed = false;  // true when any of them is pressed
  double appeared_J = 0;  // part of the energy that surfaces brought when they appeared above the hand
};

class EnergyAccount {
 public:
  // Longer than any delay of a touch model before it counts as lost, so that the last reports have arrived.
  static constexpr double kEpisodeGap_s = 0.2;

  // Adds energy that the hand has received.
  void give_hand(double energy_J) { hand_J_ += energy_J; }
  // One tick. True when no surface has been pressed for kEpisodeGap_s: the caller then begins an episode.
  bool apart(bool pressed, double dt) {
    no_contact_s_ = pressed ? 0 : no_contact_s_ + dt;
    return no_contact_s_ > kEpisodeGap_s;
  }
  void begin_episode() { hand_J_ = discarded_J_ = refilled_J_ = balance_J_ = credit_J_ = 0; }
  // After apart(): sets the factor. stored_J: in the springs, at full stiffness; bodies_J: energy given to the bodies
  // in this episode; generated_W: power that the current forces generate. Realtime-safe: yes.
  void settle(double stored_J, double bodies_J, double generated_W, double allowance_J, double dt);

  double factor() const { return factor_; }
  // Energy that hand and bodies have received minus the energy that they gave in this episode, J; below zero: they gave
  // more.
  double generated_J() const { return -balance_J_; }

 private:
  double hand_J_ = 0;       // given to the hand in this episode
  double discarded_J_ = 0;  // credit beyond the maximum, minus the refill of the allowance
  double refilled_J_ = 0;
  double balance_J_ = 0, credit_J_ = 0;  // without and with the discarded energy
  double factor_ = 1;
  double no_contact_s_ = 0;  // time since the last contact
};

}  // namespace tactus::haptic
