// A profile on touch models of several pages, from the bus to the hand: each model is rendered completely or not
// at all.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/contact/touch_input.h"
#include "sync/degradation/degraded_snapshots.h"
#include "tests/haptic_node/support/paged_models.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

constexpr std::size_t kPlanes = 20, kApplied = 3;  // three pages

sync::OperatorChain operators_of(const std::string& attributes) {
  return {sync::parse_profile("<profile><degrade modality=\"haptic\" " + attributes + "/></profile>", "p.xml"),
          "haptic",
          {}};
}

// The path of the touch models as in the loop of the node. A tick comes between the pages of each model: the last
// of them arrive a tick later.
struct TouchPath {
  sync::OperatorChain operators;
  sync::DegradedSnapshots<touch_model_t> degraded;
  TouchInput input{0, 1};
  std::vector<touch_model_t> late;  // pages that arrive with the next tick
  std::int64_t seq = 0;

  TouchPath() { degraded.present_on_release(); }  // as in ModalityEndpoint for a servo loop

  // One tick. Returns the new model of the hand, or none.
  TouchModelView tick(std::int64_t ms, const touch_model_t& model) {
    const sync::HostTime now = sync::host_time(ms * kMs);
    const auto arrive = [&](touch_model_t page) { degraded.push(std::move(page), now, operators, nullptr); };
    for (const touch_model_t& page : late) arrive(page);
    late = pages_of(model, seq);
    arrive(late.front());
    late.erase(late.begin());
    // As in ModalityEndpoint for a servo loop, where new messages wait.
    const sync::HostTime release_time = now - operators.presentation_delay(sync::sim_time(ms * kMs));
    while (const auto m = degraded.pop(release_time)) input.push(m->first, m->second);
    return input.pop();
  }
};

touch_model_t model_at(std::int64_t ms) {
  touch_model_t m = whole_model(ms, kPlanes, kApplied);
  for (std::size_t i = 0; i < m.planes.size(); ++i) {
    m.planes[i].stiffness_N_m = 1000;
    // For a deadband: one plane, of another page each time, moves every 10 ms.
    const bool moves = ms % 10 == 0 && i == static_cast<std::size_t>(ms / 10) % kPlanes;
    m.planes[i].contact_id = static_cast<std::int64_t>(i);
    m.planes[i].velocity_m_s.x = moves ? 1 : 0;
  }
  return m;
}

// Every plane of one step, with the same stiffness; or, where nothing is felt, none.
bool whole(const TouchModelView& m, bool zero) {
  const std::size_t planes = zero ? 0 : kPlanes;
  bool good = m.plane_count() == planes;
  for (std::size_t i = 0; good && i < planes; ++i)
    good = m.plane(i).contact_id == static_cast<std::int64_t>(i) && m.plane(i).stiffness_N_m == m.plane(0).stiffness_N_m;
  std::size_t index = 0;
  m.for_each_applied([&](const touch_applied_t& a) {
    good = good && a.contact_id == m.header().sim_time_ns / kMs * 1000 + static_cast<std::int64_t>(index++);
  });
  return good && index == kApplied;
}

struct Case {
  std::string profile;
  double share, tolerance;  // of the models that pass
  int min_ms, max_ms;       // delay
  double stiffness_N_m = 1000;
};

}  // namespace

TEST_CASE("Under any profile the hand receives complete touch models in increasing order") {
  // Without a profile a model is complete one tick after it was sent. Shares to five standard deviations of 2000
  // draws. For a deadband beside losses the share is that of the first measurement.
  const Case c = GENERATE(
      Case{"delay=\"40ms\"", 1, 0, 41, 41}, Case{"delay=\"40ms network\"", 1, 0, 40, 40},
      Case{"rate=\"100Hz\"", 0.1, 0.002, 1, 1}, Case{"rate=\"100Hz\" delay=\"30ms network\"", 0.1, 0.002, 30, 30},
      Case{"loss=\"30%\"", 0.7, 0.05, 1, 1}, Case{"loss=\"30% burst=5\"", 0.7, 0.15, 1, 1},
      // Three pages, each by itself.
      Case{"wire_loss=\"5%\"", std::pow(0.95, 3), 0.04, 1, 1},
      Case{"wire_loss=\"5%\" loss=\"20%\" delay=\"10ms network\"", 0.8 * std::pow(0.95, 3), 0.06, 10, 10},
      // The share of the ticks with a newer model, of 200,000 simulated delays: 9 ms +- 3 ms, and 0 to 10 ms.
      Case{"delay=\"9ms network\" jitter=\"3ms normal\"", 0.343, 0.06, 1, 19},
      Case{"delay=\"5ms network\" jitter=\"5ms uniform order=free\"", 0.365, 0.06, 1, 11},
      Case{"delay=\"9ms\" jitter=\"3ms normal\"", 0.343, 0.06, 1, 20},
      Case{"reorder=\"20% by=5ms\"", 0.8, 0.05, 1, 5}, Case{"duplicate=\"20%\"", 1, 0, 1, 1},
      Case{"deadband=\"10% velocity\"", 0.2, 0.01, 1, 1},
      Case{"deadband=\"10% velocity\" wire_loss=\"5%\" delay=\"20ms\"", 0.27, 0.06, 21, 30},
      Case{"gain=\"0.5 force\" delay=\"7ms\"", 1, 0, 8, 8, 500},
      Case{"conceal=\"zero\" loss=\"30%\"", 1, 0, 1, 1});
  CAPTURE(c.profile);
  TouchPath path;
  path.operators = operators_of(c.profile);
  std::int64_t newest_ns = -1;
  int passed = 0;
  constexpr int kTicks = 2000;
  for (std::int64_t ms = 0; ms < kTicks; ++ms) {
    const TouchModelView m = path.tick(ms, model_at(ms));
    if (!m) continue;
    const std::int64_t late_ms = ms - m.header().sim_time_ns / kMs;
    CAPTURE(ms, late_ms, m.plane_count());
    REQUIRE((whole(m, false) || (c.profile.starts_with("conceal") && whole(m, true))));
    for (std::size_t i = 0; i < m.plane_count(); ++i) REQUIRE(m.plane(i).stiffness_N_m == Approx(c.stiffness_N_m));
    REQUIRE(m.header().sim_time_ns > newest_ns);
    REQUIRE(late_ms >= c.min_ms);
    REQUIRE(late_ms <= c.max_ms);
    newest_ns = m.header().sim_time_ns;
    ++passed;
  }
  CHECK(passed > 0);
  CHECK(std::abs(static_cast<double>(passed) / (kTicks - c.min_ms) - c.share) <= c.tolerance);
}

TEST_CASE("A freeze begins and ends with a complete model, and its zero model has no planes") {
  const bool zero = GENERATE(false, true);
  TouchPath path;
  path.operators =
      operators_of(std::string("from=\"100ms\" until=\"200ms\" freeze=\"") + (zero ? "zero\"" : "hold\""));
  for (std::int64_t ms = 0; ms < 300; ++ms) {
    const bool frozen = ms - 1 >= 100 && ms - 1 < 200;
    const TouchModelView m = path.tick(ms, model_at(ms));
    CAPTURE(ms, zero);
    REQUIRE(static_cast<bool>(m) == (ms >= 1 && (zero || !frozen)));
    if (!m) continue;
    REQUIRE(m.header().sim_time_ns == (ms - 1) * kMs);
    REQUIRE(whole(m, frozen));
  }
}

TEST_CASE("A profile change between the pages of a model drops that model") {
  const std::string before =
      GENERATE("", "gain=\"0.25 force\"", "delay=\"5ms network\"", "deadband=\"10% velocity\"");
  const std::string after =
      GENERATE("", "gain=\"0.5 force\"", "freeze=\"zero\"", "off=\"true\"", "delay=\"3ms network\"");
  CAPTURE(before, after);
  TouchPath path;
  if (!before.empty()) path.operators = operators_of(before);
  bool zero = false;
  int passed = 0;
  for (std::int64_t ms = 0; ms < 60; ++ms) {
    if (ms == 30) {
      path.operators = after.empty() ? sync::OperatorChain() : operators_of(after);
      path.degraded.change_profile();
    }
    const TouchModelView m = path.tick(ms, model_at(ms));
    if (!m) continue;
    CAPTURE(ms);
    CHECK(m.header().sim_time_ns != 29 * kMs);
    zero = m.plane_count() == 0;
    REQUIRE(whole(m, zero));
    ++passed;
  }
  CHECK(passed > 30);  // also behind a deadband, which passes 6 of 30
  CHECK(zero == (after == "freeze=\"zero\"" || after == "off=\"true\""));
}

TEST_CASE("Each touch model is degraded independently while the simulation is paused") {
  constexpr std::int64_t kStands_ms = 100;
  TouchPath path;
  SECTION("A network delay applies to each model") {
    path.operators = operators_of("delay=\"40ms network\"");
    for (std::int64_t ms = 0; ms < 500; ++ms) {
      touch_model_t model = model_at(std::min(ms, kStands_ms));
      model.header.publish_time_ns = ms * kMs, model.clock.host_ns = ms * kMs;
      for (touch_plane_t& p : model.planes) p.body = static_cast<std::int32_t>(ms);  // the hand keeps moving
      const TouchModelView m = path.tick(ms, model);
      CAPTURE(ms);
      REQUIRE(static_cast<bool>(m) == (ms >= 40));
      if (!m) continue;
      for (std::size_t i = 0; i < m.plane_count(); ++i) REQUIRE(m.plane(i).body == ms - 40);
    }
  }
  SECTION("A loss drops its share of the models, with all pages") {
    path.operators = operators_of("loss=\"50%\"");
    int passed = 0;
    for (std::int64_t ms = 0; ms < 1100; ++ms) {
      touch_model_t model = model_at(std::min(ms, kStands_ms));
      model.header.publish_time_ns = ms * kMs, model.clock.host_ns = ms * kMs;
      for (touch_plane_t& p : model.planes) p.body = static_cast<std::int32_t>(ms);
      const TouchModelView m = path.tick(ms, model);
      if (!m) continue;
      for (std::size_t i = 0; i < m.plane_count(); ++i) REQUIRE(m.plane(i).body == ms - 1);
      if (ms > kStands_ms) ++passed;
    }
    CHECK(std::abs(passed - 500) < 5 * std::sqrt(250));
  }
}
