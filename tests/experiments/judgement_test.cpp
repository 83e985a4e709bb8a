// Closed-form limits of the judgements: without noise a step at the right place, with endless noise chance.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/experiments/quiet_participant.h"

namespace tactus::experiments {
namespace {

using Settings = std::map<std::string, std::string>;

// Four standard errors of a share of 1,000 answers at chance.
constexpr double kChance = 4 * 0.0158;

Settings with(Settings settings, const std::string& name, double value) {
  settings[name] = std::to_string(value);
  return settings;
}

}  // namespace

TEST_CASE("Without noise the order of two events is right on both sides of the believed latency") {
  for (double error_s : {0.0, 0.02, -0.03}) {
    observer::PlayerParameters player;
    player.lapse = 0, player.proprioceptive_sd_m = 0;
    Timing timing{0, 0, 0, error_s, 0};
    Participant p(player, timing, 1);
    const Settings order{{"task", "order"}, {"first", "touch"}, {"second", "sound"}};
    // A touch whose latency is believed too long by e seems e earlier.
    CHECK(share(p, "two_events", with(order, "soa_ms", -1e3 * error_s + 0.5), 50) == 1);
    CHECK(share(p, "two_events", with(order, "soa_ms", -1e3 * error_s - 0.5), 50) == 0);
    const Settings together{{"task", "synchrony"}, {"first", "touch"}, {"second", "sound"}};
    CHECK(share(p, "two_events", with(together, "soa_ms", -1e3 * error_s), 50) == 1);
    CHECK(share(p, "two_events", with(together, "soa_ms", -1e3 * error_s + 1), 50) == 0);
    CHECK(share(p, "two_events", with(together, "soa_ms", -1e3 * error_s - 1), 50) == 0);
  }
}

TEST_CASE("With endless noise the time of two events is judged at chance") {
  Participant p = scaled_participant(1e7);
  for (const char* task : {"order", "two_interval"}) {
    const Settings s{{"task", task}, {"first", "touch"}, {"second", "sight"}};
    CHECK(share(p, "two_events", with(s, "soa_ms", 100)) == Approx(0.5).margin(kChance));
  }
  const Settings s{{"task", "synchrony"}, {"first", "touch"}, {"second", "sight"}};
  CHECK(share(p, "two_events", with(s, "soa_ms", 300)) ==
        Approx(share(p, "two_events", with(s, "soa_ms", 0))).margin(0.01));
}

TEST_CASE("An own contact has less noise than a felt one, by the predicted time of contact") {
  // Touch 36 ms; prediction 10 mm at 0.3 m/s is 33.3 ms; both 24.5 ms. The order at +40 ms against an exact sound.
  Participant p = scaled_participant(1);
  const auto right = [&](const char* first) {
    return share(p, "two_events", {{"task", "order"}, {"first", first}, {"second", "sound"}, {"soa_ms", "40"}},
                 4000);
  };
  const auto expected = [](double sd) { return 0.5 * std::erfc(-40 / std::hypot(sd, 5) / std::sqrt(2.0)); };
  CHECK(right("touch") == Approx(expected(36)).margin(0.03));
  CHECK(right("action") == Approx(expected(1 / std::hypot(1 / 36.0, 1 / 33.33))).margin(0.03));
}

TEST_CASE("Without noise every delay of a force is recognised, and with endless noise none") {
  Participant sharp = scaled_participant(0), blunt = scaled_participant(kHidesAll);
  for (const char* environment : {"damper", "spring", "inertia"}) {
    const Settings s{{"environment", environment}};
    CHECK(share(sharp, "stroke", with(s, "delay_ms", 2), 20) == 1);
    CHECK(share(sharp, "stroke", with(s, "delay_ms", 0), 400) == Approx(0.5).margin(0.1));
    CHECK(share(blunt, "stroke", with(s, "delay_ms", 40), 400) == Approx(0.5).margin(0.1));
  }
}

TEST_CASE("Without noise the stiffer of two springs is named, and with endless noise at chance") {
  Participant sharp = scaled_participant(0);
  CHECK(share(sharp, "press_spring", {{"comparison_percent", "0.5"}}, 20) == 1);
  CHECK(share(sharp, "press_spring", {{"comparison_percent", "-0.5"}}, 20) == 0);
  Participant blunt = scaled_participant(kHidesAll);
  CHECK(share(blunt, "press_spring", {{"comparison_percent", "20"}}, 400) == Approx(0.5).margin(0.1));
}

TEST_CASE("A late force softens a spring, a late picture stiffens it, and equal delays of a seen press cancel") {
  Participant sharp = scaled_participant(0);
  const auto equality = [](Participant& p, const Settings& s) {
    double low = -90, high = 200;
    for (int i = 0; i < 24; ++i) {
      const double middle = (low + high) / 2;
      (answered(p, "press_spring", with(s, "comparison_percent", middle)) > 0.5 ? high : low) = middle;
    }
    return low;
  };
  CHECK(equality(sharp, {}) == Approx(0).margin(0.01));
  CHECK(equality(sharp, {{"force_ms", "40"}}) < -5);
  observer::PlayerParameters player;
  player.lapse = 0, player.stiffness_weber = 0, player.visual_sd_deg = 0;  // only sight shows the displacement
  Participant seeing(player, {}, 1);
  CHECK(equality(seeing, {{"visual_ms", "40"}}) > 5);
  CHECK(std::abs(equality(seeing, {{"visual_ms", "40"}, {"force_ms", "40"}})) < 3);
  player.visual_sd_deg = 0.12, player.proprioceptive_sd_m = 0;  // only the arm
  Participant feeling(player, {}, 1);
  CHECK(equality(feeling, {{"visual_ms", "40"}}) == Approx(0).margin(0.01));
}

TEST_CASE("Without noise the larger bar is named, and with endless noise at chance") {
  for (const char* cues : {"sight", "touch", "both"}) {
    Participant sharp = scaled_participant(0), blunt = scaled_participant(kHidesAll);
    CHECK(share(sharp, "bar_size", {{"cues", cues}, {"comparison_mm", "55.01"}}, 50) == 1);
    CHECK(share(sharp, "bar_size", {{"cues", cues}, {"comparison_mm", "54.99"}}, 50) == 0);
    CHECK(share(blunt, "bar_size", {{"cues", cues}, {"comparison_mm", "60"}}) == Approx(0.5).margin(kChance));
  }
}

TEST_CASE("A bar with a conflict equals one at the mean of seen and felt size by their reliability") {
  // Two edges of 0.12 degrees at 0.6 m give 1.777 mm, a third of 10 mm is 3.333 mm: weight of sight 0.7787.
  observer::PlayerParameters player;
  player.lapse = 0;
  Participant p(player, {}, 1);
  CHECK(share(p, "bar_size", {{"conflict_mm", "6"}, {"comparison_mm", std::to_string(55 + 6 * (0.7787 - 0.5))}},
              4000) == Approx(0.5).margin(0.032));
}

TEST_CASE("Without noise of the senses a deadband is recognised, and with endless noise none") {
  Participant sharp = scaled_participant(0), blunt = scaled_participant(kHidesAll);
  const Settings s{{"deadband_percent", "5"}, {"duration_s", "1.5"}};
  CHECK(share(sharp, "deadband", s, 20) == 1);
  CHECK(share(blunt, "deadband", s, 400) == Approx(0.5).margin(0.1));
  CHECK(answered(sharp, "deadband", {{"deadband_percent", "0"}}, 0, "saved_percent") < 1);
  CHECK(answered(sharp, "deadband", {{"deadband_percent", "30"}}, 0, "saved_percent") > 90);
}

TEST_CASE(
    "Materials are named at chance when the ringing is not perceived, and always when they differ by more than "
    "the noise") {
  Participant blunt = scaled_participant(1e6);
  double right = 0;
  for (const char* material : {"wood", "plastic", "metal"})
    right += share(blunt, "impact_material", {{"cues", "vibration"}, {"material", material}}) / 3;
  CHECK(right == Approx(1.0 / 3).margin(kChance));
  Participant sharp = scaled_participant(0);
  // A plate that rings freely: metal rings 15 times longer than wood.
  CHECK(share(sharp, "impact_material", {{"cues", "sound"}, {"material", "metal"}, {"support_ms", "5000"}}) >
        0.97);
}

TEST_CASE("The skin cools on a material as in a finite-difference solution") {
  // Skin 33, material 23 degrees; falls after 1 s, and after 10 s.
  const double rows[][4]{{37137, 401, 6.77, 8.65}, {2385, 2.79, 5.042, 6.12}};
  Participant p = scaled_participant(0);
  for (const auto& row : rows) {
    const Settings s{{"first_effusivity", std::to_string(row[0])},
                     {"first_conductivity", std::to_string(row[1])},
                     {"flow_percent", "10"}};
    CHECK(answered(p, "contact_cooling", with(s, "after_s", 1), 0, "fall_K") == Approx(row[2]).margin(0.03));
    CHECK(answered(p, "contact_cooling", with(s, "after_s", 10), 0, "fall_K") == Approx(row[3]).margin(0.03));
  }
}

TEST_CASE("Without noise the cooler material is named, and with endless noise at chance") {
  const Settings s{{"first_effusivity", "519"}, {"first_conductivity", "0.18"}, {"flow_percent", "1"}};
  Participant sharp = scaled_participant(0), blunt = scaled_participant(kHidesAll);
  CHECK(share(sharp, "contact_cooling", s, 50) == 1);
  CHECK(share(blunt, "contact_cooling", with(s, "flow_percent", 40)) == Approx(0.5).margin(kChance));
}

}  // namespace tactus::experiments
