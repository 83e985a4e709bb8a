// Closed-form limits of the movements, and the lines of the program.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "scripts/experiments/answering.h"
#include "scripts/experiments/guided_arm.h"
#include "tests/experiments/quiet_participant.h"

namespace tactus::experiments {

TEST_CASE("A late force of a plate costs its delay, and at most until the contact is seen") {
  observer::PlayerParameters player;
  player.motor_noise_N = 0, player.motor_noise_share = 0;
  Participant p(player, {}, 1);
  const auto time_s = [&](const char* delay_ms) {
    return answered(p, "tapping", {{"difficulty_bit", "2"}, {"force_ms", delay_ms}});
  };
  const double plain = time_s("0");
  CHECK(time_s("20") - plain == Approx(0.020).margin(0.001));
  CHECK(time_s("45") - plain == Approx(0.045).margin(0.001));
  // The force exceeds its floor a few milliseconds after the contact.
  CHECK(time_s("300") - plain == Approx(player.visual_latency_s - player.touch_latency_s).margin(0.006));
  CHECK(time_s("300") == time_s("900"));
}

TEST_CASE("A late picture slows an aimed movement, and equal numbers give equal movements") {
  Participant p = scaled_participant(1);
  double early = 0, late = 0;
  for (std::uint64_t i = 0; i < 10; ++i) {
    early += answered(p, "pointing", {{"difficulty_bit", "4"}, {"lag_ms", "0"}}, i);
    late += answered(p, "pointing", {{"difficulty_bit", "4"}, {"lag_ms", "225"}}, i);
  }
  CHECK(late > 1.2 * early);
  Participant again = scaled_participant(1);
  CHECK(answered(p, "pointing", {{"difficulty_bit", "4"}, {"lag_ms", "75"}}, 3) ==
        answered(again, "pointing", {{"difficulty_bit", "4"}, {"lag_ms", "75"}}, 3));
}

TEST_CASE("Two people bring an object to a place, unless a stiff and late coupling is unstable") {
  Participant p = scaled_participant(1);
  for (std::uint64_t i = 0; i < 3; ++i) {
    CHECK(answered(p, "joint_carry", {}, i, "failed") == 0);
    CHECK(answered(p, "joint_carry", {}, i, "time_s") < 6);
    CHECK(answered(p, "joint_carry", {{"stiffness_N_m", "5000"}, {"force_ms", "100"}, {"limit_s", "4"}}, i,
                   "failed") == 1);
  }
}

TEST_CASE("A body that receives nothing stays, and its error is the mean distance of the target") {
  Participant p = scaled_participant(1);
  double sum = 0;
  int count = 0;
  for (int i = 1000; i < 3000; ++i, ++count) {
    const double w = 2 * std::numbers::pi * i * 1e-3;
    sum += std::abs(40 * std::sin(0.11 * w) + 25 * std::sin(0.23 * w) + 15 * std::sin(0.37 * w));
  }
  CHECK(answered(p, "pursuit", {{"loss_percent", "100"}, {"duration_s", "3"}}) ==
        Approx(sum / count).epsilon(1e-6));
  CHECK(answered(p, "pursuit", {{"duration_s", "6"}}) <
        0.7 * answered(p, "pursuit", {{"loss_percent", "100"}, {"duration_s", "6"}}));
}

TEST_CASE(
    "A guided arm yields to a steady force by force over stiffness, and follows its movement without force") {
  observer::PlayerParameters player;
  GuidedArm arm(player), free(player);
  for (int i = 0; i < 3000; ++i) arm.step(0, 0, 3, 0.001);
  CHECK(arm.place_m() == Approx(3 / (player.stiffness_N_m + 3 * player.stiffness_rise_1_m)).epsilon(1e-3));
  for (int i = 1; i <= 100; ++i) free.step(0.01 * i, 10, 0, 0.001);
  CHECK(free.place_m() == Approx(1.0));
}

TEST_CASE("Wrong lines are refused with one sentence, and change nothing") {
  TrialDesk desk;
  CHECK(desk.answer("trial pointing 0 lag_ms=0 difficulty_bit=2").rfind("error there is no participant", 0) == 0);
  CHECK(desk.answer("participant 3 1") == "ok");
  for (const char* line :
       {"", "participant", "participant -1 1", "participant 3 1 1", "participant 4096 1", "trial",
        "trial pointing", "trial flying 0", "trial pointing x", "trial pointing 0",
        "trial pointing 0 lag_ms=nan difficulty_bit=2", "trial pointing 0 lag_ms=0 difficulty_bit=2 colour=3",
        "trial pointing 0 lag_ms=0 lag_ms=0 difficulty_bit=2", "trial two_events 0 soa_ms=0 first=smell",
        "trial two_events 0 soa_ms=", "trial two_events 0 =1"}) {
    const std::string answer = desk.answer(line);
    INFO(line << ": " << answer);
    CHECK(answer.rfind("error ", 0) == 0);
    CHECK(answer.find('\n') == std::string::npos);
  }
  CHECK(desk.answer("trial two_events 0 soa_ms=5000").rfind("error ", 0) == 0);
  CHECK(desk.answer("trial two_events 0 soa_ms=50").rfind("ok together=", 0) == 0);
}

TEST_CASE("Participants depend on index and seed only, and lie in the published ranges") {
  Participant a(5, 9), b(5, 9), other(6, 9);
  CHECK(a.timing().touch_sd_s == b.timing().touch_sd_s);
  CHECK(a.player().visual_latency_s == b.player().visual_latency_s);
  CHECK(a.timing().touch_sd_s != other.timing().touch_sd_s);
  CHECK(a.partner().visual_latency_s != a.player().visual_latency_s);
  for (std::uint32_t i = 0; i < 200; ++i) {
    const Participant p(i, 2);
    for (const TimingRange& t : timing_ranges()) {
      CHECK(p.timing().*t.field >= t.range.to_si * t.range.low * (t.range.low < 0 ? 1.001 : 0.999));
      CHECK(p.timing().*t.field <= t.range.to_si * t.range.high * 1.001);
    }
  }
}

TEST_CASE("Every property that a paradigm names exists, with its source") {
  const std::string table = properties_table();
  for (const Paradigm& paradigm : paradigms())
    CHECK(table.find(std::string(paradigm.name) + ",") != std::string::npos);
}

}  // namespace tactus::experiments
