#include "scripts/simulated_player/observer/delay_belief.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "scripts/simulated_player/observer/percept_channel.h"

namespace tactus::observer {

TEST_CASE("The believed delay ends at the natural delay plus the learnt share of the added delay") {
  DelayBelief belief({.natural_s = 0.12, .rate = 0.1, .share = 0.4});
  for (int i = 0; i < 1000; ++i) belief.observe(0.12 + 0.2, 0.02);
  CHECK(belief.believed_s() == Approx(0.12 + 0.4 * 0.2).margin(1e-9));
  CHECK(belief.noticed_s() == Approx(0.6 * 0.2).margin(1e-9));
}

TEST_CASE("Removing the delay returns the belief, so that there is an after-effect at first") {
  DelayBelief belief({.natural_s = 0.12, .rate = 0.1, .share = 0.5});
  for (int i = 0; i < 1000; ++i) belief.observe(0.32, 0);
  belief.observe(0.12, 0);
  CHECK(belief.believed_s() > 0.2);
  for (int i = 0; i < 1000; ++i) belief.observe(0.12, 0);
  CHECK(belief.believed_s() == Approx(0.12).margin(1e-9));
}

TEST_CASE("An effect that never comes teaches nothing") {
  DelayBelief belief({.natural_s = 0.12, .initial_error_s = 0.01});
  belief.observe(std::numeric_limits<double>::infinity(), 0.02);
  belief.observe(std::nan(""), 0.02);
  CHECK(belief.believed_s() == Approx(0.13));
  CHECK(belief.noticed_s() == 0);
}

TEST_CASE("The variability of a delay is learnt apart from the noise of the own judgement") {
  DelayBelief jittery({.natural_s = 0.1, .rate = 0.02}), steady({.natural_s = 0.1, .rate = 0.02});
  for (int i = 0; i < 4000; ++i) {
    const double judgement = i % 2 ? 0.02 : -0.02;
    jittery.observe(0.1 + judgement + (i % 4 < 2 ? 0.05 : -0.05), 0.02);
    steady.observe(0.1 + judgement, 0.02);
  }
  CHECK(jittery.variability_s() == Approx(0.05).epsilon(0.1));
  CHECK(steady.variability_s() < 0.005);
}

TEST_CASE("A percept arrives one natural latency after its presentation, in the order of arrival") {
  PerceptChannel channel(0.1);
  channel.present(0.30, Eigen::Vector3d(2, 0, 0), 0.5);
  channel.present(0.20, Eigen::Vector3d(1, 0, 0), 0.5);
  channel.present(std::numeric_limits<double>::infinity(), Eigen::Vector3d(3, 0, 0), 0.5);
  CHECK_FALSE(channel.take(0.29));
  CHECK(channel.take(0.31)->value.x() == 1);
  CHECK_FALSE(channel.take(0.31));
  CHECK(channel.take(0.41)->value.x() == 2);
  CHECK_FALSE(channel.take(1e9));
}

TEST_CASE("A full channel drops its oldest percept") {
  PerceptChannel channel(0, 2);
  for (int i = 0; i < 5; ++i) channel.present(i, Eigen::Vector3d(i, 0, 0), 1);
  CHECK(channel.take(10)->value.x() == 3);
}

}  // namespace tactus::observer
