// Tests of waiting until a profile is in force in every modality.
#include "scripts/trial_runner/enforcement.h"

#include <catch2/catch.hpp>
#include <tactus/node_health_t.hpp>

#include "tests/times.h"

using namespace tactus;
using namespace tactus::trial_runner;
using tactus::test::at_ms;

namespace {

node_health_t health(const char* node, const char* modality, std::int64_t profile) {
  node_health_t m{};
  m.node = node, m.modality = modality, m.profile = profile;
  return m;
}

sync::ProfileInForce profile(std::int64_t hash) {
  sync::ProfileInForce p;
  p.text = "<profile/>", p.hash = hash, p.generation = hash;
  return p;
}

}  // namespace

TEST_CASE("A profile is in force when every present modality has it, and this is reported once") {
  Enforcement e;
  e.push(health("audio_node", "audio", 0), at_ms(0));
  e.push(health("visual_node", "visual", 0), at_ms(0));
  e.push(health("recorder", "", 0), at_ms(0));
  e.begin(profile(7));
  REQUIRE(e.to_send(at_ms(10)));
  CHECK_FALSE(e.to_send(at_ms(50)));
  CHECK(e.to_send(at_ms(110)));
  e.push(health("audio_node", "audio", 7), at_ms(100));
  CHECK_FALSE(e.take_in_force(at_ms(100)));
  CHECK(e.missing(at_ms(100)) == std::vector<std::string>{"visual_node"});
  e.push(health("visual_node", "visual", 7), at_ms(120));
  CHECK(e.take_in_force(at_ms(121)) == std::vector<std::string>{"audio_node", "visual_node"});
  CHECK_FALSE(e.take_in_force(at_ms(122)));
  CHECK_FALSE(e.to_send(at_ms(1000)));
}

TEST_CASE("A silent modality is not waited for, and without modalities no profile is in force") {
  Enforcement e;
  e.push(health("audio_node", "audio", 0), at_ms(0));
  e.begin(profile(7));
  CHECK_FALSE(e.take_in_force(at_ms(499)));
  CHECK_FALSE(e.take_in_force(at_ms(501)));
  e.push(health("visual_node", "visual", 7), at_ms(600));
  CHECK(e.take_in_force(at_ms(601)) == std::vector<std::string>{"visual_node"});
}

TEST_CASE("The next profile must be confirmed again by every modality") {
  Enforcement e;
  e.push(health("audio_node", "audio", 7), at_ms(0));
  e.begin(profile(7));
  REQUIRE(e.take_in_force(at_ms(1)));
  e.begin(profile(8));
  CHECK_FALSE(e.take_in_force(at_ms(2)));
  CHECK(e.to_send(at_ms(2)));
}
