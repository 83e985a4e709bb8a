// Stability limits of contact and hands in worlds of one and two groups, with the whole simulation.
#include "tests/bench/sim_node/stability_groups.h"

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/behaviour/behaviour_checks.h"
#include "sim_node/world/simulation.h"
#include "sim_node/dual/dual_groups.h"
#include "tests/bench/sim_node/stability.h"
#include "tests/sim_node/support/simple_hand.h"

namespace tactus::sim::bench {
namespace {

using Eigen::Vector3d;
using namespace tactus::sim::test;

// Shell of the simulation: the gap at which surfaces meet when their springs are compressed (contact_law).
constexpr double kShell_m = 1e-5;
// Out of reach of the hand.
constexpr double kFar_m = 3;
// Steps before the push, and after it.
constexpr int kSettleSteps = 300, kWatchedSteps = 3000;
// A structure far from the hand stands if it is within this distance of its first position, m.
constexpr double kMaxDrift_m = 1e-3;

const std::array<GroupedRow, 6> kRows{{
    {"all at 1/60 s, explicit", "single", "penalty_explicit", 1.0 / 60},
    {"all at 1/60 s, implicit", "single", "penalty", 1.0 / 60},
    {"all at 1 kHz, explicit", "single", "penalty_explicit", 0.001},
    {"all at 1 kHz, implicit", "single", "penalty", 0.001},
    {"dual, explicit", "dual", "penalty_explicit", 0.001},
    {"dual, implicit", "dual", "impulse", 0.001},
}};

Settings settings_for(const GroupedRow& row) {
  Settings s;
  s.groups = row.groups;
  s.solver = row.solver;
  s.step_s = row.step_s;
  s.visual_thread = "none";
  s.visual_substeps = 1;  // steps of 1/60 s, as in the paper
  return s;
}

double kinetic_J(std::span<const BodyMotion> bodies) {
  double sum = 0;
  for (const BodyMotion& m : bodies)
    sum += m.velocity_m_s.squaredNorm() / m.inverse_mass_1_kg / 2 +
           m.spin_rad_s.dot(m.inverse_inertia.inverse() * m.spin_rad_s) / 2;
  return sum;
}

// The ball or tower at x. Each surface lies above the next at the gap at which its springs bear the load above it or, without springs, at
// the gap at which they meet.
void add_standing(WorldDef& w, double x, int boxes, double each_m, double up_m, bool springs) {
  const auto gap = [&](int bears) { return kShell_m + up_m - (springs ? bears * each_m : 0); };
  if (boxes == 0) add_ball(w, kLightest_kg, 0.03, {x, 0, 0.03 + gap(1)}, 0.5, 0);
  double z = 0;
  for (int i = 0; i < boxes; ++i) {
    z += gap(boxes - i);
    add_box(w, 4 * kLightest_kg, {0.1, 0.1, 0.1}, at(x, 0, z + 0.05));
    z += 0.1;
  }
}

}  // namespace

std::span<const GroupedRow> grouped_rows() { return kRows; }

bool grouped_stays_stable(const GroupedRow& row, int boxes, double x) {
  const double h = row.step_s, k = x * kLightest_kg / (h * h), up = kBends * bend_m(k);
  const bool dual = row.groups == "dual";
  Settings s = settings_for(row);
  s.penalty_stiffness_N_m = k;
  s.penalty_damping_Ns_m = kDampingRatio * 2 * std::sqrt(k * kLightest_kg);
  s.contact_tolerance_m = up + kShell_m;
  s.correcting_speed_m_s = 0;  // springs that are loaded at the start carry the load immediately
  WorldDef w = empty_world(kToyG);
  add_floor(w);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1e-6, 1e-6);
  const auto any = [&] { return Vector3d(u(random), u(random), u(random)); };
  add_standing(w, 0, boxes, bend_m(k), up, true);
  const int near = static_cast<int>(w.bodies.size());
  add_standing(w, kFar_m, boxes, bend_m(k), up, !dual);
  const int all = static_cast<int>(w.bodies.size());
  // The state gives the velocity now, but the law uses that of half a step before, when gravity alone had not acted yet. This offset makes
  // the latter zero.
  for (int i = 1; i < all; ++i) {
    w.bodies[static_cast<std::size_t>(i)].velocity_m_s = any();
    if (i < near || !dual) w.bodies[static_cast<std::size_t>(i)].velocity_m_s.z() -= kToyG * h / 2;
  }
  add_tool(w, {boxes == 0 ? 0.05 : 0.07, 0, 0.04});
  if (!unsupported_reason(w, s).empty()) return false;
  Simulation simulation(w, s);
  simulation.start(1);
  for (int i = 0; i < kSettleSteps; ++i) simulation.step({});
  for (int i = 1; i < near; ++i) simulation.mechanics().set_spin(i, any() / 0.05);
  const auto count = static_cast<std::size_t>(near - 1);
  const double first = static_cast<double>(count) * 4 * kLightest_kg * 1e-12;
  for (int i = 0; i < kWatchedSteps; ++i) {
    simulation.step({});
    const auto bodies = simulation.bodies();
    if (!(kinetic_J(bodies.subspan(1, count)) < 100 * first)) return false;
    for (std::size_t far = count + 1; far <= 2 * count; ++far)
      if (!((bodies[far].centre_m - w.bodies[far].pose.translation()).norm() < kMaxDrift_m)) return false;
    if (!dual) continue;
    const auto& groups = dynamic_cast<const DualGroups&>(simulation.mechanics());
    if (!groups.is_haptic(1) || groups.is_haptic(all - 1))
      throw std::logic_error("stability_table: the groups are not those of the row \"" + row.name + "\"");
  }
  return true;
}

namespace {

// A hand that is held in place, with a spring and a damper where a surface penetrates it. Between messages of the simulation a surface
// continues its motion.
struct Holding {
  Vector3d place;
  double stiffness_N_m, damping_N_s_m, radius_m = 0.01;
  int tool;
  std::int64_t seq = 0;
  std::map<std::int64_t, Vector3d> impulses{};
  std::map<std::int64_t, std::int64_t> begun_ns{};  // begin of each of these sums

  tool_state_t tick(const touch_model_t& model, double since_s, std::int64_t time_ns) {
    tool_state_t m{};
    m.tool = tool;
    m.header.sim_time_ns = time_ns;
    m.header.publish_time_ns = 1'000'000'000 + time_ns;
    m.header.incarnation = 40 + tool;
    m.header.seq = seq++;
    Vector3d proxy = place;
    for (const touch_plane_t& p : model.planes) {
      const Vector3d n = to_eigen(p.normal).normalized(), v = to_eigen(p.velocity_m_s);
      const double gap = (place - to_eigen(p.point_m) - since_s * v).dot(n) - radius_m;
      Vector3d force = Vector3d::Zero();
      if (gap < 0) {
        proxy -= gap * n;
        force = std::max(0.0, -stiffness_N_m * gap + damping_N_s_m * v.dot(n)) * n;
      }
      const std::int64_t since_ns = begun_ns.try_emplace(p.contact_id, m.header.publish_time_ns - 1).first->second;
      Vector3d& impulse = impulses.try_emplace(p.contact_id, Vector3d::Zero()).first->second;
      impulse += 0.001 * force;
      tool_constraint_t& c = m.constraints.emplace_back();
      c.contact_id = p.contact_id;
      c.body = p.body;
      c.point_m = to_vec3(proxy - radius_m * n);
      c.force_N = to_vec3f(force);
      c.impulse_N_s = to_vec3(impulse);
      c.impulse_since_ns = since_ns;
    }
    m.constraint_count = static_cast<std::int32_t>(m.constraints.size());
    m.device.position_m = to_vec3(place);
    m.proxy.position_m = to_vec3(proxy);
    m.device.orientation.w = m.proxy.orientation.w = 1;
    return m;
  }
};

}  // namespace

bool two_hands_stay_stable(const GroupedRow& row, double k) {
  // Each presses with 2 N, within the limit of the simulation for a hand; the push moves the box by a tenth of that.
  constexpr double kPress_N = 2, kHalf_m = 0.05, kRadius_m = 0.01;
  const double depth = kPress_N / k, swing = std::sqrt(2 * k / kHeld_kg);
  WorldDef w = empty_world(0);
  const int box = add_box(w, kHeld_kg, {2 * kHalf_m, 2 * kHalf_m, 2 * kHalf_m}, at(0, 0, 0));
  const Vector3d right(kHalf_m + kRadius_m - depth, 0, 0);
  std::array<Holding, 2> hands;
  for (int i = 0; i < 2; ++i) {
    const Vector3d place = i == 0 ? right : Vector3d(-right);
    add_tool(w, place, kRadius_m);
    hands[static_cast<std::size_t>(i)] = {place, k, 0.7 * std::sqrt(2 * k * kHeld_kg), kRadius_m, i};
  }
  w.bodies[static_cast<std::size_t>(box)].velocity_m_s = {0.1 * depth * swing, 0, 0};
  Settings s = settings_for(row);
  s.penalty_stiffness_N_m = 1, s.penalty_damping_Ns_m = 0;  // contact between bodies, which does not occur here
  Simulation simulation(w, s);
  simulation.start(1);
  const double period_s = 2 * M_PI / swing;
  const auto steps = static_cast<int>(std::max(400.0, 60 * period_s / row.step_s));
  std::vector<tool_state_t> states;
  std::int64_t tick = 0;
  double early = 0, late = 0;
  for (int i = 0; i < steps; ++i) {
    states.clear();
    const double now_s = sync::to_seconds(simulation.now().time_since_epoch());
    for (; 0.001 * static_cast<double>(tick) < now_s + row.step_s - 1e-9; ++tick)
      for (Holding& hand : hands)
        states.push_back(hand.tick(simulation.touch_models()[static_cast<std::size_t>(hand.tool)],
                                 0.001 * static_cast<double>(tick) - now_s, tick * 1'000'000));
    simulation.step(states);
    const double away = std::abs(simulation.bodies()[static_cast<std::size_t>(box)].centre_m.x());
    if (i < steps / 4) early = std::max(early, away);
    if (i >= 3 * steps / 4) late = std::max(late, away);
  }
  return late < 0.5 * early;
}

}  // namespace tactus::sim::bench
