// A simulated participant of a published experiment: a player of the population, with the noise of its judgements
// of time. Pure.
#pragma once

#include <any>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scripts/simulated_player/observer/parameters.h"
#include "scripts/simulated_player/observer/population.h"

namespace tactus::experiments {

// Judgements of the time of one event. Standard deviations and errors in s. An error is the believed minus the
// true natural latency of the sense; that of sight is PlayerParameters::initial_delay_error_s.
struct Timing {
  double touch_sd_s = 0.036;
  double sight_sd_s = 0.021;
  double sound_sd_s = 0.005;
  double touch_error_s = 0;
  double sound_error_s = 0;
};

// A property of Timing with its published range. The member `field` of the range is not used.
struct TimingRange {
  observer::ParameterRange range;
  double Timing::*field;
};
const std::vector<TimingRange>& timing_ranges();

class Participant {
 public:
  // Participant `index` of the population of this seed.
  Participant(std::uint32_t index, std::uint64_t seed);
  // A participant with these properties, for tests.
  Participant(const observer::PlayerParameters& player, const Timing& timing, std::uint64_t seed);

  const observer::PlayerParameters& player() const { return player_; }
  const Timing& timing() const { return timing_; }
  // Another player of the same population, for an experiment of two people.
  observer::PlayerParameters partner() const;
  // Seed of the noise of one trial.
  std::uint64_t trial_seed(const std::string& paradigm, std::uint64_t number) const;
  // A thing that is expensive to make and the same in many trials, such as a session with learnt delays.
  template <class T, class Make>
  T& prepared(const std::string& key, Make make) {
    std::any& place = prepared_[key];
    if (!place.has_value()) place = std::make_shared<T>(make());
    return *std::any_cast<std::shared_ptr<T>&>(place);
  }

 private:
  std::uint32_t index_ = 0;
  std::uint64_t seed_ = 0, population_seed_ = 0;
  observer::PlayerParameters player_;
  Timing timing_;
  std::map<std::string, std::any> prepared_;
};

}  // namespace tactus::experiments
