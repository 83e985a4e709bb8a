#include "scripts/simulated_player/observer/responses.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scripts/simulated_player/observer/delayed_kalman.h"
#include "scripts/simulated_player/observer/hand.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::observer {
namespace {

constexpr double kResponseStep_s = 0.002, kResponse_s = 0.5, kPush_N = 2, kJump_m = 0.02, kResponseLook_s = 0.1;
constexpr double kExpectedPush_N = 1;  // design
constexpr double kFirstChange = 0.02;  // share of the peak

// Displacement of a relaxed arm by a steady push, m.
std::vector<double> displacement_m(const PlayerParameters& player, double force_N, int steps) {
  const double damping = 2 * player.damping_ratio * std::sqrt(player.stiffness_N_m * player.mass_kg);
  double place = 0, speed = 0;
  std::vector<double> places;
  for (int i = 0; i < steps; ++i) {
    places.push_back(place);
    speed += kResponseStep_s / player.mass_kg * (force_N - player.stiffness_N_m * place - damping * speed);
    place += kResponseStep_s * speed;
  }
  return places;
}

}  // namespace

double first_response_s(const PlayerParameters& player, Disturbance disturbance) {
  const int steps = static_cast<int>(kResponse_s / kResponseStep_s);
  const Hand hand(player, kResponseStep_s, 0);
  const HandPlant& plant = hand.plant();
  const Vector feedback = approach_feedback(player, std::numbers::ln2 / player.pace_s_bit, kResponseStep_s);
  HandModel model{.dt_s = kResponseStep_s,
                  .a = plant.a,
                  .b = plant.b,
                  .noise = Matrix::Identity(kHandStates, kHandStates) * 1e-12,
                  .control_share = hand.share(),
                  .control_sd = hand.constant_N(),
                  .speed_noise_m2_s = player.process_noise_m2_s};
  // The player expects pushes: forces of this size that change every 10 ms.
  const double push_m_s = kExpectedPush_N * kResponseStep_s / player.mass_kg * std::sqrt(0.01 / kResponseStep_s);
  model.noise(kSpeed, kSpeed) += push_m_s * push_m_s;
  DelayedKalman estimate(model, Vector::Zero(kHandStates), Matrix::Identity(kHandStates, kHandStates) * 1e-8);
  Vector place = Vector::Zero(kHandStates), x = place;
  place[kPlace] = 1;
  const bool push = disturbance == Disturbance::kPush;
  const auto pushed = displacement_m(player, push ? kPush_N : 0, steps);
  const double per_look = std::sqrt(kResponseLook_s / kResponseStep_s);
  const double felt_sd = per_look * player.proprioceptive_sd_m, seen_sd = per_look * seen_gap_sd_m(player, 0.6, 0);
  std::vector<double> places, forces;
  const auto before = [&](double latency_s) {
    return static_cast<int>(places.size()) - 1 - static_cast<int>(std::lround(latency_s / kResponseStep_s));
  };
  for (int t = 0; t < steps; ++t) {
    places.push_back(x[kPlace] + pushed[static_cast<std::size_t>(t)]);
    const int felt = before(player.touch_latency_s), seen = before(player.visual_latency_s);
    const double felt_m = felt < 0 ? 0 : places[static_cast<std::size_t>(felt)];
    // The picture jumps; the hand does not.
    const double seen_m = seen < 0 ? 0 : places[static_cast<std::size_t>(seen)] + (push ? 0 : kJump_m);
    estimate.measure(player.touch_latency_s, place, felt_m, felt_sd * felt_sd);
    estimate.measure(player.visual_latency_s, place, seen_m, seen_sd * seen_sd);
    // The muscles take over a load that the skin feels.
    const double load_N = felt >= 0 && push && kPush_N >= player.force_floor_N ? kPush_N : 0;
    const double u = -feedback.dot(estimate.mean()) - load_N;
    x = (plant.a * x + plant.b * u).eval();
    estimate.predict(u);
    forces.push_back(std::abs(x[kForce]));
  }
  const double threshold = kFirstChange * *std::max_element(forces.begin(), forces.end());
  const auto first = std::find_if(forces.begin(), forces.end(), [&](double f) { return f > threshold; });
  return static_cast<double>(first - forces.begin() + 1) * kResponseStep_s;
}

}  // namespace tactus::observer
