// Tests of a deadband on the force of touch: it compares forces, not the impulses that accumulate during a contact.
#include "sync/degradation/touch_forces.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "sync/degradation/degraded_snapshots.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

// One contact that has received this impulse, along z.
touch_model_t model_at(std::int64_t ms, double impulse_N_s) {
  touch_model_t m{};
  m.header.run_id = m.header.incarnation = 1;
  m.header.sim_time_ns = m.header.publish_time_ns = ms * kMs;
  m.header.seq = ms;
  m.clock = {ms * kMs, ms * kMs, 1};
  m.pages = m.plane_count = m.applied_count = 1;
  m.planes.resize(1);
  m.planes[0].contact_id = 4;
  m.applied.resize(1);
  m.applied[0].contact_id = 4;
  m.applied[0].impulse_N_s.z = static_cast<float>(impulse_N_s);
  return m;
}

OperatorChain haptic_chain(const std::string& attributes) {
  return OperatorChain(parse_profile("<profile><degrade modality=\"haptic\" " + attributes + "/></profile>", "p.xml"), "haptic", {});
}

// Updates in each second of a force that varies around 2 N, ten times a second.
std::vector<int> updates_per_second(int seconds) {
  OperatorChain chain = haptic_chain("deadband=\"10% force floor=10mN\"");
  DegradedSnapshots<touch_model_t> models;
  std::vector<int> updates(static_cast<std::size_t>(seconds));
  double impulse_N_s = 0;
  for (int ms = 0; ms < 1000 * seconds; ++ms) {
    impulse_N_s += 0.001 * (2 + 1.5 * std::sin(2 * std::numbers::pi * ms / 100.0));
    models.push(model_at(ms, impulse_N_s), host_time(ms * kMs), chain, nullptr);
    while (models.pop(host_time(ms * kMs))) ++updates[static_cast<std::size_t>(ms / 1000)];
  }
  return updates;
}

}  // namespace

TEST_CASE("A deadband on the force of touch sends a constant pattern at a constant rate") {
  const std::vector<int> updates = updates_per_second(30);
  INFO(updates[1] << " in the second second, " << updates.back() << " in the last");
  // A period of 0.5 .. 3.5 N crosses ln(7) / ln(1.1) = 20 levels twice; a level of single precision of 60 N s is 4 mN of force
  // in 1 ms, far below the band.
  CHECK(updates[1] > 10 * 15);
  for (std::size_t s = 2; s < updates.size(); ++s) CHECK(std::abs(updates[s] - updates[1]) <= 10);
}

TEST_CASE("A deadband on the force of touch passes no update of a constant force") {
  OperatorChain chain = haptic_chain("deadband=\"10% force\"");
  DegradedSnapshots<touch_model_t> models;
  int passed = 0;
  for (int ms = 0; ms < 5000; ++ms) {
    models.push(model_at(ms, ms * 0.002), host_time(ms * kMs), chain, nullptr);
    while (models.pop(host_time(ms * kMs))) ++passed;
  }
  CHECK(passed == 2);  // the first model, and the second, which is the first with a force
}

TEST_CASE("A surface that comes near is sent under a deadband on the force of touch") {
  OperatorChain chain = haptic_chain("deadband=\"10% force\"");
  DegradedSnapshots<touch_model_t> models;
  std::vector<std::int64_t> passed;
  for (int ms = 0; ms < 100; ++ms) {
    touch_model_t m = model_at(ms, 0);
    m.applied.clear(), m.applied_count = 0;
    if (ms >= 50) m.planes.push_back(m.planes[0]), m.planes.back().contact_id = 5, m.plane_count = 2;
    models.push(m, host_time(ms * kMs), chain, nullptr);
    while (const auto out = models.pop(host_time(ms * kMs))) passed.push_back(out->first.header.sim_time_ns / kMs);
  }
  CHECK(passed == std::vector<std::int64_t>{0, 50});
}

TEST_CASE("The force on a contact is the mean since the model before") {
  TouchForces forces;
  const auto force = [&](std::int64_t ms, double impulse_N_s) {
    std::vector<Signal> signals = signals_of(model_at(ms, impulse_N_s));
    forces.append(signals, sim_time(ms * kMs));
    for (const Signal& s : signals)
      if (s.quantity == Quantity::kForce) return s.value.z();
    return std::nan("");
  };
  CHECK(force(10, 3) == 0);  // the first model of a contact that has lasted already
  CHECK(force(12, 3.004) == Approx(2).epsilon(1e-3));
  CHECK(force(12, 3.004) == Approx(2).epsilon(1e-3));  // the world stands still
  CHECK(force(11, 3.002) == Approx(2).epsilon(1e-3));  // overtaken
  CHECK(force(13, 3.004) == Approx(0).margin(1e-3));
  CHECK(force(4000, 3.5) > 0);
  CHECK(force(5, 0.1) == 0);  // the world has restarted
  CHECK(force(6, 0.102) == Approx(2).epsilon(1e-3));
}
