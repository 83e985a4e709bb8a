// Tests of the quality ladder under constant and changing load.
#include "sync/node/quality.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr Nanoseconds kBudget{10'000'000};
constexpr int kSteps = 4;
constexpr int kCalm = QualityLadder::kCalmTicks;
constexpr int kWindow = QualityLadder::kWindow;  // older ticks have no effect

// Ticks with the load `share_of_budget(step, tick)`; counts the changes of step.
struct Ticking {
  QualityLadder ladder{kSteps, kBudget};
  std::function<double(int step, int tick)> share_of_budget;
  int tick = 0, changes = 0;

  void run(int ticks) {
    for (const int end = tick + ticks; tick < end; ++tick) {
      const int before = ladder.step();
      ladder.add(from_seconds(share_of_budget(before, tick) * to_seconds(kBudget)));
      changes += std::abs(ladder.step() - before);
    }
  }
};

// Each step costs `ratio` times less than the one before.
double share(double full, double ratio, int step) { return full / std::pow(ratio, step); }

}  // namespace

TEST_CASE("A constant overload ends at the first fitting step within half a second") {
  const double full = GENERATE(0.3, 0.8, 0.9, 1.0, 1.3, 2.0, 3.5, 100.0);
  const double ratio = GENERATE(1.2, 1.5, 2.0, 4.0);
  int first_fit = 0;
  while (first_fit + 1 < kSteps && share(full, ratio, first_fit) > QualityLadder::kHigh) ++first_fit;
  Ticking t;
  t.share_of_budget = [&](int step, int) { return share(full, ratio, step); };
  t.run(30);
  CHECK(t.ladder.step() == first_fit);
  CHECK(t.changes == first_fit);
  t.run(kCalm);
  CHECK(t.ladder.step() == first_fit);
}

TEST_CASE("A slowly growing load stays within its budget while a cheaper step fits") {
  Ticking t;
  double worst = 0;
  t.share_of_budget = [&](int step, int tick) {
    const double used = share(0.5 + 1e-3 * tick, 1.6, step);
    worst = std::max(worst, used);
    return used;
  };
  t.run(1500);
  CHECK(t.ladder.step() == 2);
  CHECK(worst < 1);
}

TEST_CASE("The ladder returns to full quality when the load ends") {
  // Also in the tick in which a step was left, when the cost of the better step can only be estimated wrong.
  const int gone_at = GENERATE(range(1, 60));
  Ticking t;
  t.share_of_budget = [&](int step, int tick) { return share(tick < gone_at ? 3.0 : 0.2, 1.5, step); };
  t.run(gone_at);
  t.run((kSteps - 1) * (kCalm * QualityLadder::kTryAfter + kWindow));
  CHECK(t.ladder.step() == 0);
}

TEST_CASE("A step that a load required is left after the calm time") {
  Ticking t;
  t.share_of_budget = [&](int step, int tick) { return share(tick < 600 ? 1.2 : 0.4, 1.6, step); };
  t.run(600);
  REQUIRE(t.ladder.step() == 1);
  t.run(kCalm - 1);
  CHECK(t.ladder.step() == 1);
  t.run(kWindow);
  CHECK(t.ladder.step() == 0);
}

TEST_CASE("A constant load causes no oscillation, as failed attempts become rarer") {
  const double ratio = GENERATE(1.0, 1.2, 1.5, 2.0, 3.0, 100.0);
  const double noise = GENERATE(0.0, 0.05, 0.2);
  for (double full = 0.3; full < 8; full *= 1.31) {
    std::mt19937 random(5);
    std::normal_distribution<double> factor(1, noise);
    Ticking t;
    t.share_of_budget = [&](int step, int) { return share(full, ratio, step) * std::abs(factor(random)); };
    t.run(100);
    t.changes = 0;
    t.run(60 * 600);  // ten minutes
    // Spare times of 8 s, then 16 s, ... allow six attempts in ten minutes, each up and down, after the first step down. Where the load
    // itself varies by a fifth from tick to tick, at the limit of the budget: less than one change in 20 s.
    INFO("full " << full << " ratio " << ratio << " noise " << noise);
    CHECK(t.changes <= (noise > 0.1 ? 30 : 1 + 2 * 6));
  }
}

TEST_CASE("A single outlier changes no step") {
  const int at = GENERATE(0, 3, 7, 8, 12, 15, 16, 40, 300);
  const double rest = GENERATE(0.2, 0.69, 0.84);
  Ticking t;
  t.share_of_budget = [&](int, int tick) { return tick == at ? 200.0 : rest; };
  t.run(400);
  CHECK(t.changes == 0);
  SECTION("an outlier every quarter of a second changes no step") {
    t.share_of_budget = [&](int, int tick) { return tick % 15 == 0 ? 200.0 : rest; };
    t.run(4000);
    CHECK(t.changes == 0);
  }
}

TEST_CASE("The waiting time doubles after each failed step up and resets after a successful one") {
  Ticking t;
  // Step 1 seems to leave spare time; step 0 never fits.
  t.share_of_budget = [&](int step, int) { return step == 0 ? 2.0 : 0.1; };
  std::vector<int> tries;
  for (int i = 0; i < 12'000; ++i) {
    const int before = t.ladder.step();
    t.run(1);
    if (before == 1 && t.ladder.step() == 0) tries.push_back(t.tick);
  }
  REQUIRE(tries.size() >= 4);
  for (std::size_t i = 2; i < tries.size(); ++i)
    CHECK(tries[i] - tries[i - 1] == Approx(2 * (tries[i - 1] - tries[i - 2])).margin(30));
  // The load ends and full quality holds for long. A new load and its end then give the same times as the first one.
  t.share_of_budget = [](int, int) { return 0.1; };
  t.run(200'000);
  REQUIRE(t.ladder.step() == 0);
  t.share_of_budget = [](int step, int) { return step == 0 ? 1.2 : 0.6; };
  t.run(100);
  REQUIRE(t.ladder.step() == 1);
  t.share_of_budget = [](int step, int) { return step == 0 ? 0.4 : 0.2; };
  t.run(kCalm + kWindow);
  CHECK(t.ladder.step() == 0);
}

TEST_CASE("A ladder with one step stays on it, and an invalid number of steps is clamped") {
  for (const int steps : {-3, 0, 1, 2, 100}) {
    QualityLadder ladder(steps, kBudget);
    for (int i = 0; i < 2000; ++i) ladder.add(3 * kBudget);
    CHECK(ladder.step() == ladder.steps() - 1);
    CHECK(ladder.steps() == std::clamp(steps, 1, QualityLadder::kMaxSteps));
  }
}

TEST_CASE("A ladder that starts with measured costs is at the step that the same costs would lead it to") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> full(0.1, 6), ratio(1, 3);
  for (int trial = 0; trial < 200; ++trial) {
    const double f = full(random), r = ratio(random);
    std::vector<Nanoseconds> costs;
    for (int step = 0; step < kSteps; ++step) costs.push_back(from_seconds(share(f, r, step) * to_seconds(kBudget)));
    Ticking found, started;
    found.share_of_budget = started.share_of_budget = [&](int step, int) { return share(f, r, step); };
    found.run(30);
    started.ladder.start(costs);
    INFO("full " << f << " ratio " << r);
    CHECK(started.ladder.step() == found.ladder.step());
    started.run(30);
    CHECK(started.changes == 0);
  }
}

TEST_CASE("A ladder that starts with some costs, none or too many stays within its steps") {
  for (const std::size_t known : {0u, 1u, 2u, 20u}) {
    QualityLadder ladder(kSteps, kBudget);
    ladder.start(std::vector<Nanoseconds>(known, 2 * kBudget));
    CHECK(ladder.step() == std::clamp(static_cast<int>(known) - 1, 0, kSteps - 1));
  }
}

TEST_CASE("A ladder that starts at a cheaper step returns to full quality when the load ends") {
  Ticking t;
  t.share_of_budget = [&](int step, int) { return share(0.2, 1.5, step); };
  t.ladder.start(std::vector<Nanoseconds>(kSteps, 3 * kBudget));
  REQUIRE(t.ladder.step() == kSteps - 1);
  t.run((kSteps - 1) * (kCalm * QualityLadder::kTryAfter + kWindow));
  CHECK(t.ladder.step() == 0);
}
