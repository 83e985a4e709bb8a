// False touch models. The renderer receives messages that pass the validation and messages that never would. For
// any input the force stays finite and within its limits of size, slew, energy and workspace, at 1, 2 and 4 kHz.
#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <random>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/devices/virtual_hand.h"
#include "lcmtypes/valid.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

// A source of false models: every number may be as large, small or wrong as a number can be.
struct FalseModels {
  std::mt19937 random;
  bool finite;                              // only values that may pass the validation
  std::map<std::int64_t, bool> moves = {};  // whether a surface moved in the last message

  int below(int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }
  double number() {
    static constexpr double kFinite[] = {0, -1, 1e-30, 1e-9, 1, 1e6, 9e8, -9e8};
    static constexpr double kInvalid[] = {std::numeric_limits<double>::quiet_NaN(),
                                          std::numeric_limits<double>::infinity(),
                                          -std::numeric_limits<double>::infinity(),
                                          1e38,
                                          -1e38,
                                          1e-45};
    if (!finite && below(4) == 0) return kInvalid[below(6)];
    return below(2) ? kFinite[below(8)] : std::normal_distribution<double>(0, 1)(random);
  }
  Vector3d vector() { return {number(), number(), number()}; }
  // At the size of the tool, with unit vectors where required: there false values have the largest effect.
  Vector3d place() { return 0.02 * Vector3d(unit().x(), unit().y(), unit().z()); }
  Vector3d unit() {
    std::normal_distribution<double> normal(0, 1);
    return Vector3d(normal(random), normal(random), normal(random)).normalized();
  }

  touch_plane_t false_plane(int tick) {
    const int kind = below(6);
    const Vector3d normal = kind == 0   ? Vector3d(0, 0, tick % 2 ? 1 : -1)  // facing each other, and alternating
                            : kind == 1 ? (finite ? unit() : Vector3d::Zero())
                                        : unit();
    auto p = plane(below(3) ? below(4) : static_cast<std::int64_t>(random()), kind == 2 ? 5 * unit() : place(),
                   normal.norm() > 0 ? normal : Vector3d(0, 0, 1));
    p.normal_body = p.normal;
    if (normal.norm() == 0) p.normal = to_vec3f(normal);
    if (kind == 3) p.point_m = to_vec3(vector());
    if (!finite && kind == 4) p.normal = to_vec3f(vector());
    const auto positive = [&](double x) { return finite ? std::clamp(std::abs(x), 1e-30, 9e8) : x; };
    // Every third is static, regardless of its other fields: the passivity controller soon releases moving ones.
    p.effective_mass_kg = below(3) == 0 ? 1e10f : static_cast<float>(positive(number()));
    moves[p.contact_id] = p.effective_mass_kg < 1e9f;
    p.stiffness_N_m = static_cast<float>(positive(number()));
    p.damping_N_s_m = static_cast<float>(positive(number()));
    p.friction_static = static_cast<float>(positive(number()));
    p.friction_dynamic = static_cast<float>(positive(number()));
    p.velocity_m_s = to_vec3f(vector());
    p.angular_velocity_rad_s = to_vec3f(vector());
    p.tool_point_m = to_vec3f(below(4) ? Vector3d(Vector3d::Zero()) : vector());
    p.bump_asset = static_cast<std::int64_t>(random());
    p.bump_u = to_vec3f(vector());
    p.material = finite ? below(3) - 1 : static_cast<int>(random());
    return p;
  }

  touch_model_t false_model(int tick, double ms) {
    std::vector<touch_plane_t> planes;
    for (int i = below(8); i > 0; --i) planes.push_back(false_plane(tick));
    // twice in one message
    if (planes.size() > 1 && below(3) == 0) planes.back().contact_id = planes.front().contact_id;
    // Time stands still, goes back, or belongs to another run.
    touch_model_t m = model(below(4) ? ms : below(2) ? 0 : std::abs(std::fmod(1e3 * number(), 1e6)), planes);
    if (m.header.sim_time_ns < 0) m.header.sim_time_ns = 0;
    m.page = static_cast<std::int8_t>(finite ? 0 : below(256) - 128);
    for (int i = below(4); i > 0; --i) {
      touch_applied_t a{};
      a.contact_id = below(4);
      a.energy_J = static_cast<float>(number());
      a.impulse_N_s = to_vec3(to_eigen(to_vec3f(vector())));
      m.applied.push_back(a);
    }
    m.applied_count = static_cast<std::int8_t>(m.applied.size());
    return m;
  }
};

}  // namespace

TEST_CASE("False touch models keep the force within its limits of magnitude, slew, energy and workspace") {
  const double rate_Hz = GENERATE(1000, 2000, 4000);
  const bool finite = GENERATE(true, false);
  const unsigned seed = GENERATE(1u, 2u, 3u);
  CAPTURE(rate_Hz, finite, seed);
  Settings settings;
  settings.rate_Hz = rate_Hz;
  settings.workspace_m = 0.05;
  // Otherwise the accounts of energy soon release surfaces that jump.
  settings.generated_limit_J = GENERATE(0.0005, 1e9);
  Bench bench(settings);
  FalseModels source{std::mt19937(seed), finite};
  // A hand that leaves its workspace and returns.
  std::vector<double> times;
  std::vector<Vector3d> places;
  for (int k = 0; k < 20; ++k)
    times.push_back(0.1 * k), places.emplace_back((k % 5 == 3 ? 0.08 : 0.01) * source.unit());
  places[0].setZero();
  VirtualHand hand(MonotoneCubic(times, places, MonotoneCubic::Ends::kRest), false,
                   {settings.hand_mass_kg, settings.hand_damping_Ns_m, settings.hand_stiffness_N_m});
  hand.begin(host_ms(0));
  Vector3d last_force = Vector3d::Zero(), last = Vector3d::Zero();
  double given_J = 0, fastest_m_s = 0;
  int pressed = 0, on_moving = 0, accepted = 0, outside = 0;
  const int ticks = static_cast<int>(2 * rate_Hz);
  for (int i = 0; i < ticks; ++i) {
    const double ms = 1e3 * i / rate_Hz;
    const DeviceState state = hand.read(host_ms(ms));
    const Vector3d moved = state.position - last;
    last = state.position;
    given_J += last_force.dot(moved);
    fastest_m_s = std::max(fastest_m_s, moved.norm() * rate_Hz);
    touch_model_t m = source.false_model(i, ms);
    if (finite) {
      if (!valid(m)) continue;
      ++accepted;
    }
    const TickOutput& out = bench.tick(ms, state.position, source.below(3) ? &m : nullptr);
    hand.write(out.force_N);
    REQUIRE(out.force_N.allFinite());
    REQUIRE(out.force_N.norm() <= settings.force_limit_N + 1e-9);
    // A skipped tick counts as at most 2 ms.
    REQUIRE(beyond_slew_N(out.force_N, last_force, settings.slew_limit_N_s * 0.002) <= 1e-9);
    if (!finite) REQUIRE(beyond_slew_N(out.force_N, last_force, settings.slew_limit_N_s / rate_Hz) <= 1e-9);
    const double drawn_back_s = settings.force_limit_N / settings.slew_limit_N_s;
    REQUIRE(given_J <= settings.energy_limit_J + settings.power_limit_W * (ms + 1) * 1e-3 +
                           settings.force_limit_N * fastest_m_s * (drawn_back_s + 0.002));
    if ((state.position).norm() > settings.workspace_m + fastest_m_s * drawn_back_s) {
      ++outside;
      REQUIRE(out.force_N.norm() == 0);
    }
    REQUIRE(out.state.coupling >= 0);
    REQUIRE(out.state.coupling <= 1);
    REQUIRE(std::isfinite(out.state.generated_J));
    pressed += out.force_N.norm() > 0.1;
    on_moving +=
        std::any_of(out.state.constraints.begin(), out.state.constraints.end(), [&](const tool_constraint_t& c) {
          return to_eigen(c.force_N).norm() > 0.1 && source.moves[c.contact_id];
        });
    last_force = out.force_N;
  }
  // Shows that surfaces were pressed, moving ones too, and that false values passed the validation.
  if (settings.generated_limit_J < 1) return;
  CHECK(pressed > ticks / 200);
  CHECK(on_moving > ticks / 400);
  if (finite) CHECK(accepted > ticks / 20);
}

TEST_CASE("The force fades to zero at the edge of the workspace") {
  SafetyLimits limits;
  limits.workspace_m = 0.1;
  Safety safety(limits);
  const Vector3d begin(1, 2, 3);
  double last = 0, most = 0;
  safety.set_position(begin);
  for (int k = 0; k <= 1500; ++k) {
    const double far = 1e-4 * k;
    safety.set_position(begin + Vector3d(far, 0, 0));
    const double force = safety.limit({0, 5, 0}, Vector3d::Zero(), 1e-3).norm();
    if (k > 3) most = std::max(most, std::abs(force - last));
    if (far < 0.0899 && k > 3) CHECK(force == Approx(5));
    if (far > 0.1001) CHECK(force == 0);
    last = force;
  }
  CHECK(most < 0.1);  // 5 N over 10 mm, at 0.1 mm a tick: 0.05 N
  safety.set_position({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  for (int k = 0; k < 10; ++k) last = safety.limit({0, 5, 0}, Vector3d::Zero(), 1e-3).norm();
  CHECK(last == 0);
}

TEST_CASE("A wider workspace of the next scene does not move its centre") {
  SafetyLimits limits;
  limits.workspace_m = 0.1;
  Safety safety(limits);
  safety.set_position({0, 0, 0});
  limits.workspace_m = 0.2;
  safety.set_limits(limits);
  safety.set_position({0.15, 0, 0});
  CHECK(safety.limit({1, 0, 0}, Vector3d::Zero(), 1e-3).norm() > 0.5);
  safety.set_position({0.21, 0, 0});
  for (int k = 0; k < 5; ++k) safety.limit({1, 0, 0}, Vector3d::Zero(), 1e-3);
  CHECK(safety.limit({1, 0, 0}, Vector3d::Zero(), 1e-3).norm() == 0);
}
