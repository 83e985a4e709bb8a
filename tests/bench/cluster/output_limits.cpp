#include "tests/bench/cluster/output_limits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tests/audio_node/support/level_oracle.h"

namespace tactus::bench {
namespace {

using examples::Vector;

// Single precision of the messages.
constexpr double kRounding = 1e-5;
// A guard looks at its account once a tick, so the account can pass its end by the work of one tick: 8 N at 1 m/s for 1 ms.
constexpr double kTickWork_J = 0.008;
// A narrower range is entered in the tick that finds the dose used up; the display then follows at 10 K/s or faster.
constexpr double kFollow_s = 3;

void append(std::string& text, bool wrong, const std::string& what, double value) {
  if (wrong) text += (text.empty() ? "" : ", ") + what + " " + std::to_string(value);
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number value{};
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

void ForceAccount::add(const ArmTick& tick) {
  const Vector& force = tick.exerted.force;
  finite_ = finite_ && examples::finite(force) && examples::finite(tick.exerted.torque);
  peak_N_ = std::max(peak_N_, examples::size(force));
  peak_N_m_ = std::max(peak_N_m_, examples::size(tick.exerted.torque));
  if (last_) {
    const double dt = sync::to_seconds(tick.time - last_->time), size = examples::size(force);
    // The force falls at once and rises along itself; after a pause of the driver it begins from zero.
    const double before = size > 0 && dt <= 0.02 ? std::max(0.0, examples::dot(last_->exerted.force, force) / size) : 0;
    beyond_rise_N_ = std::max(beyond_rise_N_, size - before - limits_.slew_N_s * (dt <= 0.02 ? dt : 0));
    const double work_J = dt <= 0.02 ? examples::dot(last_->exerted.force, tick.velocity_m_s) * dt : 0;
    tank_J_ = std::max(0.0, tank_J_ + work_J - limits_.power_W * dt);
    energy_J_ = std::max(energy_J_, tank_J_);
  }
  last_ = tick;
}

std::string ForceAccount::faults() const {
  std::string text = finite_ ? "" : "a force that is not finite";
  append(text, peak_N_ > limits_.force_N + kRounding, "force in N", peak_N_);
  append(text, peak_N_m_ > limits_.torque_N_m + kRounding, "torque in N m", peak_N_m_);
  append(text, beyond_rise_N_ > kRounding, "rise of the force beyond its limit in N", beyond_rise_N_);
  append(text, energy_J_ > limits_.energy_J + kTickWork_J, "energy in J", energy_J_);
  return text;
}

void HeatAccount::add(sync::HostTime time, double degC) {
  finite_ = finite_ && std::isfinite(degC);
  lowest_degC_ = std::min(lowest_degC_, degC);
  highest_degC_ = std::max(highest_degC_, degC);
  const double dt = last_ ? std::max(0.0, sync::to_seconds(time - *last_)) : 0;
  if (degC_ > limits_.warm_degC)
    dose_s_ += dt * std::pow(degC_ > 43 ? 2 : 4, degC_ - 43);
  else
    dose_s_ *= std::exp(-dt / limits_.dose_decay_s);
  cold_s_ = std::max(0.0, cold_s_ + (degC_ < limits_.cold_degC ? dt : -dt));
  max_dose_s_ = std::max(max_dose_s_, dose_s_);
  max_cold_s_ = std::max(max_cold_s_, cold_s_);
  last_ = time, degC_ = degC;
}

std::string HeatAccount::faults() const {
  std::string text = finite_ ? "" : "a temperature that is not finite";
  append(text, lowest_degC_ < limits_.min_degC - overshoot_K_ - kRounding, "temperature in degC", lowest_degC_);
  append(text, highest_degC_ > limits_.max_degC + overshoot_K_ + kRounding, "temperature in degC", highest_degC_);
  append(text, max_dose_s_ > limits_.dose_s + kFollow_s, "dose of warmth in s", max_dose_s_);
  append(text, max_cold_s_ > limits_.cold_s + kFollow_s, "time of cold in s", max_cold_s_);
  return text;
}

Sound read_sound(const std::filesystem::path& wav) {
  std::ifstream file(wav, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  Sound sound;
  if (bytes.size() > 12 && bytes.compare(0, 4, "RIFF") == 0)
    for (std::size_t at = 12; at + 8 <= bytes.size();) {
      const std::string name = bytes.substr(at, 4);
      const std::size_t size = std::min<std::size_t>(number_at<std::uint32_t>(bytes, at + 4), bytes.size() - at - 8);
      if (name == "fmt ") {
        sound.channels = number_at<std::uint16_t>(bytes, at + 10);
        sound.rate_Hz = number_at<std::uint32_t>(bytes, at + 12);
      } else if (name == "data") {
        sound.samples.resize(size / sizeof(float));
        std::memcpy(sound.samples.data(), bytes.data() + at + 8, sound.samples.size() * sizeof(float));
      }
      at += 8 + size + size % 2;
    }
  if (sound.channels == 0 || sound.rate_Hz == 0)
    throw std::runtime_error(wav.string() + " is no WAV; see the log of audio_node beside it");
  return sound;
}

std::string faults_of(const Sound& sound) {
  const SafeLimits limits;
  double peak = 0;
  bool finite = true;
  for (const float x : sound.samples) {
    finite = finite && std::isfinite(x);
    peak = std::max(peak, static_cast<double>(std::abs(x)));
  }
  std::string text = finite ? "" : "a sample that is not finite";
  append(text, peak > limits.ceiling + kRounding, "sample", peak);
  const double level_dBA =
      audio::test::loudest_second_by_oracle_dBA(sound.samples, sound.channels, sound.rate_Hz, limits.full_scale_dBA, true);
  append(text, level_dBA > limits.level_dBA + 0.05, "level in dBA", level_dBA);
  return text;
}

}  // namespace tactus::bench
