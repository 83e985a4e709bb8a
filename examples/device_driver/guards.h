// Limits of the last program before a device: copy this file into your driver. It needs only the standard library.
// Pure: times are CLOCK_MONOTONIC of this machine in ns, as arguments. guards.py holds the same classes in Python.
//
//   OneSender         which messages are commands: one sender at a time, new, not late, not ahead of the clock
//   ForceGuard        force and torque for the motors, for any message and after any gap
//   TemperatureGuard  temperature for a plate on the skin, likewise
//
// Call update() on every tick of the driver and command only its result. Realtime-safe: yes. Thread-safe: no.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace tactus::examples {

using Vector = std::array<double, 3>;

inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double size(const Vector& v) { return std::sqrt(dot(v, v)); }
inline Vector times(double factor, const Vector& v) { return {factor * v[0], factor * v[1], factor * v[2]}; }
inline bool finite(const Vector& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

// Why a message was no command, or why the output is limited.
enum class Reason {
  kNone,
  kOtherRun,
  kOld,
  kAhead,
  kRepeated,
  kSecondSender,
  kNotFinite,
  kNoCommand,
  kStopped,
  kNoMotion,
  kEnergy
};
inline const char* text(Reason r) {
  constexpr const char* kTexts[] = {"",         "other run",     "old",        "ahead",
                                    "repeated", "second sender", "not finite", "no command",
                                    "stopped",  "no motion",     "energy"};
  return kTexts[static_cast<int>(r)];
}

// From the header of a message (header_t).
struct Sent {
  std::int64_t run = 0, incarnation = 0, seq = 0, sent_ns = 0;
};

struct SenderLimits {
  std::int64_t run = 1;  // number of the cluster run; messages of other runs are ignored
  // False: the sender has another clock. Then the age is measured against the fastest message, with 200 ppm of
  // drift.
  bool same_clock = true;
  double max_age_s = 0.05;     // design: as old as a lost device may be (device_stale_after)
  double max_ahead_s = 0.002;  // design: a clock read twice never differs by more
  double silence_s = 0.3;      // a sender that is silent for this time has ended; then the next one is followed
};

// Follows one incarnation of one run. While a second one sends, no message is a command.
class OneSender {
 public:
  explicit OneSender(const SenderLimits& limits) : limits_(limits) {}

  // kNone: the message is a command.
  Reason check(const Sent& m, std::int64_t now_ns) {
    if (m.run != limits_.run) return Reason::kOtherRun;
    const bool same = followed_ && m.incarnation == followed_->incarnation;
    if (followed_ && !same && now_ns - heard_ns_ < ns(limits_.silence_s)) {
      second_ns_ = now_ns;
      return Reason::kSecondSender;
    }
    if (same && m.seq <= followed_->seq) return Reason::kRepeated;
    if (same && !plausible(m.seq, now_ns)) return Reason::kAhead;
    if (!same) fastest_s_.reset();
    if (const Reason late = check_age(m.sent_ns, now_ns); late != Reason::kNone) return late;
    if (!same) second_ns_.reset();
    followed_ = m, heard_ns_ = now_ns;
    return conflict(now_ns) ? Reason::kSecondSender : Reason::kNone;
  }
  // True while two senders speak, and for silence_s after.
  bool conflict(std::int64_t now_ns) const { return second_ns_ && now_ns - *second_ns_ < ns(limits_.silence_s); }

  static std::int64_t ns(double s) { return static_cast<std::int64_t>(s * 1e9); }

 private:
  // A forged number far ahead would make every later message a repeated one. Design: 1000, and 10 kHz of lost
  // messages.
  bool plausible(std::int64_t seq, std::int64_t now_ns) const {
    return static_cast<double>(seq) - static_cast<double>(followed_->seq) <=
           1000 + 1e-5 * static_cast<double>(now_ns - heard_ns_);
  }
  Reason check_age(std::int64_t sent_ns, std::int64_t now_ns) {
    const double delay_s = (static_cast<double>(now_ns) - static_cast<double>(sent_ns)) * 1e-9;
    double fastest_s = limits_.same_clock ? 0 : fastest_s_.value_or(delay_s);
    if (delay_s - fastest_s > limits_.max_age_s) return Reason::kOld;
    if (fastest_s - delay_s > limits_.max_ahead_s) return Reason::kAhead;
    constexpr double kDrift = 2e-4;  // between quartz clocks, twice the 100 ppm of a poor one (design)
    if (fastest_s_) fastest_s += kDrift * static_cast<double>(now_ns - heard_ns_) * 1e-9;
    fastest_s_ = std::min(fastest_s, delay_s);
    return Reason::kNone;
  }

  SenderLimits limits_;
  std::optional<Sent> followed_;
  std::int64_t heard_ns_ = 0;
  std::optional<std::int64_t> second_ns_;  // newest message of a second sender
  std::optional<double> fastest_s_;        // smallest delay, of another clock
};

// Defaults as in haptic_node/settings.csv, which names their sources. Lower them to the ratings of your device.
struct ForceLimits {
  double force_N = 8, slew_N_s = 2000;
  double torque_N_m = 0.3, torque_slew_N_m_s = 75;
  double energy_J = 0.49, power_W = 1;  // given to the hand at once, and without end
  double valid_s = 0.1;                 // longest validity of a command, for any message
  double fade_s = 0.02;                 // from any force to zero, and back
};

// Force in N and torque in N m on the hand, axes of the world.
struct Exerted {
  Vector force{}, torque{};
  Reason reason = Reason::kNone;
};

class ForceGuard {
 public:
  ForceGuard(const ForceLimits& limits, const SenderLimits& sender)
      : limits_(limits), sender_(sender), tank_J_(limits.energy_J) {}

  // A message for this device arrived. Returns kNone, or why it is no command; the command before remains until
  // its time is over.
  Reason on_message(const Sent& sent, const Vector& force, const Vector& torque, std::int64_t valid_ns,
                    std::int64_t now_ns) {
    if (const Reason r = sender_.check(sent, now_ns); r != Reason::kNone) return r;
    if (!finite(force) || !finite(torque)) return Reason::kNotFinite;
    if (valid_ns <= 0) return Reason::kNoCommand;
    // By one factor, so that the felt contact point stays.
    const double beyond = std::max({1.0, size(force) / limits_.force_N, size(torque) / limits_.torque_N_m});
    force_ = times(1 / beyond, force), torque_ = times(1 / beyond, torque);
    until_ns_ = now_ns + std::min(valid_ns, OneSender::ns(limits_.valid_s));
    return Reason::kNone;
  }

  // One tick: the force and torque to exert now. velocity, spin: of the device since the last tick, m/s and rad/s;
  // one that is not finite counts as a lost device.
  Exerted update(std::int64_t now_ns, const Vector& velocity, const Vector& spin = {}) {
    const double dt = last_ns_ ? static_cast<double>(now_ns - *last_ns_) * 1e-9 : 0;
    last_ns_ = now_ns;
    const bool moves = finite(velocity) && finite(spin), stopped = dt < 0 || dt > limits_.fade_s;
    if (stopped || !finite(out_.force) || !finite(out_.torque))
      gate_ = 0, out_ = {};
    else if (moves)
      spend(dot(out_.force, velocity) + dot(out_.torque, spin), dt);
    const Reason gap = sender_.conflict(now_ns)             ? Reason::kSecondSender
                       : !until_ns_ || now_ns >= *until_ns_ ? Reason::kNoCommand
                       : !moves                             ? Reason::kNoMotion
                                                            : Reason::kNone;
    if (gap == Reason::kNone) {
      gate_ = stopped ? 0 : std::min(1.0, gate_ + dt / limits_.fade_s);
      const double left = std::clamp(2 * tank_J_ / limits_.energy_J, 0.0, 1.0);
      out_.force = approach(out_.force, times(gate_ * left, force_), limits_.slew_N_s * dt);
      out_.torque = approach(out_.torque, times(gate_ * left, torque_), limits_.torque_slew_N_m_s * dt);
      out_.reason = stopped ? Reason::kStopped : left < 1 ? Reason::kEnergy : Reason::kNone;
    } else {
      const double before = gate_;
      gate_ = std::max(0.0, gate_ - std::max(dt, 0.0) / limits_.fade_s);
      const double left = before > 0 ? gate_ / before : 0;
      out_ = {times(left, out_.force), times(left, out_.torque), gap};
    }
    return out_;
  }

 private:
  // Falls at once and rises by at most `step`, so that a slow slew never adds energy.
  static Vector approach(const Vector& from, const Vector& to, double step) {
    const double length = size(to);
    if (!(length > 0)) return {};
    const double kept = std::clamp(dot(from, to) / length, 0.0, length);
    return times(std::min(length, kept + step) / length, to);
  }
  // A tank that power to the hand drains and power from the hand fills (Hannaford and Ryu 2002). It recovers
  // within a second.
  void spend(double power_W, double dt) {
    tank_J_ = std::clamp(tank_J_ + (limits_.power_W - power_W) * dt, -limits_.power_W, limits_.energy_J);
  }

  ForceLimits limits_;
  OneSender sender_;
  double tank_J_, gate_ = 0;
  Vector force_{}, torque_{};
  std::optional<std::int64_t> until_ns_, last_ns_;
  Exerted out_;
};

// Defaults as in thermal_node/settings.csv and thermal_node/skin/dwell.h, which name their sources.
struct TemperatureLimits {
  double min_degC = 15, max_degC = 42, neutral_degC = 33, slew_K_s = 20;
  double valid_s = 0.3;                                    // of a command after its arrival
  double warm_degC = 39, dose_s = 60, dose_decay_s = 300;  // seconds at 43 degC or the equivalent, above warm_degC
  double cold_degC = 20, cold_s = 60;                      // time below cold_degC
  double return_K_s = 20;  // at least, on the way to neutral: a slower slew would lengthen an exposure
  double runaway_K = 2;    // beyond the range: the plate does not obey (design: an overshoot is smaller)
};

// The exposure of the person, to store and to continue with after a restart.
struct SkinAccount {
  double dose_s = 0, cold_s = 0;
  bool too_warm = false, too_cold = false;
};

class TemperatureGuard {
 public:
  TemperatureGuard(const TemperatureLimits& limits, const SenderLimits& sender)
      : limits_(limits), sender_(sender), out_degC_(limits.neutral_degC) {}

  Reason on_message(const Sent& sent, double wanted_degC, std::int64_t now_ns) {
    if (const Reason r = sender_.check(sent, now_ns); r != Reason::kNone) return r;
    if (!std::isfinite(wanted_degC)) return Reason::kNotFinite;
    wanted_degC_ = wanted_degC, until_ns_ = now_ns + OneSender::ns(limits_.valid_s);
    return Reason::kNone;
  }

  // One tick: the temperature to command now, degC. plate_degC: as measured; one that is not finite counts as the
  // warmest and the coldest in range.
  double update(std::int64_t now_ns, double plate_degC) {
    const double dt = last_ns_ ? std::max(0.0, static_cast<double>(now_ns - *last_ns_) * 1e-9) : 0;
    last_ns_ = now_ns;
    const bool known = std::isfinite(plate_degC);
    expose(std::max(out_degC_, known ? plate_degC : limits_.max_degC),
           std::min(out_degC_, known ? plate_degC : limits_.min_degC), dt);
    const bool live = until_ns_ && now_ns < *until_ns_ && !sender_.conflict(now_ns);
    reason_ = live ? Reason::kNone : sender_.conflict(now_ns) ? Reason::kSecondSender : Reason::kNoCommand;
    const double low = too_cold_ ? limits_.cold_degC : limits_.min_degC,
                 high = too_warm_ ? limits_.warm_degC : limits_.max_degC;
    const double wanted_degC = live ? wanted_degC_ : limits_.neutral_degC;
    const bool returns = std::abs(wanted_degC - limits_.neutral_degC) < std::abs(out_degC_ - limits_.neutral_degC);
    const double slew_K_s = returns ? std::max(limits_.slew_K_s, limits_.return_K_s) : limits_.slew_K_s;
    const double step = slew_K_s * std::min(dt, 0.1);
    out_degC_ += std::clamp(wanted_degC - out_degC_, -step, step);
    // A plate that was cold when the display was switched on must be heated.
    off_ = !known || plate_degC > limits_.max_degC + limits_.runaway_K ||
           (plate_degC < limits_.min_degC - limits_.runaway_K && plate_degC < before_degC_);
    if (known) before_degC_ = plate_degC;
    return out_degC_ = std::clamp(out_degC_, low, high);  // a limit is entered at once
  }
  Reason reason() const { return reason_; }
  // No current may flow: the sensor has failed, or the plate is out of its range.
  bool off() const { return off_; }
  SkinAccount account() const { return {dose_s_, cold_s_, too_warm_, too_cold_}; }
  // before: the account of an earlier process, or of this one; away_s: time at neutral since then, 0 if it is not known. Sums that
  // are not finite or negative count as full.
  void resume(const SkinAccount& before, double away_s = 0) {
    const auto sum = [](double stored_s, double max_s) { return stored_s >= 0 && stored_s <= max_s ? stored_s : max_s; };
    away_s = away_s > 0 ? away_s : 0;
    dose_s_ = sum(before.dose_s, 2 * limits_.dose_s) * std::exp(-away_s / limits_.dose_decay_s);
    cold_s_ = std::max(0.0, sum(before.cold_s, 2 * limits_.cold_s) - away_s);
    too_warm_ = before.too_warm, too_cold_ = before.too_cold;
    update_limits();
  }

 private:
  // Of the command and the plate, the warmer counts for warmth and the colder for cold. Dose of Sapareto and Dewey
  // 1984.
  void expose(double warmest, double coldest, double dt) {
    if (warmest > limits_.warm_degC)
      dose_s_ += dt * std::pow(warmest > 43 ? 2 : 4, std::min(warmest, 100.0) - 43);
    else
      dose_s_ *= std::exp(-dt / limits_.dose_decay_s);
    cold_s_ = std::max(0.0, cold_s_ + (coldest < limits_.cold_degC ? dt : -dt));
    dose_s_ = std::min(dose_s_, 2 * limits_.dose_s), cold_s_ = std::min(cold_s_, 2 * limits_.cold_s);
    update_limits();
  }
  void update_limits() {
    too_warm_ = dose_s_ >= limits_.dose_s || (too_warm_ && dose_s_ > limits_.dose_s / 2);
    too_cold_ = cold_s_ >= limits_.cold_s || (too_cold_ && cold_s_ > limits_.cold_s / 2);
  }

  TemperatureLimits limits_;
  OneSender sender_;
  double out_degC_, wanted_degC_ = 0, dose_s_ = 0, cold_s_ = 0;
  double before_degC_ = -1e9;  // plate at the last tick
  bool too_warm_ = false, too_cold_ = false, off_ = false;
  Reason reason_ = Reason::kNoCommand;
  std::optional<std::int64_t> until_ns_, last_ns_;
};

}  // namespace tactus::examples
