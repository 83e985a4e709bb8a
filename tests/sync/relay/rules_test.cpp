// Tests of parsing the rules of a relay.
#include "sync/relay/rules.h"

#include <catch2/catch.hpp>

using namespace tactus;
using namespace tactus::sync;

namespace {

std::string refusal(const std::string& xml) {
  try {
    parse_relay_rules(xml, "rules.xml");
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "nothing was refused";
}

std::string within(const std::string& pass) { return "<relay>\n" + pass + "\n</relay>"; }

}  // namespace

TEST_CASE("Relay rules are parsed with channel, rate, deadband and priority") {
  const RelayRules rules = parse_relay_rules(R"(<?xml version="1.0"?>
<!-- of a test -->
<relay>
  <pass channel="CONTACT_EVENTS" first="true"/>
  <pass channel="TOOL_STATE" rate="60Hz" deadband="10% velocity"/>
</relay>)",
                                             "rules.xml");
  REQUIRE(rules.all().size() == 2);
  REQUIRE(rules.find("CONTACT_EVENTS"));
  CHECK(rules.find("CONTACT_EVENTS")->first);
  CHECK_FALSE(rules.find("CONTACT_EVENTS")->decimates());
  const PassRule* tool = rules.find("TOOL_STATE");
  REQUIRE(tool);
  CHECK(tool->line == 5);
  CHECK(tool->thinning.rate->rate_Hz == 60);
  CHECK(tool->thinning.deadband->fraction == Approx(0.1));
  CHECK(rules.find("TOUCH_MODEL") == nullptr);
}

TEST_CASE("Invalid relay rules are rejected with their line") {
  CHECK(refusal("").find("rules.xml:1: this is not XML") == 0);
  CHECK(refusal("<relay><pass></relay>").find("rules.xml:1: this is not XML") == 0);
  CHECK(refusal("<profile/>") == "rules.xml:1: rules of a relay begin with <relay>");
  CHECK(refusal("<relay>\n</relay>").find("pass no channel") != std::string::npos);
  CHECK(refusal("<relay name='a'/>") == "rules.xml:1: <relay> has no name");
  CHECK(refusal(within("<pass/>")).find("rules.xml:2: a <pass> needs a channel") == 0);
  CHECK(refusal(within("<pass channel='CONTACT_EVENT'/>"))
            .find("there is no channel CONTACT_EVENT; did you mean CONTACT_EVENTS") != std::string::npos);
  CHECK(refusal(within("<pass channel='PRESENTED' rate='5Hz'/>")).find("contains each item once") !=
        std::string::npos);
  CHECK(refusal(within("<pass channel='TOOL_STATE' deadband='10% predict=linear'/>")).find("needs a receiver that predicts") != std::string::npos);
  CHECK(refusal(within("<pass channel='NODE_HEALTH' deadband='10%'/>"))
            .find("cannot compare messages of NODE_HEALTH") != std::string::npos);
  CHECK(refusal(within("<pass channel='TOOL_STATE' rate='60'/>")).find("has no unit") != std::string::npos);
  CHECK(refusal(within("<pass channel='TOOL_STATE' delay='60ms'/>")).find("a <pass> has no delay") !=
        std::string::npos);
  CHECK(refusal(within("<pass channel='TOOL_STATE' first='yes'/>")).find("neither true nor false") !=
        std::string::npos);
  CHECK(refusal(within("<pass channel='TOOL_STATE'/>\n<pass channel='TOOL_STATE'/>")) ==
        "rules.xml:3: TOOL_STATE passes by line 2 already; remove one");
  CHECK(refusal(within("<drop channel='TOOL_STATE'/>")) ==
        "rules.xml:2: <relay> holds no <drop>; it holds <pass .../>");
  CHECK(refusal(within("all of it")).find("contains only <pass .../>") != std::string::npos);
  CHECK(refusal(within("<pass channel='TOOL_STATE'>x</pass>")).find("a <pass> has no content") !=
        std::string::npos);
  CHECK(refusal("<relay><pass channel='TOOL_STATE'/></relay><relay/>").find("rules.xml:1:") == 0);
  const std::string whole = within("<pass channel='TOOL_STATE'/>");
  CHECK(refusal(whole + std::string(1, '\0')).find("rules.xml:3: there is a NUL") == 0);
}
