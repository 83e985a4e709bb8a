// Who watches a game: whether it was won, when, with how many mistakes, how hard the hand was pushed and how far
// it went. Pure.
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
  double time_s = 0;        // of the world, until it was won or ended
  int filled = 0;           // holes with the right ball in them
  int wrong = 0;            // balls that came into a wrong hole
  double peak_force_N = 0;  // on the first tool, as it was felt
  double path_m = 0;        // of the first tool
};

class Referee {
 public:
  // What crosses the bus, all of it.
  void hear(std::string_view channel, std::span<const std::uint8_t> data);
  // The world has been told of.
  bool begun() const { return begun_; }
  // It is won, or cannot be any more: a ball lies in a wrong hole.
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
