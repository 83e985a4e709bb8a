#include "haptic_node/safety/energy_account.h"

namespace tactus::haptic {
namespace {

// Dissipated energy counts as credit up to this value, so that old friction does not pay for a new oscillation.
constexpr double kMaxLoopCredit_J = 0.01;
// Refill of the allowance: after a violation, touch recovers within seconds. In one episode the fast refill ends at
// 0.4 mJ, so that an episode of ten seconds generates at most 1 mJ; the slow one is a third of a millijoule in half a
// minute.
constexpr double kRefill_W = 0.0002, kMaxRefill_J = 0.0004, kSlowRefill_W = 0.00001;
// The factor falls to zero within 5 ms at 1 kHz, which keeps a force of 8 N below the slew limit. It recovers
// within a second, slower than any oscillation of hand or body, so that it drives no cycle itself.
constexpr double kFall_1_s = 200, kRise_1_s = 1;

}  // namespace

void EnergyAccount::settle(double stored_J, double bodies_J, double generated_W, double allowance_J, double dt) {
  balance_J_ = -hand_J_ - bodies_J;
  credit_J_ = balance_J_ - discarded_J_;
  if (credit_J_ < stored_J) {
    const double refill_J = (refilled_J_ < kMaxRefill_J ? kRefill_W : kSlowRefill_W) * dt;
    discarded_J_ -= refill_J;
    refilled_J_ += refill_J;
  }
  const double excess_J = std::max(0.0, credit_J_ - stored_J - kMaxLoopCredit_J);
  discarded_J_ += excess_J;
  credit_J_ -= excess_J;
  const double allowed_J = std::max(0.0, credit_J_ + allowance_J);
  double wanted = 1;
  if (stored_J > allowed_J) {
    // Energy generated while the factor moves to `wanted`: half of the energy at the current force.
    const double falling_J = 0.5 / kFall_1_s * std::max(0.0, generated_W);
    wanted = stored_J > falling_J ? std::max(0.0, allowed_J - factor_ * falling_J) / (stored_J - falling_J) : 0.0;
  }
  factor_ = std::clamp(wanted, std::max(0.0, factor_ - kFall_1_s * dt), std::min(1.0, factor_ + kRise_1_s * dt));
}

}  // namespace tactus::haptic
