#include "scripts/simulated_player/observer/reaction.h"

#include <algorithm>
#include <cmath>

namespace tactus::observer {
namespace {

constexpr double kDecision_s = 0.023, kDecisionSd_s = 0.020, kDecisionTail_s = 0.030;
constexpr double kChoice_s_bit = 0.150;

}  // namespace

double latency_s(const PlayerParameters& player, Stimulus stimulus) {
  switch (stimulus) {
    case Stimulus::kVision: return player.visual_latency_s;
    case Stimulus::kTouch: return player.touch_latency_s;
    case Stimulus::kHearing: return player.auditory_latency_s;
    case Stimulus::kCold: return player.cold_latency_s;
    case Stimulus::kWarmth: return player.warm_latency_s;
  }
  return player.visual_latency_s;
}

double simple_reaction_s(const PlayerParameters& player, Stimulus stimulus, NoiseStream& noise) {
  const double decision = kDecision_s + noise.normal(kDecisionSd_s) + noise.exponential(kDecisionTail_s);
  return latency_s(player, stimulus) + player.muscle_s + std::max(0.0, decision);
}

double mean_reaction_s(const PlayerParameters& player, Stimulus stimulus) {
  return latency_s(player, stimulus) + player.muscle_s + kDecision_s + kDecisionTail_s;
}

double choice_time_s(int choices) { return kChoice_s_bit * std::log2(std::max(1, choices)); }

}  // namespace tactus::observer
