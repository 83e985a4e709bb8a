// Judgements of the time of two events. Each event is presented at an instant, and its percept arrives one natural
// latency of the sense later. The participant subtracts its own belief about that latency. Whether two percepts
// are one event is decided by causal inference (observer/hearing.h).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scripts/experiments/paradigms.h"
#include "scripts/simulated_player/observer/cue_combination.h"
#include "scripts/simulated_player/observer/hearing.h"
#include "scripts/simulated_player/observer/percept_channel.h"

namespace tactus::experiments {
namespace {

using observer::Cue;
using observer::NoiseStream;

constexpr double kSmallestSd_s = 1e-6;  // so that a participant without noise has finite variances
constexpr double kMaxSoa_ms = 2000;

struct JudgedTime {
  double time_s = 0, sd_s = 0;
};

JudgedTime judged(double presented_s, double latency_s, double error_s, double sd_s, NoiseStream& noise) {
  const double sd = std::max(sd_s, kSmallestSd_s);
  observer::PerceptChannel channel(latency_s);
  channel.present(presented_s, Eigen::Vector3d::Zero(), sd);
  const auto percept = channel.take(std::numeric_limits<double>::max());
  return {percept->arrival_s - (latency_s + error_s) + noise.normal(sd), sd};
}

// sense: touch, sound, sight, or action, an own contact. The time of an own contact is felt, and also predicted
// from the sensed place of the hand, which approaches at speed_m_s; both cues combine by their reliability.
JudgedTime judged_event(const Participant& p, const std::string& sense, double at_s, double speed_m_s,
                        NoiseStream& noise) {
  const auto& player = p.player();
  const Timing& timing = p.timing();
  if (sense == "sight")
    return judged(at_s, player.visual_latency_s, player.initial_delay_error_s, timing.sight_sd_s, noise);
  if (sense == "sound")
    return judged(at_s, player.auditory_latency_s, timing.sound_error_s, timing.sound_sd_s, noise);
  const JudgedTime felt = judged(at_s, player.touch_latency_s, timing.touch_error_s, timing.touch_sd_s, noise);
  if (sense == "touch") return felt;
  const double sd = std::max(player.proprioceptive_sd_m / speed_m_s, kSmallestSd_s);
  const std::array cues{Cue{felt.time_s, felt.sd_s * felt.sd_s}, Cue{at_s + noise.normal(sd), sd * sd}};
  const Cue both = observer::combine(cues);
  if (!std::isfinite(both.variance)) return felt;
  return {both.value, std::sqrt(both.variance)};
}

struct PairOfEvents {
  double difference_s = 0, common = 0;  // time of the second less that of the first; probability of one cause
};

PairOfEvents perceive(const Participant& p, const std::string& first, const std::string& second, double soa_s,
                      double speed_m_s, NoiseStream& noise) {
  const JudgedTime a = judged_event(p, first, 0, speed_m_s, noise),
                   b = judged_event(p, second, soa_s, speed_m_s, noise);
  const double difference = b.time_s - a.time_s;
  return {difference, observer::same_event_probability(p.player(), difference, a.sd_s, b.sd_s)};
}

}  // namespace

// Settings: first, second; soa_ms, time of the second less that of the first; task: synchrony answers `together`,
// order answers `first_first`, two_interval answers `right` for an interval against one with reference_ms.
Outcome two_events(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const auto senses = {"touch", "sound", "sight", "action"};
  const std::string first = s.word("first", senses), second = s.word("second", senses),
                    task = s.word("task", {"synchrony", "order", "two_interval"});
  const double soa_s = s.number("soa_ms", -kMaxSoa_ms, kMaxSoa_ms) * 1e-3;
  const double reference_s = s.number_or("reference_ms", 0, -kMaxSoa_ms, kMaxSoa_ms) * 1e-3;
  const double speed_m_s = s.number_or("speed_m_s", 0.3, 0.01, 10);
  NoiseStream noise(p.trial_seed("two_events", number), 1), other(p.trial_seed("two_events", number), 2),
      choice(p.trial_seed("two_events", number), 3);
  const bool attended = choice.uniform() >= p.player().lapse, guess = choice.uniform() < 0.5;
  const PairOfEvents pair = perceive(p, first, second, soa_s, speed_m_s, noise);
  if (task == "synchrony") return {{"together", attended ? pair.common > 0.5 : guess}};
  if (task == "order")
    return {{"first_first", attended && pair.difference_s != 0 ? pair.difference_s > 0 : guess}};
  // The interval with the larger difference is the less probable single event: the senses and their noise are the
  // same in both.
  const PairOfEvents plain = perceive(p, first, second, reference_s, speed_m_s, other);
  const double here = std::abs(pair.difference_s), there = std::abs(plain.difference_s);
  return {{"right", attended && here != there ? here > there : guess}};
}

}  // namespace tactus::experiments
