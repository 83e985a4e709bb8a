#include "haptic_node/rendering/renderer.h"

#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/devices/virtual_hand.h"
#include "lcmtypes/valid.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

// Adds the fields that the bus fills, so that the state can be validated as by a receiver.
bool valid_on_the_bus(tool_state_t state) {
  state.header.run_id = state.header.incarnation = 1;
  return valid(state);
}

Vector3d sum_of_constraints(const tool_state_t& state) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& c : state.constraints) sum += to_eigen(c.force_N);
  return sum;
}

double wall_stiffness(const Settings& s) {
  return coupling_gains(
             1000, 0, 1e10, 0.003, 1 / s.rate_Hz,
             {s.stiffness_limit_N_m, s.mass_factor, s.damping_ratio, s.device_mass_kg, s.device_damping_Ns_m})
      .stiffness_N_m;
}

}  // namespace

TEST_CASE("A hand on a wall rests where its spring and the coupling balance") {
  const Settings settings;
  const HandImpedance impedance{settings.hand_mass_kg, settings.hand_damping_Ns_m, settings.hand_stiffness_N_m};
  // The path ends 1 cm below the height at which the tool of 5 mm touches.
  VirtualHand hand(
      MonotoneCubic({0, 1}, {Vector3d(0, 0, 0.02), Vector3d(0, 0, -0.005)}, MonotoneCubic::Ends::kRest), false,
      impedance);
  Bench bench(settings);
  TickOutput* out = nullptr;
  double energy_J = 0;
  hand.begin(host_ms(0));
  Vector3d last = hand.read(host_ms(0)).position;
  for (int ms = 0; ms < 3000; ++ms) {
    const DeviceState state = hand.read(host_ms(ms));
    if (out) energy_J += out->force_N.dot(state.position - last);
    last = state.position;
    const auto m = model(ms, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
    out = &bench.tick(ms, state.position, &m);
    hand.write(out->force_N);
    REQUIRE(valid_on_the_bus(out->state));
    REQUIRE((sum_of_constraints(out->state) - out->force_N).norm() < 1e-5);
  }
  // K depth = k (1 cm - depth).
  const double K = wall_stiffness(settings), k = settings.hand_stiffness_N_m;
  CHECK(out->force_N.z() == Approx(K * k * 0.01 / (K + k)).epsilon(1e-6));
  CHECK(out->force_N.head<2>().norm() < 1e-12);
  CHECK(out->state.proxy.position_m.z == Approx(0.005).margin(1e-9));
  CHECK(out->state.device.position_m.z == Approx(0.005 - out->force_N.z() / K).margin(1e-9));
  CHECK(out->state.energy_J == Approx(energy_J).margin(1e-6));
  // The wall takes the energy of its spring from the hand, and the loss of its damper.
  CHECK(energy_J < -0.5 * out->force_N.z() * out->force_N.z() / K);
  REQUIRE(out->state.constraint_count == 1);
  CHECK(out->state.constraints[0].contact_id == 7);
  CHECK(out->state.constraints[0].point_m.z == Approx(0).margin(1e-9));
}

TEST_CASE("The impulse of a contact is the sum of its forces over time") {
  Bench bench;
  const auto m = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ(), 0.5)});
  double sum_z = 0, last_z = 0;
  for (int ms = 0; ms < 49; ++ms) {
    const auto& out = bench.tick(ms, {0.0001 * ms, 0, 0.004 - 0.00003 * ms}, ms == 0 ? &m : nullptr);
    sum_z += 1e-3 * last_z;
    last_z = out.force_N.z();
    if (out.state.constraint_count > 0)
      CHECK(out.state.constraints[0].impulse_N_s.z == Approx(sum_z).margin(1e-6));
  }
  CHECK(sum_z > 0.005);
}

TEST_CASE("Friction opposes the motion at its coefficient") {
  Bench bench;
  TickOutput* out = nullptr;
  for (int ms = 0; ms < 400; ++ms) {
    const auto m = model(ms, {plane(7, Vector3d::Zero(), Vector3d::UnitZ(), 0.4)});
    out = &bench.tick(ms, {0.0001 * ms, 0, 0.003}, &m);
  }
  CHECK(-out->force_N.x() / out->force_N.z() == Approx(0.4).epsilon(1e-6));
  CHECK(out->force_N.z() == Approx(wall_stiffness({}) * 0.002).epsilon(1e-6));
}

TEST_CASE("The force fades from 50 to 70 ms after the last touch model and returns smoothly") {
  Bench bench;
  const Vector3d device(0, 0, 0.003);  // 2 mm deep
  double full = 0;
  for (int ms = 0; ms <= 100; ++ms) {
    const auto m = model(ms, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
    full = bench.tick(ms, device, &m).force_N.z();
  }
  CHECK(full == Approx(2.0).epsilon(1e-6));
  for (int ms = 101; ms <= 400; ++ms) {
    const auto& out = bench.tick(ms, device);
    const double factor = std::clamp(1 - (ms - 150) / 20.0, 0.0, 1.0);
    CHECK(out.force_N.z() == Approx(full * factor).margin(1e-6));
    CHECK(out.state.fade == Approx(factor).margin(1e-6));
    CHECK(bench.renderer.lost() == (ms > 150));
    if (ms > 150) CHECK(out.state.touch_status == static_cast<int>(sync::SampleStatus::kStale));
  }
  double last = 0;
  for (int ms = 401; ms <= 500; ++ms) {
    const auto m = model(ms, {plane(8, Vector3d::Zero(), Vector3d::UnitZ())});
    const double force = bench.tick(ms, device, &m).force_N.z();
    CHECK(std::abs(force - last) < 0.3);
    last = force;
  }
  CHECK(last == Approx(full).epsilon(1e-6));
}

TEST_CASE("The state reports the sample status of the touch model") {
  Bench bench;
  const auto status = [](const TickOutput& out) { return static_cast<sync::SampleStatus>(out.state.touch_status); };
  CHECK(status(bench.tick(0, Vector3d::Zero())) == sync::SampleStatus::kNone);
  CHECK(bench.tick(1, Vector3d::Zero()).state.header.sim_time_ns == -1);
  const auto m = model(2, {});
  CHECK(status(bench.tick(2, Vector3d::Zero(), &m)) == sync::SampleStatus::kExact);
  CHECK(status(bench.tick(3, Vector3d::Zero())) == sync::SampleStatus::kExtrapolated);
  CHECK(bench.tick(4, Vector3d::Zero()).state.header.sim_time_ns == 4 * kMs);
  CHECK(status(bench.tick(40, Vector3d::Zero())) == sync::SampleStatus::kHeld);
  CHECK(status(bench.tick(60, Vector3d::Zero())) == sync::SampleStatus::kStale);
}

TEST_CASE("Every begin and hit of the own tool has exactly one report with the correct part") {
  Bench bench;
  std::map<std::int64_t, int> begins, hits;
  std::mt19937 random(2);
  std::int64_t id = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    std::vector<contact_event_t> events;
    if (ms < 1800 && random() % 5 == 0) {
      const auto kind = static_cast<std::int8_t>(random() % 3);
      auto e = event(++id, kind, ms - static_cast<double>(random() % 25), 7 + random() % 3);
      e.tool = static_cast<int>(random() % 3) - 1;
      if (e.tool == 0 && kind == contact_event_t::BEGIN) begins[id] = 0;
      if (e.tool == 0 && kind == contact_event_t::HIT) hits[id] = 0;
      events.push_back(e);
    }
    const auto m = model(ms, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
    const auto& out = bench.tick(ms, {0, 0, 0.005 + 0.003 * std::sin(0.01 * ms)}, &m, events);
    for (const presentation_t& r : out.reports) {
      auto& list = r.part == presentation_t::TRANSIENT ? hits : begins;
      REQUIRE(list.count(r.event_id) == 1);
      ++list[r.event_id];
      if (r.outcome == presentation_t::PRESENTED) CHECK(r.uncertainty_ns == 500'000 + 100'000);
    }
  }
  REQUIRE(begins.size() > 20);
  REQUIRE(hits.size() > 20);
  for (const auto& [event_id, reports] : begins) CHECK(reports == 1);
  for (const auto& [event_id, reports] : hits) CHECK(reports == 1);
}

TEST_CASE("A hit pushes the hand away from the hit body, in both body orders") {
  const bool tool_is_b = GENERATE(true, false);
  Bench bench;
  Vector3d first = Vector3d::Zero();
  for (int ms = 0; ms < 60; ++ms) {
    auto e = event(1, contact_event_t::HIT, 29.5);
    if (!tool_is_b) {
      std::swap(e.body_a, e.body_b);
      std::swap(e.material_a, e.material_b);
      e.normal = to_vec3f(-Vector3d::UnitZ());
    }
    const auto m = model(ms, {});
    const auto& out = bench.tick(ms, {0, 0, 0.1}, &m, ms == 30 ? std::vector{e} : std::vector<contact_event_t>{});
    const Vector3d transient = to_eigen(out.state.transient_N);
    CHECK((transient - out.force_N).norm() < 1e-6);
    if (ms < 30) CHECK(transient.norm() == 0);
    if (ms == 30) first = transient;         // the first half wave of 300 Hz lasts 1.7 ms
    CHECK(out.state.constraint_count == 0);  // a transient acts on the hand only
  }
  // A = pi 300 Hz 0.02 kg 0.1 m/s = 1.88 N; at 0.5 ms: exp(-0.04) sin(0.3 pi) A = 1.46 N, within the slew of 2
  // N/ms.
  CHECK(first.z() == Approx(0.9608 * 0.8090 * M_PI * 300 * 0.002).epsilon(1e-3));
}

TEST_CASE("Extreme messages keep force, slew and energy within their limits") {
  std::mt19937 random(77);
  std::normal_distribution<double> normal(0, 1);
  const Settings settings;
  for (const bool passive_hand : {true, false}) {
    Bench bench(settings);
    VirtualHand hand(MonotoneCubic({0}, {Vector3d::Zero()}, MonotoneCubic::Ends::kRest), false,
                     {settings.hand_mass_kg, settings.hand_damping_Ns_m, settings.hand_stiffness_N_m});
    Vector3d last_force = Vector3d::Zero(), last = Vector3d::Zero();
    double energy_J = 0, fastest = 0;
    for (int ms = 0; ms < 4000; ++ms) {
      std::vector<touch_plane_t> planes;
      for (int i = 0; i < 8; ++i) {
        // Flips each tick, jumps, and is as stiff and as fast as a finite number allows.
        Vector3d n(normal(random), normal(random), normal(random));
        if (i < 2) n = Vector3d(0, 0, ms % 2 ? 1 : -1);
        auto p = plane(
            random() % 4 ? i : static_cast<std::int64_t>(random()),
            std::pow(10.0, 3 * normal(random) - 2) * Vector3d(normal(random), normal(random), normal(random)), n);
        p.stiffness_N_m = 1e9f;
        p.damping_N_s_m = 1e9f;
        p.friction_static = p.friction_dynamic = random() % 2 ? 1e9f : 0;
        p.effective_mass_kg = random() % 2 ? 1e-9f : 1e20f;
        p.velocity_m_s = to_vec3f(Vector3d(1e6 * normal(random), 1e6, -1e6));
        p.angular_velocity_rad_s = to_vec3f(Vector3d(1e9, -1e9 * normal(random), 1e9));
        planes.push_back(p);
      }
      auto e = event(ms, contact_event_t::HIT, ms);
      e.approach_speed_m_s = 1e9f;
      e.effective_mass_kg = 1e30f;
      const auto m = model(random() % 3 ? ms : 1e9 * std::abs(normal(random)), planes);
      DeviceState state = hand.read(host_ms(ms));
      if (!passive_hand)
        state.position += 0.01 * Vector3d(std::sin(0.05 * ms), std::cos(0.07 * ms), normal(random) * 0.01);
      const Vector3d moved = state.position - last;
      energy_J += last_force.dot(moved);
      fastest = std::max(fastest, moved.norm() * 1000);
      last = state.position;
      const auto& out = bench.tick(ms, state.position, &m, {e});
      hand.write(out.force_N);
      REQUIRE(out.force_N.allFinite());
      REQUIRE(valid_on_the_bus(out.state));
      REQUIRE(out.force_N.norm() <= settings.force_limit_N + 1e-9);
      REQUIRE(beyond_slew_N(out.force_N, last_force, settings.slew_limit_N_s * 1e-3) <= 1e-9);
      // In addition to the allowance: the force keeps working while the slew limit reduces it, for 4 ms from the
      // limit.
      const double drawn_back_J =
          settings.force_limit_N * fastest * settings.force_limit_N / settings.slew_limit_N_s;
      REQUIRE(energy_J <= settings.energy_limit_J + settings.power_limit_W * (ms + 1) * 1e-3 + drawn_back_J);
      last_force = out.force_N;
    }
  }
}

TEST_CASE("A device with invalid values keeps its last valid position") {
  Bench bench;
  const auto m = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  bench.tick(0, {0, 0, 0.003}, &m);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto& out = bench.tick(1, {nan, 0, nan});
  CHECK(valid_on_the_bus(out.state));
  CHECK(out.state.device.position_m.z == 0.003);
}

TEST_CASE("A quantised force keeps its direction and equals the force on the bodies") {
  constexpr double kStep_N = 0.5;
  Bench bench;
  TickInput in;
  in.force_step_N = kStep_N;
  std::set<long> levels;
  for (int ms = 0; ms < 1000; ++ms) {
    const auto m = model(ms, {plane(7, Vector3d::Zero(), Vector3d(0.3, 0, 1))});
    const auto& out = bench.tick(ms, Vector3d(0, 0, 0.006 - 0.000003 * ms), &m, {}, in);
    const double level = out.force_N.norm() / kStep_N;
    // The limits apply afterwards: a step of 0.5 N is below the 2 N of a tick, so each level is reached at once.
    REQUIRE(level == Approx(std::round(level)).margin(1e-9));
    levels.insert(std::lround(level));
    if (level > 0.5) CHECK(out.force_N.normalized().dot(Vector3d(0.3, 0, 1).normalized()) == Approx(1));
    CHECK((sum_of_constraints(out.state) - out.force_N).norm() < 1e-6);
  }
  CHECK(levels == std::set<long>{0, 1, 2, 3, 4});
}

TEST_CASE("An intended delay softens the coupling to movable bodies, and it recovers within 0.1 s") {
  constexpr int kDelay_ms = 40, kPhase_ms = 3000;
  Bench bench;
  const auto pressed = [&](int begin_ms, int for_ms, int delay_ms) {
    double force_N = 0;
    for (int ms = begin_ms; ms < begin_ms + for_ms; ++ms) {
      auto body = plane(7, Vector3d::Zero(), Vector3d::UnitZ());
      body.effective_mass_kg = 0.5;
      const auto m = model(ms - delay_ms, {body});
      TickInput in;
      in.touch_delay = sync::Nanoseconds(delay_ms * kMs);
      force_N = bench.tick(ms, {0, 0, 0.004}, &m, {}, in).force_N.z();
    }
    return force_N;
  };
  const double fresh_N = pressed(100, kPhase_ms, 0);
  const double late_N = pressed(100 + kPhase_ms, kPhase_ms, kDelay_ms);
  CHECK(late_N < fresh_N / 4);
  CHECK(pressed(100 + 2 * kPhase_ms, 100, 0) == Approx(fresh_N).epsilon(0.03));
}

TEST_CASE("A quantised force obeys the limits of force and slew at any step") {
  const Settings settings;
  const double step_N = GENERATE(1e-6, 0.1, 3.0, 5.0, 100.0);
  Bench bench(settings);
  TickInput in;
  Vector3d last = Vector3d::Zero();
  double largest_N = 0;
  for (int ms = 0; ms < 300; ++ms) {
    in.force_step_N = ms < 250 ? step_N : 0;  // and switched off
    const auto m = model(ms, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
    const Vector3d force = bench.tick(ms, {0, 0, 0.005 - 0.0001 * ms}, &m, {}, in).force_N;
    CHECK(force.norm() <= settings.force_limit_N + 1e-9);
    CHECK(beyond_slew_N(force, last, settings.slew_limit_N_s * 1e-3) <= 1e-9);
    largest_N = std::max(largest_N, force.norm());
    last = force;
  }
  // Steps of 100 N render nothing. When they are switched off, the hand is inside without having worked, and is not
  // pushed out.
  if (step_N < 16) CHECK(largest_N == Approx(settings.force_limit_N));
  if (step_N > 16) CHECK(largest_N < 0.5);
}

TEST_CASE("A quantised force fades to zero after the touch model is lost") {
  Bench bench;
  TickInput in;
  in.force_step_N = GENERATE(0.5, 3.0);
  for (int ms = 0; ms < 200; ++ms) {
    const auto m = model(ms, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
    bench.tick(ms, {0, 0, 0.002}, ms < 100 ? &m : nullptr, {}, in);
  }
  CHECK(bench.tick(200, {0, 0, 0.002}, nullptr, {}, in).force_N.norm() == 0);
}

TEST_CASE("A surface 300 km from the origin feels like the same surface at the origin") {
  const Vector3d far(3e5 + 0.0123, -2e5 - 0.0321, 1e5 + 0.0077), normal = Vector3d(0.3, -0.2, 1).normalized();
  Bench near_bench, far_bench;
  // A step of a double at 3e5 m is 6e-11 m. A place is the sum of a few, and a velocity is their difference over 1 ms.
  const double bound_N = 1e-9 * wall_stiffness({}) + 20 * 6e-8;
  int touching = 0;
  for (int ms = 0; ms < 500; ++ms) {
    const Vector3d device(0.01 * std::sin(0.02 * ms), 0.005 * std::cos(0.013 * ms), 0.004 + 0.003 * std::sin(0.03 * ms));
    const auto m = model(ms, {plane(7, Vector3d::Zero(), normal, 0.4)}), moved = model(ms, {plane(7, far, normal, 0.4)});
    const TickOutput& here = near_bench.tick(ms, device, &m);
    const TickOutput& there = far_bench.tick(ms, far + device, &moved);
    REQUIRE((here.force_N - there.force_N).norm() < bound_N);
    REQUIRE(here.state.constraints.size() == there.state.constraints.size());
    for (std::size_t i = 0; i < here.state.constraints.size(); ++i) {
      ++touching;
      REQUIRE((to_eigen(there.state.constraints[i].point_m) - far - to_eigen(here.state.constraints[i].point_m)).norm() < 1e-9);
    }
  }
  CHECK(touching > 100);
}
