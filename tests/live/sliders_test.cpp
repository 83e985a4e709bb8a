// Tests of the conversion between sliders and degradation profiles.
#include "scripts/live/sliders.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "sync/degradation/profile.h"

using namespace tactus;
using namespace tactus::live;

namespace {

const std::string kRich = R"(<profile name="late sound" seed="7">
  <!-- why -->
  <degrade modality="audio" delay="40ms network" jitter="3ms normal" loss="5% burst=3"/>
  <degrade modality="audio" from="2s" until="3s" loss="100%"/>
  <degrade modality="visual" material="steel" delay="20ms"/>
  <degrade modality="haptic" rate="50Hz phase=5ms"/>
</profile>)";

std::map<std::string, Sliders> sliders_of(const std::string& profile) {
  std::map<std::string, Sliders> out;
  const nlohmann::json shown = degradation_json(profile)["senses"];
  for (const auto& [sense, s] : shown.items())
    out[sense] = {s["delay_ms"].get<double>(), s["rate_Hz"].get<double>(), s["loss"].get<double>()};
  return out;
}

bool same_positions(const Sliders& a, const Sliders& b) {
  return a.delay_ms == Approx(b.delay_ms) && a.rate_Hz == Approx(b.rate_Hz) && a.loss == Approx(b.loss);
}

}  // namespace

TEST_CASE("Sliders show the unconditional operators of a profile, and that it has others") {
  const auto at = sliders_of(kRich);
  const nlohmann::json shown = degradation_json(kRich)["senses"];
  CHECK(same_positions(at.at("audio"), {40, 0, 0.05}));
  CHECK(same_positions(at.at("haptic"), {0, 50, 0}));
  CHECK(same_positions(at.at("visual"), {0, 0, 0}));
  CHECK(shown["audio"]["more"] == true);
  CHECK(shown["visual"]["more"] == true);
  CHECK(shown["haptic"]["more"] == false);
  CHECK(degradation_json("")["senses"].empty());
  CHECK(degradation_json(kRich)["name"] == "late sound");
  CHECK(degradation_json(kRich)["senses"]["audio"]["delay_ms"] == 40);
  CHECK(degradation_json("")["name"] == "");
  CHECK_THROWS_AS(degradation_json("<profile"), std::invalid_argument);
}

TEST_CASE("A slider changes its own operator, and the rest of the profile in force stays") {
  auto at = sliders_of(kRich);
  at["audio"].delay_ms = 90;
  const auto changed = sync::parse_profile(with_sliders(kRich, at), "changed");
  CHECK(changed.seed == 7);
  CHECK(changed.name == "late sound, changed in the live page");
  REQUIRE(changed.rules.size() == 4);
  const sync::Rule& audio = changed.rules[0];
  CHECK(audio.delay->delay_s == Approx(0.09));
  CHECK(audio.delay->kind == sync::DelayKind::kNetwork);
  CHECK(audio.jitter);
  CHECK(audio.loss->share == Approx(0.05));
  CHECK(audio.loss->mean_burst == Approx(3));
  CHECK(changed.rules[1].loss->share == 1);
  CHECK(changed.rules[2].material == "steel");
  CHECK(changed.rules[3].rate->phase_s == Approx(0.005));

  SECTION("a burst and a phase stay while they are possible") {
    at["audio"].loss = 0.2;
    at["haptic"].rate_Hz = 100;
    auto p = sync::parse_profile(with_sliders(kRich, at), "p");
    CHECK(p.rules[0].loss->mean_burst == Approx(3));
    CHECK(p.rules[3].rate->phase_s == Approx(0.005));
    at["audio"].loss = 1;
    at["haptic"].rate_Hz = 500;
    p = sync::parse_profile(with_sliders(kRich, at), "p");
    CHECK(p.rules[0].loss->mean_burst == 0);
    CHECK(p.rules[3].rate->rate_Hz == Approx(500));
  }
  SECTION("an element without operators is removed") {
    at["haptic"].rate_Hz = 0;
    CHECK(sync::parse_profile(with_sliders(kRich, at), "p").rules.size() == 3);
  }
  SECTION("the name is marked as changed once") {
    const std::string again = with_sliders(with_sliders(kRich, at), {{"audio", {10, 0, 0}}});
    CHECK(sync::parse_profile(again, "again").name == "late sound, changed in the live page");
  }
}

TEST_CASE("All slider positions give a valid profile, which sets the sliders to the same positions") {
  std::mt19937 random(5);
  const auto share = [&] { return random() % 4 == 0 ? 0.0 : static_cast<double>(random() % 1001) / 1000; };
  for (int i = 0; i < 2000; ++i) {
    std::map<std::string, Sliders> at;
    for (const char* sense : {"audio", "haptic", "visual", "thermal", "wind"})
      if (random() % 3) at[sense] = {share() * 2000, random() % 2 ? 0 : 0.1 + share() * 999.9, share()};
    const std::string text = with_sliders(i % 2 ? kRich : "", at);
    INFO(text);
    const auto shown = sliders_of(text);
    for (const auto& [sense, s] : at) {
      const bool nothing = s.delay_ms == 0 && s.rate_Hz == 0 && s.loss == 0;
      if (nothing && !shown.contains(sense)) continue;
      REQUIRE(shown.contains(sense));
      REQUIRE(same_positions(shown.at(sense), s));
    }
    REQUIRE(with_sliders(text, at) == text);  // unchanged sliders leave the profile unchanged
  }
}

TEST_CASE("Each stage of touch has sliders of its own, which change the rules of that stage only") {
  const std::string profile =
      "<profile name=\"stages\"><degrade modality=\"haptic\" delay=\"20ms\"/><degrade modality=\"haptic\" stage=\"force\" "
      "delay=\"36ms\" gain=\"0.5\"/><degrade modality=\"haptic\" stage=\"model\" loss=\"5%\"/></profile>";
  const nlohmann::json shown = degradation_json(profile);
  CHECK(shown["stages"] == nlohmann::json({"haptic:action", "haptic:force", "haptic:percept"}));
  CHECK(shown["senses"]["haptic:force"]["delay_ms"].get<double>() == Approx(36));
  CHECK(shown["senses"]["haptic:force"]["more"] == true);
  CHECK(shown["senses"]["haptic"]["delay_ms"].get<double>() == Approx(20));
  CHECK(shown["senses"]["haptic"]["loss"] == 0.05);
  CHECK_FALSE(shown["senses"].contains("haptic:percept"));
  auto at = sliders_of(profile);
  at["haptic:force"].delay_ms = 72;
  at["haptic:percept"] = {100, 0, 0};
  at["haptic:action"] = {0, 0, 0.1};
  const std::string changed = with_sliders(profile, at);
  const nlohmann::json again = degradation_json(changed)["senses"];
  CHECK(again["haptic"]["delay_ms"].get<double>() == Approx(20));
  CHECK(again["haptic:force"]["delay_ms"].get<double>() == Approx(72));
  CHECK(again["haptic:percept"]["delay_ms"].get<double>() == Approx(100));
  CHECK(again["haptic:action"]["loss"] == 0.1);
  at["haptic:percept"] = at["haptic:action"] = {};
  const auto without = sync::parse_profile(with_sliders(changed, at), "without");
  CHECK(without.rules.size() == 3);
}
