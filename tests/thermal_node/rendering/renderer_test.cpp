#include "thermal_node/rendering/renderer.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/thermal_state_t.hpp>

#include "lcmtypes/valid.h"
#include "tests/thermal_node/support/hand.h"

using namespace tactus;
using namespace tactus::thermal;
using namespace std::chrono_literals;

namespace {

contact_event_t event(std::int8_t kind, std::int64_t id, std::int64_t time_ns, int tool = 0) {
  contact_event_t e{};
  e.kind = kind;
  e.event_id = id;
  e.contact_id = 1;
  e.time_ns = time_ns;
  e.tool = tool;
  e.body_a = 3;
  e.body_b = 9;
  e.material_a = kCopper;
  e.material_b = -1;
  e.effective_mass_kg = 0.1f;
  e.approach_speed_m_s = 0.2f;
  return e;
}

}  // namespace

TEST_CASE("Untouched skin stays at rest") {
  const thermal_state_t state = Hand(kMaterials, with_model(GENERATE("half_space", "bioheat"))).rest(500);
  CHECK(state.skin_degC == 33);
  CHECK(state.commanded_degC == 33);
  CHECK(state.material == -1);
  CHECK(state.limited == 0);
}

TEST_CASE("Firmly pressed copper cools the skin by the closed form, plastic cools it less") {
  thermal::Settings dry = bare();
  dry.perfusion_1_s = 0;
  Hand copper(kMaterials, dry), plastic(kMaterials, dry);
  const thermal_state_t c = copper.press(kCopper, 1, 50), p = plastic.press(kPlastic, 1, 50);
  // The closed form at 1 s gives -6.77 and -2.15 K; the numeric model is within 0.5 % of it.
  CHECK(c.skin_degC == Approx(33 - 6.77).margin(0.05));
  CHECK(p.skin_degC == Approx(33 - 2.16).margin(0.05));
  CHECK(c.commanded_degC == c.skin_degC);
  CHECK(c.heat_flux_W_m2 > 0);
  CHECK(c.material == kCopper);
  CHECK(c.force_N == 1);
  CHECK(c.area_m2 == Approx(1e-4));
}

TEST_CASE("A lighter touch cools less, and so does a shorter one") {
  const auto settings = with_model(GENERATE("half_space", "bioheat"));
  Hand firm(kMaterials, settings), light(kMaterials, settings), brief(kMaterials, settings);
  const float by_firm = firm.press(kCopper, 1, 25).skin_degC;
  const float by_light = light.press(kCopper, 0.1, 25).skin_degC;
  const float by_brief = brief.press(kCopper, 1, 25, 2ms).skin_degC;
  CHECK(by_firm < by_light);
  CHECK(by_light < 33);
  CHECK(by_firm < by_brief);
  CHECK(by_brief < 33);
}

TEST_CASE("A touch of 3 ms cools the skin although it is shorter than a tick") {
  Hand hand;
  CHECK(hand.press(kCopper, 1, 1, 3ms).skin_degC < 33 - 0.05);
}

TEST_CASE("After the touch skin and command return to rest") {
  Hand hand;
  const float touched = hand.press(kCopper, 1, 100).skin_degC;
  const float later = hand.rest(100).skin_degC;
  CHECK(later > touched + 3);
  CHECK(hand.rest_long(3600).skin_degC == Approx(33).margin(0.01));
}

TEST_CASE("No object moves the command out of the skin-safe range") {
  const auto settings = with_model(GENERATE("half_space", "bioheat"));
  SECTION("Copper at 1000 degrees") {
    Hand hand(kMaterials, settings);
    float before = 33;
    for (int i = 0; i < 500; ++i) {
      const thermal_state_t state = hand.press(kFurnace, 20);
      REQUIRE(state.commanded_degC <= 42);
      REQUIRE(std::abs(state.commanded_degC - before) <= 20 * 0.02f + 1e-4f);
      before = state.commanded_degC;
    }
    CHECK(hand.press(kFurnace, 20).limited == 1);
    CHECK(before == 42);
  }
  SECTION("Any values of material and contact") {
    const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
    const double values[] = {nan, inf, -inf, -1, 0, 1e-300, 1e-3, 1, 23, 1e9, 1e300};
    std::mt19937 random(3);
    const auto any = [&] { return values[random() % std::size(values)]; };
    for (int trial = 0; trial < 300; ++trial) {
      Hand hand({material(any(), any(), any(), any()), material(any(), any(), any(), any())}, settings);
      for (int i = 0; i < 20; ++i) {
        Tick tick = hand.next();
        for (std::size_t n = random() % 7; n > 0; --n)
          tick.contact.parts.push_back({static_cast<int>(random() % 3), static_cast<int>(random() % 5) - 2,
                                        sync::Nanoseconds(static_cast<std::int64_t>(random() % 40) * kMs), any(),
                                        any()});
        tick.contact.force_N = any();
        tick.contact.area_m2 = any();
        if (i % 2) tick.contact_interval = sync::Nanoseconds(0);
        thermal_state_t state = hand.renderer.step(tick);
        state.header.run_id = state.header.incarnation = 1;
        REQUIRE(valid(state));
        REQUIRE(state.commanded_degC >= 15);
        REQUIRE(state.commanded_degC <= 42);
      }
      // Impossible input leaves no trace: the skin temperature is finite again at rest.
      REQUIRE(std::isfinite(hand.rest(5).skin_degC));
    }
  }
}

TEST_CASE("Stale or missing input returns the command to resting skin within the slew limit") {
  for (const sync::SampleStatus status : {sync::SampleStatus::kStale, sync::SampleStatus::kNone}) {
    Hand hand;
    float before = hand.press(kCopper, 1, 250).commanded_degC;
    REQUIRE(before < 26);
    for (int i = 0; i < 50; ++i) {
      Tick tick = hand.next();
      tick.contact.status = status;
      touch(tick, kCopper, 1);
      const thermal_state_t state = hand.renderer.step(tick);
      CHECK(hand.renderer.input_lost());
      CHECK(state.material == -1);
      CHECK(state.force_N == 0);
      CHECK(state.commanded_degC - before <= 0.4f + 1e-4f);
      before = state.commanded_degC;
    }
    CHECK(before == 33);
    CHECK_FALSE((hand.rest(), hand.renderer.input_lost()));
  }
}

TEST_CASE("Every begin and hit of the own tool is reported once, at the tick that applied it") {
  Hand hand;
  Tick tick = hand.next();
  const std::int64_t due = sync::to_ns(tick.begin) + 5 * kMs;
  tick.events = {event(contact_event_t::BEGIN, 11, due), event(contact_event_t::HIT, 12, due),
                 event(contact_event_t::END, 13, due), event(contact_event_t::HIT, 14, due, 1),
                 event(contact_event_t::HIT, 15, due, -1)};
  hand.renderer.step(tick);
  REQUIRE(hand.renderer.reports().size() == 2);
  for (const presentation_t& r : hand.renderer.reports()) {
    CHECK(r.part == presentation_t::WHOLE);
    CHECK(r.outcome == presentation_t::PRESENTED);
    CHECK(r.scheduled_ns == due);
    CHECK(r.presented_ns == sync::to_ns(tick.end));
    CHECK(r.uncertainty_ns == 10 * kMs);
  }
  CHECK(hand.renderer.reports()[0].event_id == 11);
  CHECK(hand.renderer.reports()[1].event_id == 12);
  hand.rest();
  CHECK(hand.renderer.reports().empty());
}

TEST_CASE("An event older than half a second is applied and reported as late") {
  Hand hand;
  hand.rest(100);
  Tick tick = hand.next();
  const std::int64_t end = sync::to_ns(tick.end);
  tick.events = {event(contact_event_t::BEGIN, 1, end - 501 * kMs),
                 event(contact_event_t::HIT, 2, end - 499 * kMs), event(contact_event_t::END, 3, end - 498 * kMs)};
  const thermal_state_t state = hand.renderer.step(tick);
  REQUIRE(hand.renderer.reports().size() == 2);
  CHECK(hand.renderer.reports()[0].outcome == presentation_t::LATE);
  CHECK(hand.renderer.reports()[1].outcome == presentation_t::PRESENTED);
  CHECK(state.skin_degC < 33);
  CHECK(state.material == kCopper);
}

TEST_CASE("The same contacts give bit-identical commands") {
  const auto settings = with_model(GENERATE("half_space", "bioheat"));
  const auto run = [&] {
    Hand hand(kMaterials, settings);
    std::mt19937 random(5);
    double sum = 0;
    for (int i = 0; i < 200; ++i)
      sum = sum * 0.5 + hand.press(static_cast<int>(random() % 3), 0.01 * (random() % 100)).commanded_degC;
    return sum;
  };
  CHECK(run() == run());
}

TEST_CASE("Two simultaneous objects cool by the sum of their heat flows") {
  const auto settings = with_model(GENERATE("half_space", "bioheat"));
  const auto after_a_second = [&](double on_copper_N, double on_plastic_N) {
    Hand hand(kMaterials, settings);
    thermal_state_t state{};
    for (int i = 0; i < 50; ++i) {
      Tick tick = hand.next();
      if (on_copper_N > 0) tick.contact.parts.push_back({kCopper, kCopper, kTick, on_copper_N, 0.5e-4});
      if (on_plastic_N > 0) tick.contact.parts.push_back({kPlastic, kPlastic, kTick, on_plastic_N, 0.5e-4});
      state = hand.renderer.step(tick);
    }
    return state;
  };
  const auto both = after_a_second(0.4, 0.4), copper = after_a_second(0.4, 0), plastic = after_a_second(0, 0.4),
             two_of_copper = after_a_second(0.8, 0);
  CHECK(both.skin_degC < copper.skin_degC - 0.2);
  CHECK(copper.skin_degC < plastic.skin_degC - 0.2);
  CHECK(both.skin_degC > two_of_copper.skin_degC + 0.2);
  CHECK(both.material == kCopper);
  CHECK(plastic.material == kPlastic);
}

TEST_CASE("The total conductance is limited to that of the whole pad for any number of objects") {
  Hand one, many;
  thermal_state_t a{}, b{};
  for (int i = 0; i < 50; ++i) {
    a = one.press(kCopper, 10);
    Tick tick = many.next();
    for (int body = 0; body < 7; ++body) tick.contact.parts.push_back({body, kCopper, kTick, 10, 1e-4});
    b = many.renderer.step(tick);
  }
  CHECK(b.skin_degC == Approx(a.skin_degC).margin(0.01));
}

TEST_CASE("An object keeps its heat until the next touch") {
  // Plastic that a finger has warmed cools it less the second time, although copper was touched in between;
  // another piece of the same plastic cools it as the first time.
  Hand warmed, fresh;
  const auto flux = [&](Hand& hand, int body) {
    hand.press(kPlastic, 1, 250);
    hand.press(kCopper, 1, 5);
    hand.rest(10);
    Tick tick = hand.next();
    tick.contact.parts = {{body, kPlastic, kTick, 1, 1e-4}};
    return hand.renderer.step(tick).heat_flux_W_m2;
  };
  CHECK(flux(warmed, kPlastic) < 0.8 * flux(fresh, 77));
}

TEST_CASE("With the bioheat model a sheet warms through and a block does not") {
  const auto after_ten_seconds = [](const char* model, double thickness_m) {
    Hand hand;
    hand.renderer = Renderer(with_model(model), kMaterials, 0, 9, std::nullopt, {thickness_m});
    return hand.press(kCopper, 1, 500).skin_degC;
  };
  CHECK(after_ten_seconds("bioheat", 0.001) > after_ten_seconds("bioheat", 0.1) + 1);
  CHECK(after_ten_seconds("half_space", 0.001) == after_ten_seconds("half_space", 0.1));
}

TEST_CASE("The command continues from its value when the scene selects another model") {
  Hand hand;
  double before = hand.press(kCopper, 1, 200).commanded_degC;
  REQUIRE(before < 28);
  for (int i = 0; i < 6; ++i) {
    const auto settings = with_model(i % 2 ? "half_space" : "bioheat");
    hand.renderer = Renderer(settings, kMaterials, 0, 9, before);
    for (int tick = 0; tick < 10; ++tick) {
      const double command = hand.press(kCopper, 1).commanded_degC;
      REQUIRE(std::abs(command - before) <= settings.slew_max_K_s * 0.02 + 1e-4);
      before = command;
    }
  }
}

TEST_CASE("The command continues within the slew limit when the scene changes") {
  const thermal::Settings settings = bare();
  Hand hand(kMaterials, settings);
  const double stands = hand.press(kCopper, 5, 100).commanded_degC;
  REQUIRE(stands < 31);
  hand.renderer = Renderer(settings, kMaterials, 0, 9, stands);
  const double most = settings.slew_max_K_s * sync::to_seconds(kTick) + 1e-5;
  double last = stands;
  for (int i = 0; i < 100; ++i) {
    const double command = hand.rest().commanded_degC;
    CHECK(std::abs(command - last) <= most);
    last = command;
  }
  CHECK(last == Approx(settings.skin_rest_degC).margin(0.01));
}

TEST_CASE("The operator response approaches the skin temperature by the closed form") {
  // From the temperature of the previous scene, 20 degrees, to resting skin: 13 K/s at first, below the limit of
  // the element.
  const thermal::Settings settings = bare();
  Hand hand(kMaterials, settings);
  hand.renderer = Renderer(settings, kMaterials, 0, 9, 20.0);
  for (int i = 1; i <= 500; ++i) {
    const thermal_state_t state = hand.renderer.step(hand.next(), {.response_s = 1});
    REQUIRE(state.commanded_degC == Approx(33 - 13 * std::exp(-0.02 * i)).margin(1e-4));
    REQUIRE(state.skin_degC == 33);
  }
}

TEST_CASE("The operator response lags the skin, and switching it causes no jump") {
  const thermal::Settings settings = bare();
  Hand hand(kMaterials, settings);
  float before = hand.press(kCopper, 1, 10).commanded_degC;
  for (int i = 0; i < 200; ++i) {
    Tick tick = hand.next();
    touch(tick, kCopper, 1);
    const bool slow = i >= 10 && i < 100;
    const thermal_state_t state = hand.renderer.step(tick, {.response_s = slow ? 2.0 : 0.0});
    // The slew limit of the element; the step to the temperature of the skin takes some ticks of it.
    CHECK(std::abs(state.commanded_degC - before) <= settings.slew_max_K_s * 0.02 + 1e-4);
    if (i == 10) CHECK(std::abs(state.commanded_degC - before) < 0.02);  // on: continues from there
    if (i == 50) CHECK(state.commanded_degC > state.skin_degC + 0.5);
    if (i == 199) CHECK(state.commanded_degC == state.skin_degC);
    before = state.commanded_degC;
  }
}

TEST_CASE("With any response the command stays in the safe range and returns to rest when input is lost") {
  Hand hand(kMaterials, bare());
  for (int i = 0; i < 200; ++i) {
    Tick tick = hand.next();
    touch(tick, kFurnace, 20);
    REQUIRE(hand.renderer.step(tick, {.response_s = 0.5}).commanded_degC <= 42);
  }
  thermal_state_t state{};
  for (int i = 0; i < 50; ++i) {
    Tick tick = hand.next();
    tick.contact.status = sync::SampleStatus::kStale;
    state = hand.renderer.step(tick, {.response_s = 60});
  }
  CHECK(state.commanded_degC == 33);
  // It resumes from there, not from its value when the input was lost.
  for (int i = 0; i < 50; ++i) state = hand.renderer.step(hand.next(), {.response_s = 1e6});
  CHECK(state.commanded_degC == Approx(33).margin(0.1));
}

TEST_CASE("A late event is applied and reported as late at any age") {
  const auto felt = [](std::int64_t lateness_ms) {
    Hand hand;
    hand.rest(400);
    Tick tick = hand.next();
    const std::int64_t end = sync::to_ns(tick.end);
    tick.events = {event(contact_event_t::BEGIN, 1, end - lateness_ms * kMs),
                   event(contact_event_t::END, 3, end - (lateness_ms - 5) * kMs)};
    const float skin = hand.renderer.step(tick).skin_degC;
    REQUIRE(hand.renderer.reports().size() == 1);
    return std::pair(int{hand.renderer.reports()[0].outcome}, skin);
  };
  const auto [outcome, skin] = felt(100);
  REQUIRE(skin < 33);
  CHECK(outcome == presentation_t::PRESENTED);
  CHECK(felt(500) == std::pair(int{presentation_t::PRESENTED}, skin));
  CHECK(felt(501) == std::pair(int{presentation_t::LATE}, skin));
  CHECK(felt(8000) == std::pair(int{presentation_t::LATE}, skin));
}
