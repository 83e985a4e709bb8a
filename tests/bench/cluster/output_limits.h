// The limits that protect a person, checked at the outputs of a cluster and independently of its code: the force that the
// driver of a device exerts, the temperature of a plate, and the samples of a sound file. Pure.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/cluster/arm_driver.h"

namespace tactus::bench {

// Design: a tenth of the deviation of 2 K that makes a plate count as one that does not follow (thermal_node/display/following.h).
inline constexpr double kPlateOvershoot_K = 0.2;

// Of the default settings (haptic_node, thermal_node and audio_node/settings.csv, which name the sources).
struct SafeLimits {
  double force_N = 8, slew_N_s = 2000, torque_N_m = 0.3, energy_J = 0.49, power_W = 1;
  double min_degC = 15, max_degC = 42, warm_degC = 39, dose_s = 60, dose_decay_s = 300, cold_degC = 20, cold_s = 60;
  double ceiling = 0.9, level_dBA = 85, full_scale_dBA = 100;
};

// Sum of the force on a hand over the ticks of a driver.
class ForceAccount {
 public:
  void add(const ArmTick& tick);
  // The limits that were passed, in words; empty: none.
  std::string faults() const;
  double peak_N() const { return peak_N_; }
  // Largest rise in one tick beyond the slew limit, N.
  double beyond_rise_N() const { return beyond_rise_N_; }
  // Largest energy given to the hand beyond the constant power, in any span, J.
  double energy_J() const { return energy_J_; }

 private:
  SafeLimits limits_;
  std::optional<ArmTick> last_;
  double peak_N_ = 0, peak_N_m_ = 0, beyond_rise_N_ = 0, tank_J_ = 0, energy_J_ = 0;
  bool finite_ = true;
};

// Exposure of the skin to commanded or measured temperatures.
class HeatAccount {
 public:
  // overshoot_K: by which a real plate may pass the range of its commands while it approaches them.
  explicit HeatAccount(double overshoot_K = 0) : overshoot_K_(overshoot_K) {}
  void add(sync::HostTime time, double degC);
  std::string faults() const;
  double lowest_degC() const { return lowest_degC_; }
  double highest_degC() const { return highest_degC_; }
  // Largest exposure to warmth, s at 43 degC (Sapareto and Dewey 1984), and longest time below cold_degC.
  double dose_s() const { return max_dose_s_; }
  double cold_s() const { return max_cold_s_; }

 private:
  SafeLimits limits_;
  double overshoot_K_;
  std::optional<sync::HostTime> last_;
  double lowest_degC_ = 33, highest_degC_ = 33, degC_ = 33, dose_s_ = 0, cold_s_ = 0, max_dose_s_ = 0, max_cold_s_ = 0;
  bool finite_ = true;
};

// A WAV of 32-bit floats.
struct Sound {
  int channels = 0;
  double rate_Hz = 0;
  std::vector<float> samples;  // interleaved

  std::size_t frames() const { return channels > 0 ? samples.size() / static_cast<std::size_t>(channels) : 0; }
};
// Throws std::runtime_error with one sentence when the file is not such a WAV.
Sound read_sound(const std::filesystem::path& wav);
std::string faults_of(const Sound& sound);

}  // namespace tactus::bench
