// One random trial of the thermal safety limits: settings, operators, touches, a display and its faults, all from
// one seed. The exposure is counted by the test itself, from the plate that a finger would touch.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "sync/degradation/known_modalities.h"
#include "tests/thermal_node/support/hand.h"
#include "thermal_node/devices/make_device.h"
#include "thermal_node/devices/simulated_peltier.h"

namespace tactus::thermal::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  // Uniform in [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53;
  }
  bool chance(double p) { return uniform(0, 1) < p; }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(bits_() % count); }
  // Often an end of the range, as people set limits; else uniform, or uniform in the logarithm.
  double in_range(double low, double high) {
    const double kind = uniform(0, 1);
    if (kind < 0.15) return low;
    if (kind < 0.3) return high;
    if (kind < 0.65 && low > 0) return low * std::pow(high / low, uniform(0, 1));
    return uniform(low, high);
  }

 private:
  std::mt19937_64 bits_;
};

// Every setting of the table within its range; texts without a choice keep their default.
inline Settings any_settings(Random& random) {
  Settings settings;
  for (const auto& entry : setting_fields()) {
    const std::string unit = entry.row.unit;
    if (const auto number = std::get_if<double Settings::*>(&entry.field))
      settings.**number = random.in_range(entry.row.min, entry.row.max);
    else if (const auto text = std::get_if<std::string Settings::*>(&entry.field);
             text && unit.find('|') != std::string::npos) {
      const auto count = static_cast<std::size_t>(std::count(unit.begin(), unit.end(), '|')) + 1;
      std::size_t begin = 0;
      for (std::size_t skip = random.index(count); skip > 0; --skip) begin = unit.find('|', begin) + 1;
      settings.**text = unit.substr(begin, unit.find('|', begin) - begin);
    }
  }
  return settings;
}

// Every output operator of the modality within its range, or off.
inline double any_operator(Random& random, const std::string& name) {
  for (const sync::OutputOperator& op : sync::output_operators_of("thermal"))
    if (op.name == name) return random.chance(0.5) ? 0 : random.in_range(op.min, op.max);
  return 0;
}

// The sums of Dwell by its definition: warmth by Sapareto and Dewey, cold as time.
struct TrueExposure {
  double dose_s = 0, cold_s = 0;
  void add(double degC, double dt_s, const Settings& s) {
    const double above_K = degC - 43;
    dose_s = degC > 39 ? dose_s + std::pow(above_K > 0 ? 2 : 4, above_K) * dt_s : dose_s * std::exp(-dt_s / 300);
    // A plate that swings about a neutral of 25 degC is not cold.
    const double cold_degC =
        std::min(s.cold_below_degC, std::max(s.skin_rest_degC, s.temperature_min_degC) - kPlateSwing_K);
    cold_s = std::max(0.0, cold_s + (degC < cold_degC ? dt_s : -dt_s));
  }
};

// A plate that another program drives, at any accepted speed, with a sensor that may lie.
struct OtherPlate {
  double degC, speed_K_s;
  void step(double command_degC, double dt_s) {
    degC += std::clamp(command_degC - degC, -speed_K_s * dt_s, speed_K_s * dt_s);
  }
};

struct TrialResult {
  double dose_share = 0, cold_share = 0;  // largest exposure, of dose_max and cold_max
  double beyond_range_K = 0;              // of the command
  double beyond_slew_K = 0;               // of a step of the command away from neutral
  double late_neutral_K = 0;              // from neutral, when the way there has had its time
  Settings settings;
};

class LimitsTrial {
 public:
  // About as long as `ticks`, at most `seconds`.
  LimitsTrial(std::uint64_t seed, int ticks, double seconds) : random_(seed) {
    Settings& s = result_.settings;
    s = any_settings(random_);
    seconds_ = std::min(seconds, ticks / s.rate_Hz);
    if (random_.chance(0.6)) aim_at_limits(s);
    response_s_ = any_operator(random_, "response");
    lies_ = random_.chance(0.3);
    // A sensor that lies hides how slow its plate is: no account can be right then.
    other_ = {s.skin_rest_degC, random_.in_range(lies_ ? 20 : 1, 40)};
    materials_ = {material(401, 8960, 385, 1000), material(401, 8960, 385, -200), material(401, 8960, 385, 44),
                  material(0.18, 1050, 1400, 23)};
  }

  TrialResult run() {
    const Settings& s = result_.settings;
    Hand hand(materials_, s);
    auto peltier = s.device == "peltier" ? make_device(s, 0, s.skin_rest_degC) : nullptr;
    command_degC_ = neutral_degC();
    for (double t = 0; t < seconds_;) {
      const double dt_s = random_.chance(0.002) ? random_.uniform(0.05, 5) : 1 / s.rate_Hz;
      t += dt_s;
      Tick tick = hand.next(sync::from_seconds(dt_s));
      const bool lost = touch_something(tick, dt_s);
      TickOptions options{.response_s = response_s_, .longest_substep_s = 0.1};
      drive(options, peltier.get(), hand, tick.end, dt_s);
      const double before = command_degC_;
      command_degC_ = hand.renderer.step(tick, options).commanded_degC;
      judge(before, dt_s, lost || options.display_lost || dt_s > 0.3);
    }
    return result_;
  }

 private:
  double neutral_degC() const {
    const Settings& s = result_.settings;
    return std::clamp(s.skin_rest_degC, s.temperature_min_degC, s.temperature_max_degC);
  }

  // Limits that a long touch of one thing reaches in the time of the trial.
  void aim_at_limits(Settings& s) {
    s.dose_max_s = random_.in_range(1, 20), s.cold_max_s = random_.in_range(1, 20);
    s.temperature_max_degC = random_.in_range(41, 43), s.temperature_min_degC = random_.in_range(10, 18);
    touched_ = random_.chance(0.5) ? 0 : 1;
    change_s_ = 100;
  }

  // Mostly long touches of hot and cold things. Returns true when the input is lost.
  bool touch_something(Tick& tick, double dt_s) {
    if (random_.chance(dt_s / change_s_)) touched_ = static_cast<int>(random_.index(6)) - 1;
    if (random_.chance(dt_s / change_s_)) lost_ = random_.chance(0.2);
    if (touched_ >= 0 && touched_ < 4)
      touch(tick, touched_, random_.uniform(0, 20), 1e-4, sync::from_seconds(dt_s));
    tick.contact_interval = sync::from_seconds(dt_s);
    if (lost_) tick.contact.status = random_.chance(0.5) ? sync::SampleStatus::kStale : sync::SampleStatus::kNone;
    return lost_;
  }

  // Moves the plate under the finger for this tick, and fills in the report of its program.
  void drive(TickOptions& options, Device* peltier, Hand& hand, sync::HostTime now, double dt_s) {
    const Settings& s = result_.settings;
    // A display returns to neutral when its sender stops.
    const double silent_s = std::max(0.0, dt_s - 0.3), commanded_s = dt_s - silent_s;
    if (peltier) {
      options.plate = peltier->step(command_degC_, hand.renderer.load_W(), now);
      options.plate_return_K_s = peltier->return_K_s();
      exposure_.add(options.plate->plate_degC, commanded_s, s);
      exposure_.add(neutral_degC(), silent_s, s);
    } else if (s.device == "external") {
      const double begin = other_.degC;
      other_.step(command_degC_, commanded_s);
      exposure_.add(worse(begin, other_.degC), commanded_s, s);
      other_.step(neutral_degC(), silent_s);
      exposure_.add(other_.degC, silent_s, s);
      if (random_.chance(dt_s / change_s_)) display_lost_ = random_.chance(0.2);
      options.display_lost = display_lost_;
      options.plate_return_K_s = Following::kSlowest_K_s;
      options.plate = PlateReading{lies_ ? random_.uniform(30, 36) : other_.degC};
    } else {
      exposure_.add(command_degC_, commanded_s, s);
      exposure_.add(neutral_degC(), silent_s, s);
    }
  }
  double worse(double a, double b) const {
    return std::abs(a - neutral_degC()) > std::abs(b - neutral_degC()) ? a : b;
  }

  void judge(double before, double dt_s, bool to_neutral) {
    const Settings& s = result_.settings;
    TrialResult& r = result_;
    r.dose_share = std::max(r.dose_share, exposure_.dose_s / s.dose_max_s);
    r.cold_share = std::max(r.cold_share, exposure_.cold_s / s.cold_max_s);
    r.beyond_range_K = std::max(
        {r.beyond_range_K, command_degC_ - s.temperature_max_degC, s.temperature_min_degC - command_degC_});
    if (std::abs(command_degC_ - neutral_degC()) > std::abs(before - neutral_degC()))
      r.beyond_slew_K = std::max(r.beyond_slew_K, std::abs(command_degC_ - before) - s.slew_max_K_s * dt_s);
    to_neutral_s_ = to_neutral ? to_neutral_s_ + dt_s : 0;
    // The widest range, 15 to 43 degC from a neutral of 25 to 37, at Renderer::kReturn_K_s, and two ticks.
    if (to_neutral_s_ > 33 / Renderer::kReturn_K_s + 2 * dt_s)
      r.late_neutral_K = std::max(r.late_neutral_K, std::abs(command_degC_ - neutral_degC()));
  }

  Random random_;
  double seconds_ = 0, change_s_ = 3, response_s_ = 0, command_degC_ = 33, to_neutral_s_ = 0;
  bool lies_ = false, lost_ = false, display_lost_ = false;
  int touched_ = 0;
  OtherPlate other_{33, 20};
  TrueExposure exposure_;
  std::vector<material_def_t> materials_;
  TrialResult result_;
};

}  // namespace tactus::thermal::test
