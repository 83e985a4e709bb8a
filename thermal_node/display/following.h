// Checks that a plate follows its command, from the readings of its sensor. A reading that does not follow shows
// that the plate, the sensor or the program between them has failed, or that the reading is forged. Pure.
#pragma once

#include <optional>

namespace tactus::thermal {

class Following {
 public:
  enum class Result {
    kFollows,
    kShort,   // the display reports that it delivers less than commanded
    kFailed,  // until restart()
  };
  // Design: the slowest display that is accepted; the default element moves at 17 K/s.
  static constexpr double kSlowest_K_s = 1;
  // Design: above the error of a sensor and of a controller under the load of a finger, below a change that a
  // finger would take for another material.
  static constexpr double kTolerance_K = 2;
  // Design: a reading may be late by some ticks.
  static constexpr double kPatience_s = 0.5;
  // Design: the duration of kShort after the last such reading.
  static constexpr double kShort_s = 10;

  // Mean command and mean reading of the last dt, both finite. limited: the display reports that it delivers less.
  // It is kShort only on the side of neutral_degC; beyond the command it has failed. Realtime-safe: yes.
  Result step(double command_degC, double plate_degC, bool limited, double neutral_degC, double dt_s);

  // The time before was not observed: the plate may be anywhere between its next reading and its command.
  void skip() { reachable_.reset(); }
  // Another display begins.
  void restart() { *this = Following(); }

 private:
  struct Interval {
    double low, high;
  };
  std::optional<Interval> reachable_;  // by displays that move at kSlowest_K_s or faster
  double outside_s_ = 0, short_s_ = 0;
  bool failed_ = false;
};

}  // namespace tactus::thermal
