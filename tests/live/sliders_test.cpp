// Tests of the conversion between sliders and degradation profiles.
#include "scripts/live/sliders.h"

#include <algorithm>
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

TEST_CASE("A value of the profile beyond its slider stays, other sliders work, and no slider moves beyond its range") {
  const std::string beyond = R"(<profile name="far"><degrade modality="audio" delay="5s" rate="2000Hz"/>)"
                             R"(<degrade modality="visual" rate="0.05Hz"/>)"
                             R"(<degrade modality="haptic" stage="force" deadband="150% force resend=20ms"/></profile>)";
  const nlohmann::json shown = degradation_json(beyond)["senses"];
  std::map<std::string, Sliders> at;
  for (const auto& [sense, s] : shown.items())
    at[sense] = {s["delay_ms"].get<double>(), s["rate_Hz"].get<double>(), s["loss"].get<double>(), s["deadband"].get<double>()};
  CHECK(at.at("haptic:force").deadband == Approx(1.5));
  at["audio"].loss = 0.25;
  const auto changed = sync::parse_profile(with_sliders(beyond, at), "changed");
  CHECK(changed.rules[0].delay->delay_s == Approx(5));
  CHECK(changed.rules[0].rate->rate_Hz == Approx(2000));
  CHECK(changed.rules[0].loss->share == Approx(0.25));
  CHECK(changed.rules[1].rate->rate_Hz == Approx(0.05));
  CHECK(changed.rules[2].deadband->fraction == Approx(1.5));
  for (const Sliders& moved : {Sliders{2001, 0, 0}, Sliders{0, 1001, 0}, Sliders{0, 0.05, 0}})
    CHECK_THROWS_AS(with_sliders("", {{"audio", moved}}), std::invalid_argument);
  CHECK_THROWS_AS(with_sliders("", {{"haptic:force", {0, 0, 0, 1.6}}}), std::invalid_argument);
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

TEST_CASE("Each stage has the controls of its descriptor: every choice that its rules may have") {
  const nlohmann::json controls = degradation_json("")["controls"];
  int choices = 0;
  for (const sync::KnownModality& m : sync::known_modalities())
    for (const sync::StageDef& stage : m.stages) {
      const std::string sense = m.name + ":" + stage.name;
      if (stage.kind == sync::StageKind::kInput) {
        CHECK_FALSE(controls.contains(sense));
        continue;
      }
      INFO(sense);
      const std::vector<std::string> attributes = sync::stage_attributes(stage.kind);
      const auto has = [&](const std::string& name) { return std::find(attributes.begin(), attributes.end(), name) != attributes.end(); };
      CHECK(controls[sense]["deadband"] == has("deadband"));
      for (const sync::OperatorChoice& c : sync::operator_choices()) {
        const auto& shown = controls[sense]["choices"];
        const auto at = std::find_if(shown.begin(), shown.end(), [&](const nlohmann::json& j) { return j["name"] == c.name; });
        REQUIRE((at != shown.end()) == has(c.is_word ? c.of : c.name));
        if (at == shown.end()) continue;
        ++choices;
        CHECK((*at)["values"] == c.values);
        // Each value makes a valid profile that shows this value.
        for (const std::string& value : c.values) {
          const std::string text = with_sliders("", {{sense, {.loss = 0.1, .deadband = 0.05, .choices = {{c.name, value}}}}});
          CHECK(degradation_json(text)["senses"][sense]["choices"][c.name] == value);
          CHECK(degradation_json(text)["senses"][sense]["deadband"] == 0.05);
          CHECK(degradation_json(text)["senses"][sense]["more"] == false);
        }
      }
    }
  CHECK(choices >= 6);
  CHECK(controls["haptic:force"]["choices"].size() == 3);
}

TEST_CASE("The deadband of a stage compares what the stage transmits, and its other words stay") {
  const auto deadband = [](const std::string& profile) { return *sync::parse_profile(profile, "p").rules.at(0).deadband; };
  CHECK(deadband(with_sliders("", {{"haptic:action", {.deadband = 0.1}}})).quantity == sync::Quantity::kVelocity);
  CHECK(deadband(with_sliders("", {{"haptic:force", {.deadband = 0.1}}})).quantity == sync::Quantity::kForce);
  const std::string rich = R"(<profile><degrade modality="haptic" stage="action" deadband="10% position floor=1mm lowpass=20Hz adaptive=0.2s/m resend=50ms"/></profile>)";
  CHECK(with_sliders(rich, {{"haptic:action", {.deadband = 0.1}}}).find("floor=1mm lowpass=20Hz") != std::string::npos);
  const sync::DeadbandDef wider = deadband(with_sliders(rich, {{"haptic:action", {.deadband = 0.3}}}));
  CHECK((wider.fraction == Approx(0.3) && wider.floor == Approx(1e-3) && wider.lowpass_Hz == Approx(20) && wider.adaptive_s_m == Approx(0.2)));
  CHECK((wider.resend_s == Approx(0.05) && wider.quantity == sync::Quantity::kPosition));
  // A line ends the low-pass, with which it is refused.
  const sync::DeadbandDef line = deadband(with_sliders(rich, {{"haptic:action", {.deadband = 0.1, .choices = {{"predict", "linear"}}}}}));
  CHECK((line.predictor == sync::Predictor::kLinear && line.lowpass_Hz == 0 && line.resend_s == Approx(0.05)));
  CHECK(sync::parse_profile(with_sliders(rich, {{"haptic:action", {.deadband = 0.0}}}), "p").rules.empty());
}

TEST_CASE("A choice without its slider, and one that a message does not name, change nothing") {
  CHECK(sync::parse_profile(with_sliders("", {{"haptic:force", {.deadband = 0.0, .choices = {{"predict", "linear"}, {"conceal", "zero"}}}}}), "p").rules.empty());
  const std::string codec = R"(<profile><degrade modality="haptic" stage="force" deadband="5% force predict=linear" delay="20ms" passivity="tdpa"/></profile>)";
  const sync::Rule kept = sync::parse_profile(with_sliders(codec, {{"haptic:force", {.delay_ms = 40}}}), "p").rules.at(0);
  CHECK((kept.passivity == sync::Passivity::kTdpa && kept.deadband->predictor == sync::Predictor::kLinear && kept.delay->delay_s == Approx(0.04)));
  CHECK_FALSE(sync::parse_profile(with_sliders(codec, {{"haptic:force", {.delay_ms = 20, .choices = {{"passivity", "none"}}}}}), "p").rules.at(0).passivity);
  CHECK_THROWS_AS(with_sliders("", {{"haptic:force", {.choices = {{"passivity", "magic"}}}}}), std::invalid_argument);
  // The input has no such controls.
  CHECK(sync::parse_profile(with_sliders("", {{"audio", {.deadband = 0.2, .choices = {{"passivity", "tdpa"}}}}}), "p").rules.empty());
}
