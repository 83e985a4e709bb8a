// Does the channel between hand and bodies make energy of its own? An observer and a controller of passivity with
// two ports and a delay between them (Hannaford and Ryu 2002; Ryu, Artigas and Preusche 2010).
//
// Port of the device: force on the hand times its motion, known at once. Port of the bodies: the work that the
// simulation did on them (touch_applied_t), known as late as the touch model. What they were given since is
// estimated (unseen_work.h). So a fan, a falling ball or a swing given back pays for what the hand gets, at the
// latest when it tells.
//
//   credit = what the hand and the bodies gave, less what they were given; below zero: generated
//
// The springs of the coupling may never hold more than the credit and a small allowance. Then, whatever hand and
// bodies do next, they get no more than the allowance that nobody gave. Where they would hold more, the coupling
// is lowered at once by the factor that makes up for it, and comes back slowly. A passive coupling holds less than
// the credit, so without a disturbance the factor is 1.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>
#include <tactus/touch_applied_t.hpp>

#include "haptic_node/contact/contact_impulses.h"
#include "haptic_node/contact/surfaces.h"
#include "haptic_node/safety/pending_energy.h"

namespace tactus::haptic {

struct PassivityLimits {
  double allowance_J = 0.0005;
  double force_N = 8;     // no force on a body is larger
  double speed_m_s = 10;  // no body is faster
};

// What the springs of the coupling to bodies that move hold at their full stiffness.
struct Stored {
  double energy_J = 0;
  bool pressed = false;  // any of them
};

class Passivity {
 public:
  explicit Passivity(const PassivityLimits& limits) : limits_(limits) {
    books_.reserve(ContactImpulses::kMaxContacts);
  }

  void change(const PassivityLimits& limits) { limits_ = limits; }

  // What the simulation did and how the bodies move, from a touch model that has just arrived. Numbers that are
  // not finite are ignored.
  void hear(const TouchModelView& fresh);
  // One tick, once the coupling knows how far it is stretched. moved_m, turned_rad: how far the device moved and
  // turned under the forces that were noted last; age_s: of the touch model in use. Realtime-safe: yes.
  void observe(const Stored& coupling, const Eigen::Vector3d& moved_m, const Eigen::Vector3d& turned_rad,
               double age_s, double dt);
  // The forces on the hand that act from now on, of these surfaces. about_m: the point about which their torque is
  // felt; null: it is not. Realtime-safe: yes.
  void note(std::span<const FeltForce> forces, std::span<const Surface> surfaces,
            const Eigen::Vector3d* about_m = nullptr);

  // Factor on the stiffness of the coupling to what moves, 0 .. 1.
  double factor() const { return factor_; }
  // Energy that the channel has made since the episode of contact began, J; not below zero, nor beyond what goes
  // on the bus, whatever the simulation tells.
  double generated_J() const { return std::clamp(-credit_J_, 0.0, kMaxTold_J); }

 private:
  void hear(const touch_applied_t& book, const TouchModelView& fresh);
  static constexpr double kMaxTold_J = 1e6;
  struct Book {
    std::int64_t contact_id = 0;
    Eigen::Vector3d force_N = Eigen::Vector3d::Zero();     // on the body, now
    Eigen::Vector3d torque_N_m = Eigen::Vector3d::Zero();  // the opposite of what is felt of it
    PendingEnergyEstimator unseen;
    double energy_J = 0, before_J = 0;  // told; of that before the episode or its first mention
    double idle_s = 0;                  // without a force
    bool told = false;
  };
  Book* find(std::int64_t contact_id);
  Book& add(std::int64_t contact_id);
  void forget_the_idle();
  void begin_episode();

  PassivityLimits limits_;
  std::vector<Book> books_;
  double hand_J_ = 0;     // given to the hand in this episode
  double settled_J_ = 0;  // given to bodies in this episode whose books are closed
  double wasted_J_ = 0;   // credit beyond what is kept, less what the allowance was filled up by
  double credit_J_ = 0;
  double factor_ = 1;
  double apart_s_ = 0;  // since anything was pressed
};

}  // namespace tactus::haptic
