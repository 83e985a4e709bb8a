#include "tests/bench/cluster/freeze_trial.h"

#include <algorithm>
#include <cmath>

namespace tactus::bench {
namespace {

using namespace std::chrono_literals;
using sync::HostTime;

constexpr double kNeutral_degC = 33;  // thermal_node.skin_rest
constexpr double kZero_N = 1e-6;
constexpr double kFade_s = 0.02, kTick_s = 1e-3;
constexpr double kFelt_N = 0.3;
// Design: the longest wait of a part for its peer, 0.3 s (a successor of a sender), and a lift of the hand, 0.1 s.
constexpr sync::Nanoseconds kReturn = 800ms;
// THERMAL_STATE returns at 20 K/s or faster. A plate is slower at its end: a first-order element with a limited current.
constexpr double kCommandReturn_K_s = 20, kPlateReturn_K_s = 5, kPlateRest_K = 0.5, kCommandRest_K = 0.05;
constexpr sync::Nanoseconds kScrapeEnds = 200ms;  // contacts count for 0.1 s, and sound 20 ms and a fade later

HostTime after(HostTime t, double seconds) { return t + sync::from_seconds(seconds); }

void add_fault(FailureResult& result, const FailingPart& part, const FailureTime& at, const std::string& what) {
  result.faults.push_back(std::string(part.name) + " at " + std::to_string(sync::to_seconds(at.begin - sync::VirtualTime::kBegin)) + " s for " +
                          std::to_string(sync::to_seconds(at.end - at.begin)) + " s: " + what);
}

// The largest distance of the values from neutral beyond a return at rate_K_s that begins with the first of them.
double beyond_return_K(std::span<const TimedValue> values, double rate_K_s, double rest_K) {
  double beyond = 0;
  for (const TimedValue& v : values) {
    const double start_K = std::abs(values.front().value - kNeutral_degC);
    const double allowed_K = std::max(rest_K, start_K - rate_K_s * sync::to_seconds(v.time - values.front().time));
    beyond = std::max(beyond, std::abs(v.value - kNeutral_degC) - allowed_K);
  }
  return beyond;
}

void judge_force(const FailingPart& part, const FailureTime& at, const ClusterRecord& record, FailureResult& result) {
  double remaining_N = 0;
  if (part.command_s >= 0) remaining_N = largest(record.commanded_N(), after(at.begin, part.command_s), at.end);
  if (part.exerted_s >= 0) remaining_N = std::max(remaining_N, largest(record.exerted_N(), after(at.begin, part.exerted_s), at.end));
  result.remaining_N = std::max(result.remaining_N, remaining_N);
  if (remaining_N > kZero_N) add_fault(result, part, at, std::to_string(remaining_N) + " N remain");

  const double least_s = std::max(part.command_s, part.exerted_s);
  if (least_s < 0 || at.end - at.begin <= sync::from_seconds(least_s)) return;
  double beyond_N = 0;
  const SafeLimits limits;
  for (const TimedValue& v : between(record.exerted_N(), at.end, after(at.end, kFade_s)))
    beyond_N = std::max(beyond_N, v.value - limits.force_N * (sync::to_seconds(v.time - at.end) + kTick_s) / kFade_s);
  result.beyond_fade_N = std::max(result.beyond_fade_N, beyond_N);
  if (beyond_N > kZero_N) add_fault(result, part, at, "the force returns faster than its fade, by " + std::to_string(beyond_N) + " N");
}

void judge_return(const FailingPart& part, const FailureTime& at, const ClusterRecord& record, FailureResult& result) {
  const auto values = between(record.exerted_N(), at.end, at.end + kReturn);
  const auto felt = std::find_if(values.begin(), values.end(), [](const TimedValue& v) { return v.value > kFelt_N; });
  if (felt == values.end()) return add_fault(result, part, at, "the force does not return");
  result.longest_return_s = std::max(result.longest_return_s, sync::to_seconds(felt->time - at.end));
}

void judge_heat(const FailingPart& part, const FailureTime& at, const ClusterRecord& record, FailureResult& result) {
  const auto check = [&](double from_s, const Series& series, double rate_K_s, double rest_K, const char* what) {
    if (from_s < 0) return;
    const double beyond_K = beyond_return_K(between(series, after(at.begin, from_s), at.end), rate_K_s, rest_K);
    result.from_neutral_K = std::max(result.from_neutral_K, beyond_K);
    if (beyond_K > 0.01) add_fault(result, part, at, std::string(what) + " is " + std::to_string(beyond_K) + " K behind its return to neutral");
  };
  check(part.neutral_s, record.command_degC(), kCommandReturn_K_s, kCommandRest_K, "the command");
  check(part.plate_s, record.plate_degC(), kPlateReturn_K_s, kPlateRest_K, "the plate");
}

// Largest sample, and largest step between two samples of a channel, in a span of the sound.
struct Loudness {
  double peak = 0, step = 0;
};
Loudness loudness(const Sound& sound, double from_s, double to_s) {
  const auto channels = static_cast<std::size_t>(sound.channels);
  const auto frame = [&](double s) { return std::min(sound.frames(), static_cast<std::size_t>(std::max(0.0, s) * sound.rate_Hz)); };
  Loudness out;
  for (std::size_t n = std::max<std::size_t>(1, frame(from_s)); n < frame(to_s); ++n)
    for (std::size_t c = 0; c < channels; ++c) {
      const double x = double{sound.samples[n * channels + c]}, before = double{sound.samples[(n - 1) * channels + c]};
      out.peak = std::max(out.peak, std::abs(x));
      out.step = std::max(out.step, std::abs(x - before));
    }
  return out;
}

}  // namespace

void judge(const FailingPart& part, const FailureTime& at, const ClusterRecord& record, FailureResult& result) {
  ++result.failures;
  result.longest_s = std::max(result.longest_s, sync::to_seconds(at.end - at.begin));
  judge_force(part, at, record, result);
  judge_return(part, at, record, result);
  judge_heat(part, at, record, result);
  if (!at.gaps.empty()) add_fault(result, part, at, at.gaps);
}

void judge_sound(const FailureTime& at, const ClusterRecord& record, const Sound& sound, FailureResult& result) {
  if (at.end - at.begin <= kScrapeEnds + 50ms) return;
  const auto s = [&](HostTime t) { return sync::to_seconds(t - record.sound_start()); };
  // Bodies ring down: neither a peak nor a step between samples exceeds those of the time in which contacts still sounded.
  const Loudness before = loudness(sound, s(at.begin) - 0.3, s(at.begin + kScrapeEnds));
  const Loudness during = loudness(sound, s(at.begin + kScrapeEnds), s(at.end));
  constexpr double kNoise = 1e-4;  // -80 dB of full scale, inaudible beside the sounds of contacts
  const double louder = std::max(during.peak - before.peak, during.step - before.step);
  result.louder = std::max(result.louder, louder);
  if (louder > kNoise) result.faults.push_back("sound grows by " + std::to_string(louder) + " while its input is lost");
}

}  // namespace tactus::bench
