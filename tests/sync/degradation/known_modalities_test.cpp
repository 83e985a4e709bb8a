// Tests of the tables of modalities and their operators.
#include "sync/degradation/known_modalities.h"

#include <catch2/catch.hpp>

using namespace tactus::sync;
using Catch::Contains;

namespace {

constexpr const char* kTable =
    "what,name,kind,unit,min,max,default,meaning\n"
    "modality,smell,slow,,2,,,Smell\n"
    "operator,strength,min,1,0.01,1,,Factor on it\n"
    "\n"
    "what,name,kind,unit,min,max,default,meaning\n"
    "modality,wind,local,,1,,,Wind\n"
    "operator,swirl,sum,s,0.1,5,,\"How long, at the most\"\n"
    "without,bias,velocity,,,,,wind has no velocity\n"
    "pair,every,above,s,0.2,9,3,it must be shorter than every=\n";

}  // namespace

TEST_CASE("Modality tables are parsed in the order of their positions, with operators and pairs") {
  const auto modalities = parse_modalities(kTable);
  REQUIRE(modalities.size() == 2);
  CHECK(modalities[0].name == "wind");
  CHECK(modalities[0].kind == PlayoutKind::kLocal);
  CHECK(modalities[1].kind == PlayoutKind::kSlow);
  REQUIRE(modalities[0].operators.size() == 1);
  const OutputOperator& swirl = modalities[0].operators.front();
  CHECK((swirl.unit == "s" && swirl.min == 0.1 && swirl.max == 5 && swirl.combine == Combine::kSum));
  CHECK(swirl.meaning == "How long, at the most");
  REQUIRE(modalities[0].without_effect.size() == 1);
  const WithoutEffect& bias = modalities[0].without_effect.front();
  CHECK((bias.name == "bias" && bias.quantity == Quantity::kVelocity && bias.reason == "wind has no velocity"));
  REQUIRE(swirl.pairs.size() == 1);
  CHECK((swirl.pairs.front().initial == 3 && swirl.pairs.front().too_small == "it must be shorter than every="));
}

TEST_CASE("An invalid modality table is rejected with its row") {
  CHECK_THROWS_WITH(parse_modalities("operator,swirl,sum,s,0.1,5,,\n"), Contains("is not valid here"));
  CHECK_THROWS_WITH(parse_modalities("modality,wind,local,,first,,,\n"), Contains("\"first\" is not a number"));
  CHECK_THROWS_WITH(parse_modalities("modality,wind,fast,,1,,,\n"), Contains("no kind \"fast\""));
  CHECK_THROWS_WITH(parse_modalities("modality,wind\n"), Contains("8 cells"));
  CHECK_THROWS_WITH(parse_modalities("modality,wind,local,,1,,,\nwithout,bias,colour,,,,,x\n"), Contains("no kind \"colour\""));
}

TEST_CASE("In the tables of the node folders every operator has a range and a meaning") {
  REQUIRE_FALSE(known_modalities().empty());
  for (const KnownModality& m : known_modalities()) {
    INFO(m.name);
    CHECK(known_modality(m.name) == &m);
    for (const OutputOperator& o : m.operators) {
      INFO(o.name);
      CHECK(o.min < o.max);
      CHECK_FALSE(o.meaning.empty());
      CHECK_THAT(modalities_with(o.name), Contains(m.name));
    }
  }
  CHECK(known_modality("wind") == nullptr);
  CHECK(output_operators_of("wind").empty());
}

TEST_CASE("Values of several rules are combined as their operator specifies") {
  OutputValues sum, other;
  sum.set("rate", 20, Combine::kMin), other.set("rate", 10, Combine::kMin);
  sum.set("step", 1, Combine::kMax), other.set("step", 2, Combine::kMax);
  sum.set("response", 1, Combine::kSum), other.set("response", 2, Combine::kSum);
  sum.set("dropout", 1), other.set("dropout", 0.5);
  sum.add(other);
  CHECK(sum.value("rate") == 10);
  CHECK(sum.value("step") == 2);
  CHECK(sum.value("response") == 3);
  CHECK(sum.value("dropout") == 0.5);
  CHECK(sum.value("nothing") == 0);
}
