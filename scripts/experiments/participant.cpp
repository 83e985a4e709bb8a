#include "scripts/experiments/participant.h"

#include "sync/random/keyed_random.h"

namespace tactus::experiments {
namespace {

constexpr std::uint64_t kTimingStream = 71, kTrialsStream = 72;
constexpr std::uint32_t kPartnerOffset = 4096;  // partners are players beyond the participants of any experiment

}  // namespace

const std::vector<TimingRange>& timing_ranges() {
  using enum observer::Evidence;
  using enum observer::Spread;
  using enum observer::Group;
  const char* order =
      "Yamamoto and Kitazawa 2015, Scholarpedia, tactile temporal order: 75 % right at 20-60 ms, which is 0.9539 "
      "of "
      "the standard deviation of one event";
  static const std::vector<TimingRange> ranges{
      {{"onset noise of touch", 26, nullptr, "ms", 1e-3, 21, 36, 63, kLogNormal, kNone, kVerified, order},
       &Timing::touch_sd_s},
      {{"onset noise of sight", 27, nullptr, "ms", 1e-3, 15, 21, 30, kLogNormal, kNone, kUnverified,
        "Hirsh and Sherrick 1961, Journal of Experimental Psychology 62:423: order of two senses 75 % right at "
        "20 ms; range: design"},
       &Timing::sight_sd_s},
      {{"onset noise of hearing", 28, nullptr, "ms", 1e-3, 3, 5, 10, kLogNormal, kNone, kUnverified,
        "gaps of 2-3 ms are heard"},
       &Timing::sound_sd_s},
      {{"error of the believed latency of touch", 29, nullptr, "ms", 1e-3, -32.9, 0, 32.9, kNormal, kNone, kDesign,
        "normal, standard deviation 20 ms"},
       &Timing::touch_error_s},
      {{"error of the believed latency of hearing", 30, nullptr, "ms", 1e-3, -32.9, 0, 32.9, kNormal, kNone,
        kDesign, "normal, standard deviation 20 ms"},
       &Timing::sound_error_s}};
  return ranges;
}

Participant::Participant(std::uint32_t index, std::uint64_t seed)
    : index_(index), seed_(sync::mixed(seed, index)), player_(observer::player_of(index, seed)) {
  population_seed_ = seed;
  const std::uint64_t key = sync::mixed(seed_, kTimingStream);
  for (std::size_t i = 0; i < timing_ranges().size(); ++i)
    timing_.*timing_ranges()[i].field = observer::value_at(timing_ranges()[i].range, sync::uniform(key, i));
}

Participant::Participant(const observer::PlayerParameters& player, const Timing& timing, std::uint64_t seed)
    : seed_(seed), population_seed_(seed), player_(player), timing_(timing) {}

observer::PlayerParameters Participant::partner() const {
  return observer::player_of(index_ + kPartnerOffset, population_seed_);
}

std::uint64_t Participant::trial_seed(const std::string& paradigm, std::uint64_t number) const {
  std::uint64_t seed = sync::mixed(seed_, kTrialsStream);
  for (const char c : paradigm) seed = sync::mixed(seed, static_cast<unsigned char>(c));
  return sync::mixed(seed, number);
}

}  // namespace tactus::experiments
