// Checks of movement: 1 to 5 and 10 to 12.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scripts/simulated_player/observer/checks/checks.h"
#include "scripts/simulated_player/observer/checks/expected.h"
#include "scripts/simulated_player/observer/checks/line_fit.h"
#include "scripts/simulated_player/observer/pointing.h"
#include "scripts/simulated_player/observer/reach.h"
#include "scripts/simulated_player/observer/responses.h"
#include "sync/random/keyed_random.h"

namespace tactus::observer {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr const char* kMackenzie = "MacKenzie and Ware 1993, INTERCHI 488-493";

int scaled(int trials, const CheckEffort& effort) {
  return std::max(8, static_cast<int>(std::lround(trials * effort.share)));
}

struct Pointing {
  double time_s = 0;   // mean
  double errors = 0;   // share of selections outside the target, and of trials without one
  double in_time = 0;  // share of hits before the deadline
};

// Sessions of one condition: the belief about a delay differs between them by chance.
constexpr int kSessions = 4;
std::vector<PointingSession> sessions_of(const PlayerParameters& player, const PointingDef& def,
                                         std::uint64_t seed) {
  std::vector<PointingSession> sessions;
  for (std::uint64_t i = 0; i < kSessions; ++i) sessions.emplace_back(player, def, sync::mixed(seed, i));
  return sessions;
}

// Trials of one difficulty, in turn in each session.
Pointing point(std::vector<PointingSession>& sessions, double difficulty_bit, int trials,
               double deadline_s = kAny) {
  Pointing result;
  for (int i = 0; i < trials; ++i) {
    const PointingTrial t = sessions[static_cast<std::size_t>(i % kSessions)].trial(
        target_width_m(PointingDef{}.distance_m, difficulty_bit), static_cast<std::uint64_t>(i));
    result.time_s += t.time_s / trials;
    result.errors += !t.hit / static_cast<double>(trials);
    result.in_time += (t.hit && t.time_s <= deadline_s) / static_cast<double>(trials);
  }
  return result;
}

Pointing point(const PlayerParameters& player, const PointingDef& def, double difficulty_bit, int trials,
               std::uint64_t seed, double deadline_s = kAny) {
  auto sessions = sessions_of(player, def, seed);
  return point(sessions, difficulty_bit, trials, deadline_s);
}

}  // namespace

std::vector<CheckResult> check_pointing(const PlayerParameters& player, std::uint64_t seed,
                                        const CheckEffort& effort) {
  const int trials = scaled(240, effort);
  std::vector<double> slopes, means, errors;
  Line undelayed;
  for (double lag : kPointingDelays_s) {
    auto sessions = sessions_of(player, {.delay_s = lag}, seed);
    std::vector<double> times;
    double missed = 0;
    for (double difficulty : kDifficulties_bit) {
      const Pointing result = point(sessions, difficulty, trials);
      times.push_back(result.time_s);
      missed += result.errors / static_cast<double>(kDifficulties_bit.size());
    }
    const Line line = fit_line(kDifficulties_bit, times);
    if (lag == 0) undelayed = line;
    slopes.push_back(line.slope), errors.push_back(missed);
    means.push_back(line.intercept + 4 * line.slope);
  }
  // The bands of the typical player, moved by the law to this one; that of errors is one of multiples, 2 to 4.5.
  const ExpectedPointing own = expected_pointing(player), typical = expected_pointing({});
  const double faster = typical.slope_s_bit / own.slope_s_bit, growth = own.growth / typical.growth,
               longer = own.added_time / typical.added_time, worse = own.errors / typical.errors;
  using enum Evidence;
  return {{1, "throughput", "bit/s", 1 / undelayed.slope, 3.5 * faster, 6 * faster, "3.7-4.9 (mouse)",
           "Soukoreff and MacKenzie 2004, IJHCS 61:751", kSecondHand},
          {1, "R^2 of time against difficulty", "1", undelayed.r2, 0.9, 1, "above 0.9",
           "Fitts 1954; ISO 9241-9 studies", kSecondHand},
          {2, "growth of the slope with delay", "ms/(ms bit)", fit_line(kPointingDelays_s, slopes).slope,
           std::min(0.6 * growth, 1.4 * growth), std::max(0.6 * growth, 1.4 * growth), "1.03 (unverified)", kMackenzie, kUnverified},
          {3, "added time at 225 ms", "%", 100 * (means.back() / means.front() - 1), 40 * longer, 90 * longer, "64",
           kMackenzie, kVerified},
          {3, "added errors at 225 ms", "%", 100 * (errors.back() / errors.front() - 1),
           100 * (2 * worse - 1), 100 * (4.5 * worse - 1), "214", kMackenzie, kVerified}};
}

std::vector<CheckResult> check_responses(const PlayerParameters& player) {
  const char* source = "Cluff, Crevecoeur and Scott 2015, Vision Research 110:215";
  // The published bands in ms, moved by the difference of the player's latency and muscle from the typical ones.
  const auto response = [&](Disturbance disturbance, const char* quantity, double low_ms, double high_ms,
                            const char* published) -> CheckResult {
    const double moved_ms = 1e3 * (expected_response_s(player, disturbance) - expected_response_s({}, disturbance));
    return {4, quantity, "ms", 1e3 * first_response_s(player, disturbance), low_ms + moved_ms, high_ms + moved_ms,
            published, source, Evidence::kVerified};
  };
  return {response(Disturbance::kPush, "response to a push", 50, 90, "about 60 (muscle activity)"),
          response(Disturbance::kJump, "response to a jump of the picture", 100, 170, "about 100 (muscle activity)")};
}

std::vector<CheckResult> check_reach(const PlayerParameters& player, std::uint64_t seed,
                                     const CheckEffort& effort) {
  const ReachResult r = reach(player, 0.1, 0.5, scaled(600, effort), seed);
  const double wider = expected_scatter_ratio(player);
  return {{5, "scatter of the end of a reach, 10 cm in 0.5 s", "mm", 1e3 * r.sd_m, 3 * wider, 8 * wider,
           "5.4 (model of Todorov 2005)", "Todorov 2005, Neural Computation 17:1084", Evidence::kVerified}};
}

std::vector<CheckResult> check_jitter(const PlayerParameters& player, std::uint64_t seed,
                                      const CheckEffort& effort) {
  const int trials = scaled(240, effort);
  const auto time_s = [&](double delay_s, double jitter_s) {
    double sum = 0;
    for (double difficulty : {3, 4, 5})
      sum += point(player, {.delay_s = delay_s, .jitter_s = jitter_s}, difficulty, trials, seed).time_s;
    return sum;
  };
  const double steady = time_s(0.067, 0), jitter = time_s(0.067, 0.067), later = time_s(0.134, 0);
  const char* source = "Beech, Stanton Fraser and Gilchrist 2024, ACM TAP, doi 10.1145/3701984";
  return {{10, "added time of 67 ms of jitter", "%", 100 * (jitter / steady - 1), -10, 10, "first effect at 67 ms",
           source, Evidence::kSecondHand},
          {10, "added time of 67 ms of delay, less that of jitter", "%", 100 * (later - jitter) / steady, 0, kAny,
           "above 0", source, Evidence::kSecondHand}};
}

std::vector<CheckResult> check_reckoning(const PlayerParameters& player, std::uint64_t seed,
                                         const CheckEffort& effort) {
  const int trials = scaled(120, effort);
  constexpr double kDifficulty_bit = 4, kStep_s = 0.05, kMost_s = 0.6;
  const double deadline_s = 1.5 * point(player, {}, kDifficulty_bit, trials, seed).time_s;
  const auto share = [&](double delay_s, bool reckoning) {
    return point(player, {.delay_s = delay_s, .reckoning = reckoning}, kDifficulty_bit, trials, seed, deadline_s)
        .in_time;
  };
  // Delay at which half of the targets are hit in time, linear between two levels.
  const auto limit_s = [&](bool reckoning) {
    double before = share(0, reckoning);
    if (before < 0.5) return 0.0;
    for (double delay = kStep_s; delay < kMost_s; delay += kStep_s) {
      const double now = share(delay, reckoning);
      if (now < 0.5) return delay - kStep_s * (0.5 - now) / (before - now);
      before = now;
    }
    return kMost_s;
  };
  return {{11, "fall of the limit without reckoning by the believed delay", "ms",
           1e3 * (limit_s(true) - limit_s(false)), 1, kAny, "above 0", "property of the model",
           Evidence::kDesign}};
}

std::vector<CheckResult> check_removed_sense(const PlayerParameters& player, std::uint64_t seed,
                                             const CheckEffort& effort) {
  const int trials = scaled(100, effort);
  double largest = 0;
  for (double difficulty : {1, 2, 3}) {
    const Pointing never = point(player, {.delay_s = kAny}, difficulty, trials, seed);
    const Pointing off = point(player, {.vision = false}, difficulty, trials, seed);
    largest = std::max(largest, std::abs(never.errors - off.errors));
  }
  return {{12, "difference of errors between an endless delay and no picture", "1", largest, 0, 0, "0",
           "property of the model", Evidence::kDesign}};
}

}  // namespace tactus::observer
