// Tests of parsing degradation profiles.
#include "sync/degradation/profile.h"

#include <catch2/catch.hpp>

using namespace tactus::sync;

namespace {

Rule rule_of(const std::string& attributes, const std::string& modality = "audio") {
  return parse_profile("<profile><degrade modality=\"" + modality + "\" " + attributes + "/></profile>", "p.xml")
      .rules.at(0);
}

std::string parse_refusal(const std::string& xml) {
  try {
    parse_profile(xml, "p.xml");
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

std::string rule_refusal(const std::string& attributes) {
  return parse_refusal("<profile>\n<degrade modality=\"audio\" " + attributes + "/></profile>");
}

}  // namespace

TEST_CASE("A profile is parsed with its units") {
  const Profile p = parse_profile(R"(<profile name="late sound" seed="7">
    <degrade modality="audio" delay="40ms" jitter="3ms normal" loss="5% burst=3"/>
    <degrade modality="haptic" from="2s" until="1min" material="steel" gain="0.5 force"/>
    <degrade modality="wind" bodies="ball floor" off="true"/>
  </profile>)",
                                  "p.xml");
  CHECK(p.name == "late sound");
  CHECK(p.seed == 7);
  REQUIRE(p.rules.size() == 3);
  const Rule& audio = p.rules[0];
  CHECK(audio.line == 2);
  CHECK(audio.delay->delay_s == Approx(0.040));
  CHECK(audio.delay->kind == DelayKind::kPresentation);
  CHECK(audio.jitter->shape == JitterShape::kNormal);
  CHECK(audio.jitter->scale_s == Approx(0.003));
  CHECK(audio.jitter->keep_order);
  CHECK(audio.loss->share == Approx(0.05));
  CHECK(audio.loss->mean_burst == 3);
  CHECK_FALSE(audio.filtered());
  CHECK(p.rules[1].filtered());
  CHECK(p.rules[1].from_s == 2);
  CHECK(p.rules[1].until_s == Approx(60));
  CHECK(p.rules[1].gain->value == 0.5);
  CHECK((p.rules[2].off && p.rules[2].body_b == "floor"));
}

TEST_CASE("Every operator is parsed") {
  CHECK(rule_of(R"(delay="1ms network")").delay->kind == DelayKind::kNetwork);
  const Rule j = rule_of(R"(jitter="pareto 2ms order=free correlation=0.5")");
  CHECK((j.jitter->shape == JitterShape::kPareto && !j.jitter->keep_order && j.jitter->correlation == 0.5));
  CHECK(rule_of(R"(jitter="trace=1ms,2ms,0.5ms")").jitter->trace_s == std::vector<double>{0.001, 0.002, 0.0005});
  CHECK(rule_of(R"(rate="5Hz phase=20ms")").rate->phase_s == Approx(0.020));
  const auto d = rule_of(R"(deadband="10% force floor=5mN lowpass=20Hz adaptive=0.2s/m")").deadband;
  CHECK((d->fraction == Approx(0.1) && d->quantity == Quantity::kForce && d->floor == Approx(0.005) &&
         d->lowpass_Hz == 20 && d->adaptive_s_m == 0.2));
  CHECK(rule_of(R"(quantise="1cm/s velocity")").quantise->step == Approx(0.01));
  CHECK(rule_of(R"(quantise="10% log floor=1mN")").quantise->ratio == Approx(1.1));
  CHECK(rule_of(R"(bias="-0.1N")").bias->value == -0.1);
  CHECK(rule_of(R"(lowpass="20Hz velocity")").lowpass->quantity == Quantity::kVelocity);
  CHECK(rule_of(R"(freeze="zero")").freeze == Conceal::kZero);
  CHECK(rule_of(R"(loss="1%" conceal="zero")").conceal == Conceal::kZero);
  CHECK(rule_of(R"(duplicate="1%")").duplicate == Approx(0.01));
  CHECK(rule_of(R"(reorder="5% by=10ms")").reorder->by_s == Approx(0.01));
  CHECK(rule_of(R"(skew="200ppm")").skew == Approx(200e-6));
  CHECK(rule_of(R"(wire_loss="2%")").wire_loss == Approx(0.02));
  CHECK(rule_of(R"(frame_rate="20Hz" resolution="50%")", "visual").output.value("resolution") == Approx(0.5));
  CHECK(rule_of(R"(dropout="20ms every=1s")").output.value("dropout") == Approx(0.02));
  CHECK(rule_of(R"(force_step="0.1N")", "haptic").output.value("force_step") == Approx(0.1));
  CHECK(rule_of(R"(response="2s")", "thermal").output.value("response") == 2);
}

TEST_CASE("An invalid profile is rejected as a whole, with line and reason") {
  CHECK_THAT(parse_refusal("no xml"), Catch::StartsWith("p.xml:"));
  CHECK_THAT(parse_refusal("<profile>\n\n<degrade modality=\"audio\""), Catch::StartsWith("p.xml:"));
  CHECK_THAT(parse_refusal("<sdf/>"), Catch::Contains("begins with <profile>"));
  CHECK_THAT(parse_refusal("<profile colour=\"red\"/>"), Catch::Contains("no \"colour\""));
  CHECK_THAT(parse_refusal("<profile seed=\"x\"/>"), Catch::Contains("not a whole number"));
  CHECK_THAT(parse_refusal("<profile>\n<delay/></profile>"), Catch::StartsWith("p.xml:2: <delay> is not known"));
  CHECK_THAT(parse_refusal("<profile>\n<degrade delay=\"1ms\"/></profile>"), Catch::Contains("needs a modality"));
  CHECK_THAT(rule_refusal(""), Catch::Contains("does nothing"));
  CHECK_THAT(rule_refusal("from=\"1s\""), Catch::Contains("does nothing"));
  CHECK_THAT(rule_refusal("delay=\"40mss\""),
             Catch::StartsWith("p.xml:2: delay=\"40mss\": \"mss\" is not a unit of s"));
  CHECK_THAT(rule_refusal("delay=\"-1ms\""), Catch::Contains("between 0 and 60"));
  CHECK_THAT(rule_refusal("delay=\"40ms sideways\""), Catch::Contains("\"sideways\" is not valid here"));
  CHECK_THAT(rule_refusal("delay=\"40ms burst=3\""), Catch::Contains("\"burst=\" is not valid here"));
  CHECK_THAT(rule_refusal("delay=\"\""), Catch::Contains("needs a value"));
  CHECK_THAT(rule_refusal("delai=\"1ms\""), Catch::Contains("no operator \"delai\""));
  CHECK_THAT(rule_refusal("loss=\"90% burst=2\""), Catch::Contains("impossible"));
  CHECK_THAT(rule_refusal("loss=\"nan\""), Catch::Contains("not a number"));
  CHECK_THAT(rule_refusal("freeze=\"maybe\""), Catch::Contains("choose hold or zero"));
  CHECK_THAT(rule_refusal("delay=\"1ms\" from=\"5s\" until=\"5s\""), Catch::Contains("until must be after from"));
  CHECK_THAT(rule_refusal("off=\"true\" bodies=\"ball\""), Catch::Contains("name two bodies"));
  CHECK_THAT(rule_refusal("dropout=\"2s every=1s\""), Catch::Contains("shorter than the time"));
  CHECK_THAT(parse_refusal("<profile><degrade modality=\"a\" off=\"true\"><x/></degrade></profile>"),
             Catch::Contains("only attributes"));
}

TEST_CASE("A profile without rules changes nothing") {
  CHECK(parse_profile("<profile/>", "p.xml").rules.empty());
}
