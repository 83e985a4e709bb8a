#include "sim_node/game/game.h"

#include <catch2/catch.hpp>
#include <tactus/game_state_t.hpp>

using namespace tactus;
using namespace tactus::sim;

namespace {

HoleDef hole(const char* name, double x, int ball) { return {name, {x, 0, 0}, 0.03, 0.1, ball}; }

// Two balls, 0 and 1, and a game with one hole for each, at x = 0 and x = 1.
struct Table {
  Game game{{hole("left", 0, 0), hole("right", 1, 1)}};
  std::vector<BodyMotion> balls{2};
  std::int64_t ms = 0;

  Table() { put(0, {0.5, 0, 0.1}), put(1, {0.6, 0, 0.1}); }
  void put(std::size_t ball, const Eigen::Vector3d& p) { balls[ball].centre_m = p; }
  game_state_t after(int steps) {
    for (int i = 0; i < steps; ++i) game.step(sync::sim_time(1'000'000 * ++ms), balls);
    game_state_t m{};
    game.describe(m);
    return m;
  }
};

}  // namespace

TEST_CASE("A hole is filled after its ball stays below the rim, and the game is won when all are filled") {
  Table t;
  CHECK(t.after(10).holes[0].inside == -1);
  t.put(0, {0.01, 0, -0.05});
  CHECK(t.after(50).holes[0].filled == 0);
  CHECK(t.after(60).holes[0].filled == 1);
  CHECK(!t.game.won());
  t.put(1, {1, 0.02, -0.02});
  const game_state_t won = t.after(150);
  CHECK(won.won == 1);
  CHECK(won.won_ns == Approx(1e6 * 221).margin(1.1e6));  // 120 ms, then 100 ms in the hole
  CHECK(won.holes[0].filled + won.holes[1].filled == 2);
  t.put(1, {1, 0.02, 0.01});  // taken out again
  const game_state_t open = t.after(1);
  CHECK(open.won == 0);
  CHECK(open.won_ns == -1);
  CHECK(open.holes[1].inside == -1);
}

TEST_CASE("A ball in the hole of another ball is inside but does not fill it") {
  Table t;
  t.put(0, {1, 0, -0.05});
  const game_state_t m = t.after(200);
  CHECK(m.holes[1].inside == 0);
  CHECK(m.holes[1].filled == 0);
  CHECK(m.holes[0].inside == -1);
}

TEST_CASE("A ball that crosses, leaves, or is beside or far below a hole is not in it") {
  Table t;
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0, 0, 0.025), Eigen::Vector3d(0.031, 0, -0.05), Eigen::Vector3d(0, 0, -0.11)}) {
    t.put(0, place);
    CHECK(t.after(300).holes[0].inside == -1);
  }
  for (int bounce = 0; bounce < 5; ++bounce) {
    t.put(0, {0, 0, -0.02});
    CHECK(t.after(80).holes[0].inside == -1);
    t.put(0, {0, 0, 0.02});
    CHECK(t.after(20).holes[0].inside == -1);
  }
}

TEST_CASE("Every change of a game is reported once") {
  Table t;
  CHECK(t.game.take_change());  // the initial state
  t.after(100);
  CHECK(!t.game.take_change());
  t.put(0, {0, 0, -0.05});
  t.after(200);
  CHECK(t.game.take_change());
  CHECK(!t.game.take_change());
}

TEST_CASE("A scene without holes has no game") {
  Game none{{}};
  none.step(sync::sim_time(0), {});
  CHECK(!none.any());
  CHECK(!none.won());
}
