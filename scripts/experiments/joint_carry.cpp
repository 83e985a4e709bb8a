// Two people bring one object to a place: the task of Jay, Glencross and Hubbold 2007. Each sees and feels the own
// hand at once, and the hand of the partner late. The object is the middle between both hands, and a spring and
// damper connect the hands.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scripts/experiments/object_control.h"
#include "scripts/experiments/paradigms.h"
#include "scripts/simulated_player/observer/impedance_arm.h"
#include "scripts/simulated_player/observer/reaction.h"

namespace tactus::experiments {
namespace {

constexpr double kCarryStep_s = 0.001;
constexpr double kPartnerGap_m2_s = 4e-4;    // design: the partner is expected to move by 2 cm within a second
constexpr double kCouplingDamping_s = 0.02;  // damping over stiffness, design: 4 N s/m for 200 N/m

struct Carrier {
  ObjectControl control;
  observer::ImpedanceArm arm;
  double starts_s;
  std::vector<double> places, speeds;  // history of the hand, one for each step
  double command_N = 0;

  double before(const std::vector<double>& history, int steps) const {
    const int at = static_cast<int>(history.size()) - 1 - steps;
    return at < 0 ? history.front() : history[static_cast<std::size_t>(at)];
  }
};

Carrier carrier(const observer::PlayerParameters& player, const observer::Vector& feedback, double start_m,
                std::uint64_t seed) {
  observer::NoiseStream noise(seed, 9);
  return {ObjectControl(player, feedback, start_m, kPartnerGap_m2_s, seed),
          observer::ImpedanceArm(player, Eigen::Vector3d(start_m, 0, 0), seed),
          observer::simple_reaction_s(player, observer::Stimulus::kVision, noise),
          {},
          {}};
}

// One step of 1 ms of a person with the partner.
void act(Carrier& own, const Carrier& partner, int step, int visual_steps, int force_steps, double stiffness_N_m) {
  const double now_s = step * kCarryStep_s, place = own.places.back(), speed = own.speeds.back();
  const double force_N =
      stiffness_N_m * (partner.before(partner.places, force_steps) - place +
                       kCouplingDamping_s * (partner.before(partner.speeds, force_steps) - speed));
  if (step % 15 == 0) own.control.see(now_s, (place + partner.before(partner.places, visual_steps)) / 2);
  if (step % 10 == 0) {
    own.control.sense_hand(now_s, place);
    own.control.feel(now_s, force_N, 2 * stiffness_N_m);  // the object is half as far from the hand as the partner
  }
  if (step % 5 == 0) {
    const double u = own.control.command(now_s);
    own.command_N = now_s >= own.starts_s ? u : 0;
  }
  own.arm.step(Eigen::Vector3d(own.command_N, 0, 0), Eigen::Vector3d(force_N, 0, 0), kCarryStep_s);
}

}  // namespace

// Settings: visual_ms, force_ms: delays of the partner's picture and force; stiffness_N_m of the coupling;
// distance_m, width_m, hold_ms inside the target, limit_s. Answers time_s, and failed: 0 or 1.
Outcome joint_carry(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const int visual_steps = static_cast<int>(std::lround(s.number_or("visual_ms", 0, 0, 1000))),
            force_steps = static_cast<int>(std::lround(s.number_or("force_ms", 0, 0, 1000)));
  const double stiffness_N_m = s.number_or("stiffness_N_m", 200, 1, 5000),
               distance_m = s.number_or("distance_m", 0.2, 0.02, 1),
               width_m = s.number_or("width_m", 0.02, 1e-3, 0.5),
               hold_s = s.number_or("hold_ms", 300, 0, 5000) * 1e-3, limit_s = s.number_or("limit_s", 8, 1, 60);
  const std::uint64_t seed = p.trial_seed("joint_carry", number);
  const observer::PlayerParameters other = p.partner();
  const auto& own_feedback = p.prepared<observer::Vector>("carry own", [&] { return paced_feedback(p.player()); });
  const auto& other_feedback =
      p.prepared<observer::Vector>("carry partner", [&] { return paced_feedback(other); });
  std::array both{carrier(p.player(), own_feedback, -distance_m, sync::mixed(seed, 1)),
                  carrier(other, other_feedback, -distance_m, sync::mixed(seed, 2))};
  double inside_since_s = -1;
  const int steps = static_cast<int>(limit_s / kCarryStep_s);
  for (int i = 0; i < steps; ++i) {
    for (Carrier& one : both) {
      one.places.push_back(one.arm.position_m().x());
      one.speeds.push_back(one.arm.velocity_m_s().x());
    }
    const double now_s = i * kCarryStep_s, object_m = (both[0].places.back() + both[1].places.back()) / 2;
    if (std::abs(object_m) > width_m / 2)
      inside_since_s = -1;
    else if (inside_since_s < 0)
      inside_since_s = now_s;
    if (inside_since_s >= 0 && now_s - inside_since_s >= hold_s) return {{"time_s", now_s}, {"failed", 0}};
    if (!(std::abs(object_m) < 10)) break;  // the coupling is unstable
    act(both[0], both[1], i, visual_steps, force_steps, stiffness_N_m);
    act(both[1], both[0], i, visual_steps, force_steps, stiffness_N_m);
  }
  return {{"time_s", limit_s}, {"failed", 1}};
}

}  // namespace tactus::experiments
