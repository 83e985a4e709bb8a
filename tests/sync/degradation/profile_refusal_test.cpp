// Tests of malformed profiles: each is rejected as a whole, with a message.
#include <catch2/catch.hpp>

#include "sync/degradation/profile.h"

using namespace tactus::sync;
using Catch::Contains;
using Catch::StartsWith;

namespace {

std::string refusal(const std::string& xml) {
  try {
    parse_profile(xml, "p.xml");
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

std::string refusal_of(const std::string& attributes, const std::string& modality = "audio") {
  return refusal("<profile>\n<degrade modality=\"" + modality + "\" " + attributes + "/></profile>");
}

}  // namespace

TEST_CASE("Text between elements is rejected with its line") {
  CHECK_THAT(refusal("<profile>\n\ndegrade modality=\"audio\" off=\"true\"\n</profile>"),
             StartsWith("p.xml:3: ") && Contains("no text"));
  CHECK_THAT(refusal("<profile>\n<degrade modality=\"audio\" off=\"true\"/>\n/>\n</profile>"),
             StartsWith("p.xml:3: "));
  CHECK_THAT(refusal("<profile>\n<degrade modality=\"audio\" off=\"true\">\nloss=\"5%\"</degrade></profile>"),
             StartsWith("p.xml:3: ") && Contains("only attributes"));
  CHECK_THAT(refusal("<profile><![CDATA[<degrade/>]]></profile>"), Contains("no text"));
  CHECK_THAT(refusal("<profile><!ELEMENT degrade></profile>"), StartsWith("p.xml:1: "));
  CHECK(refusal("\n<!-- before --><profile>\n<!-- within -->\n<degrade modality=\"audio\" off=\"true\">"
                "<!-- and here --></degrade></profile>\n<!-- after -->\n")
            .empty());
}

TEST_CASE("Only comments are allowed beside the one <profile> of a file") {
  const std::string profile = "<profile/>\n";
  CHECK_THAT(refusal(profile + profile), StartsWith("p.xml:2: ") && Contains("one <profile>"));
  CHECK_THAT(refusal(profile + "<sdf/>"), StartsWith("p.xml:2: "));
  CHECK_THAT(refusal(profile + "rest"), StartsWith("p.xml:2: "));
  CHECK_THAT(refusal("rest" + profile), StartsWith("p.xml:1: "));
  CHECK_THAT(refusal("<!DOCTYPE profile>" + profile), StartsWith("p.xml:1: "));
  CHECK(refusal("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + profile).empty());
}

TEST_CASE("A profile with an encoding other than UTF-8 is rejected") {
  for (const char* encoding : {"foo", "UTF-32", "utf-16", "ISO-8859-1"})
    CHECK_THAT(refusal(std::string("<?xml version=\"1.0\" encoding=\"") + encoding + "\"?>\n<profile/>"),
               StartsWith("p.xml:1: ") && Contains("UTF-8"));
  CHECK(refusal("<?xml version='1.0' encoding='utf-8'?><profile/>").empty());
}

TEST_CASE("A seed that is not an unsigned 64-bit integer is rejected") {
  for (const char* seed : {"-1", "7abc", "1.5", "", " 7", "+7", "0x10", "18446744073709551616", "1e3"})
    CHECK_THAT(refusal(std::string("<profile\nseed=\"") + seed + "\"/>"),
               StartsWith("p.xml:1: seed=") && Contains("not a whole number"));
  CHECK(parse_profile("<profile seed=\"18446744073709551615\"/>", "p.xml").seed == UINT64_MAX);
  CHECK(parse_profile("<profile seed=\"0\"/>", "p.xml").seed == 0);
}

TEST_CASE("Duplicate options are rejected") {
  CHECK_THAT(refusal_of("loss=\"5% burst=3 burst=9\""),
             StartsWith("p.xml:2: loss=") && Contains("\"burst=\" is given twice"));
  CHECK_THAT(refusal_of("loss=\"5% burst=3 burst=3\""), Contains("twice"));
  CHECK_THAT(refusal_of("delay=\"40ms network network\""), Contains("\"network\" is given twice"));
  CHECK_THAT(refusal_of("delay=\"40ms 40ms\""), Contains("twice"));
}

TEST_CASE("Contradictory options are rejected") {
  CHECK_THAT(refusal_of("delay=\"40ms network presentation\""), Contains("contradict"));
  CHECK_THAT(refusal_of("jitter=\"1ms normal uniform\""), Contains("contradict"));
  CHECK_THAT(refusal_of("gain=\"2 force velocity\""), Contains("contradict"));
  CHECK_THAT(refusal_of("freeze=\"hold zero\""), Contains("contradict"));
  CHECK_THAT(refusal_of("off=\"true false\""), Contains("contradict"));
  CHECK_THAT(refusal_of("jitter=\"normal trace=1ms,2ms\""),
             Contains("a trace already defines shape and correlation"));
  CHECK_THAT(refusal_of("jitter=\"trace=1ms,2ms correlation=0.5\""),
             Contains("a trace already defines shape and correlation"));
  CHECK_THAT(refusal_of("jitter=\"3ms trace=1ms\""), Contains("\"3ms\" is not valid here"));
}

TEST_CASE("A trace without delays is rejected") {
  for (const char* trace : {"trace=", "3ms trace=", "trace=1ms,", "trace=,1ms", "trace=1ms,,2ms"})
    CHECK_THAT(refusal_of(std::string("jitter=\"") + trace + "\""), Contains("not a number"));
}

TEST_CASE("A value with a dimension requires its unit, except 0") {
  for (const char* bare :
       {"delay=\"40\"", "jitter=\"3 normal\"", "jitter=\"trace=1ms,2\"", "rate=\"5\"", "rate=\"5Hz phase=1\"",
        "from=\"2\" off=\"true\"", "until=\"10\" off=\"true\"", "bias=\"0.1\"", "bias=\"-1e-1\"", "lowpass=\"20\"",
        "quantise=\"0.1\"", "quantise=\"10% log floor=1\"", "deadband=\"10% floor=1\"",
        "deadband=\"10% adaptive=0.2\"", "reorder=\"5% by=1\"", "dropout=\"1\"", "dropout=\"20ms every=1\"",
        "delay=\"40 ms\""})
    CHECK_THAT(refusal_of(bare), StartsWith("p.xml:2: ") && Contains("has no unit"));
  CHECK_THAT(refusal_of("delay=\"40\""), Contains("as in 40s"));
  for (const char* fine : {"delay=\"0\"", "delay=\"0.0 network\"", "from=\"0\" off=\"true\"", "gain=\"0.5\"",
                           "loss=\"0.05 burst=3\"", "jitter=\"trace=0,1ms\"", "skew=\"0.001\""})
    CHECK(refusal_of(fine) == "");
}

TEST_CASE("A jitter without the delay that it needs is rejected with the reason") {
  CHECK_THAT(refusal_of("jitter=\"3ms normal\""), StartsWith("p.xml:2: ") && Contains("a delay of at least 9ms, three standard deviations") &&
                                                      Contains("delay=\"9ms network\"") && Contains("1.2ms on average") && Contains("only 1.75ms"));
  CHECK_THAT(refusal_of("jitter=\"10ms uniform\" delay=\"9ms\""), Contains("at least 10ms, the half width"));
  CHECK_THAT(refusal_of("delay=\"8.9ms network\" jitter=\"3ms normal\""), Contains("at least 9ms"));
  for (const char* fine : {"delay=\"9ms\" jitter=\"3ms normal\"", "jitter=\"3ms normal\" delay=\"9ms network\"", "jitter=\"10ms\" delay=\"10ms\"",
                           "jitter=\"3ms pareto\"", "jitter=\"trace=1ms,2ms\"", "jitter=\"0 normal\"", "jitter=\"0.1ms normal\" delay=\"0.3ms\""})
    CHECK(refusal_of(fine) == "");
}

TEST_CASE("An operator on a quantity that a modality does not receive is rejected with the reason") {
  for (const char* force : {"quantise=\"0.1N\"", "gain=\"0.5\"", "bias=\"0.1N\"", "lowpass=\"20Hz\"", "deadband=\"10% force\""}) {
    CHECK_THAT(refusal_of(force, "visual"), StartsWith("p.xml:2: ") && Contains("of force has no effect on visual: vision receives positions"));
    CHECK(refusal_of(force, "thermal") == "");
  }
  CHECK(refusal_of("deadband=\"10% force\"", "haptic") == "");
  for (const char* force : {"quantise=\"0.1N\"", "bias=\"0.1N\"", "lowpass=\"20Hz\"", "lowpass=\"20Hz force\""}) {
    CHECK_THAT(refusal_of(force, "haptic"), StartsWith("p.xml:2: ") && Contains("no effect on haptic"));
    CHECK(refusal_of(force, "audio") == "");
  }
  for (const char* fine : {"quantise=\"1mm position\"", "lowpass=\"20Hz velocity\"", "gain=\"0.5\"", "force_step=\"0.1N\""})
    CHECK(refusal_of(fine, "haptic") == "");
}

TEST_CASE("A profile with a NUL byte is rejected with its line") {
  const std::string cut{"<profile/>\n\0<!-- lost -->", 25};
  CHECK_THAT(refusal(cut), StartsWith("p.xml:2: ") && Contains("NUL"));
  CHECK_THAT(refusal("<profile/>" + std::string(1, '\0')), StartsWith("p.xml:1: ") && Contains("NUL"));
}

TEST_CASE("A material without a name is rejected") {
  CHECK_THAT(refusal_of("material=\"\" off=\"true\""), Contains("names no material"));
}

TEST_CASE("A frame rate below 2 Hz is rejected") {
  CHECK_THAT(refusal_of("frame_rate=\"1.9Hz\"", "visual"), Contains("between 2 and 240 Hz"));
  CHECK(refusal_of("frame_rate=\"2Hz\"", "visual").empty());
}

TEST_CASE("Operators of another known modality are rejected, an unknown modality accepts any") {
  CHECK_THAT(refusal_of("frame_rate=\"20Hz\"", "audio"),
             StartsWith("p.xml:2: audio has no frame_rate, which only visual has"));
  CHECK_THAT(refusal_of("delay=\"1ms\" force_step=\"1N\"", "thermal"),
             Contains("thermal has no force_step, which only haptic has"));
  CHECK_THAT(refusal_of("dropout=\"20ms\"", "haptic"), Contains("which only audio has"));
  CHECK_THAT(refusal_of("response=\"2s\"", "visual"), Contains("which only thermal has"));
  CHECK(refusal_of("frame_rate=\"20Hz\" response=\"2s\"", "wind").empty());
}

TEST_CASE("A node parses the operators that it declares, and accepts others without a value") {
  const DeclaredOutput wind{"wind", {{"response", "s", 0.1, 5, ""}, {"swirl", "Hz", 1, 9, ""}}};
  const std::string rule = "<profile><degrade modality=\"wind\" swirl=\"2Hz\" hum=\"3\"/></profile>";
  const OutputValues output = parse_profile(rule, "p.xml", wind).rules.front().output;
  CHECK(output.value("swirl") == 2);
  CHECK(output.operators() == std::vector<std::string>{"swirl", "hum"});
  CHECK_NOTHROW(parse_profile(rule, "p.xml"));  // without the operators of the node, any name is accepted
  CHECK_THROWS_WITH(parse_profile("<profile><degrade modality=\"wind\" swirl=\"20Hz\"/></profile>", "p.xml", wind),
                    Contains("between 1 and 9 Hz"));
}
