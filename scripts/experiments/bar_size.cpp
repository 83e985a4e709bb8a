// The height of a bar that is seen, felt between two fingers, or both: Ernst and Banks 2002.
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "scripts/experiments/paradigms.h"
#include "scripts/simulated_player/observer/cue_combination.h"
#include "scripts/simulated_player/observer/touch.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::experiments {
namespace {

constexpr double kBarViewing_m = 0.6;

double perceived_mm(const std::string& cues, double seen_mm, double seen_sd_mm, double felt_mm, double felt_sd_mm,
                    observer::NoiseStream& noise) {
  const observer::Cue sight{seen_mm + noise.normal(seen_sd_mm), seen_sd_mm * seen_sd_mm},
      touch{felt_mm + noise.normal(felt_sd_mm), felt_sd_mm * felt_sd_mm};
  if (cues == "sight") return sight.value;
  if (cues == "touch") return touch.value;
  if (seen_sd_mm == 0 && felt_sd_mm == 0) return (sight.value + touch.value) / 2;
  if (seen_sd_mm == 0 || felt_sd_mm == 0) return seen_sd_mm == 0 ? sight.value : touch.value;
  return observer::combine(std::array{sight, touch}).value;
}

}  // namespace

// Settings: cues: sight, touch or both; standard_mm, comparison_mm; conflict_mm: the seen standard is larger than
// the felt one by this; noise_mm: scatter that the display adds to a seen height. Answers `larger`: the
// comparison.
Outcome bar_size(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const std::string cues = s.word("cues", {"both", "sight", "touch"});
  const double standard = s.number_or("standard_mm", 55, 1, 500), comparison = s.number("comparison_mm", 1, 500),
               conflict = s.number_or("conflict_mm", 0, -50, 50), display_mm = s.number_or("noise_mm", 0, 0, 1e6);
  // Both edges of the bar are seen.
  const double edge_mm = 1e3 * observer::seen_sd_m(p.player(), kBarViewing_m, 0),
               seen_sd = std::hypot(std::numbers::sqrt2 * edge_mm, display_mm),
               felt_sd = 1e3 * observer::felt_size_sd_m(p.player());
  observer::NoiseStream noise(p.trial_seed("bar_size", number), 1);
  const bool attended = noise.uniform() >= p.player().lapse, guess = noise.uniform() < 0.5;
  const double first =
                   perceived_mm(cues, standard + conflict / 2, seen_sd, standard - conflict / 2, felt_sd, noise),
               second = perceived_mm(cues, comparison, seen_sd, comparison, felt_sd, noise);
  return {{"larger", attended && first != second ? second > first : guess}};
}

}  // namespace tactus::experiments
