// Judges a game: success, time, mistakes, the largest force on the hand, and the length of its path. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

namespace tactus {
struct GameVerdict {
  bool won = false;
  double time_s = 0;        // simulated time until it was won or ended
  int filled = 0;           // holes with the right ball in them
  int wrong = 0;            // balls that entered a wrong hole
  double peak_force_N = 0;  // on the first tool, as felt
  double path_m = 0;        // of the first tool
};

class Referee {
 public:
  // Receives all messages of the bus.
  void on_message(std::string_view channel, std::span<const std::uint8_t> data);
  // True once the simulation has published the world.
  bool begun() const { return begun_; }
  // True when it is won, or cannot be won any more: a ball lies in a wrong hole.
  bool decided() const { return verdict_.won || verdict_.wrong > 0; }
  const GameVerdict& verdict() const { return verdict_; }

 private:
  struct Point {
    double x, y, z;
  };
  GameVerdict verdict_;
  bool begun_ = false;
  std::optional<Point> last_;
  std::set<std::pair<int, int>> mistakes_;  // hole, ball
};
}  // namespace tactus
