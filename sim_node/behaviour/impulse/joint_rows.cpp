#include "sim_node/behaviour/impulse/joint_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::sim::impulse {
namespace {

constexpr double kNoLimit = 1e15;
constexpr double kUnbounded = std::numeric_limits<double>::max();
// A limit further away than this number of steps at the current rate plus this distance, rad or m, gets no row.
constexpr double kStepsAhead = 4, kAhead = 0.05;
// Time in which a joint that is far outside its limits returns by two thirds, s; design.
constexpr double kReturn_s = 0.5;
// Violations up to this are rounding, m or rad.
constexpr double kWithin = 1e-9;

bool of_ball(const articulated::Tree& tree, const articulated::Dof& d) {
  return tree.links[static_cast<std::size_t>(d.link)].dofs == 3;
}

// The row of a degree of freedom, with its response in the pool, without limits and targets.
JointRow row_of(articulated::ArticulatedSystem& system, std::size_t first_rate, std::size_t dof, std::vector<double>& pool) {
  JointRow row;
  row.rate = first_rate + dof;
  row.first_rate = first_rate;
  row.rates = system.tree().dofs.size();
  row.response = pool.size();
  pool.resize(pool.size() + row.rates);
  system.dynamics().dof_impulse_to_rates(static_cast<int>(dof), {pool.data() + row.response, row.rates});
  row.mobility = pool[row.response + dof];
  return row;
}

}  // namespace

bool needs_rows(const articulated::ArticulatedSystem& system) {
  const auto& dofs = system.tree().dofs;
  for (std::size_t j = 0; j < dofs.size(); ++j) {
    const articulated::Dof& d = dofs[j];
    if (d.friction > 0 || d.motor_effort > 0 || d.lower > -kNoLimit || d.upper < kNoLimit ||
        system.is_stiff(static_cast<int>(j)))
      return true;
  }
  return false;
}

void append_rows(articulated::ArticulatedSystem& system, std::size_t first_rate, double h, JointImpulses& memory, std::vector<JointRow>& rows, std::vector<double>& pool) {
  const auto& dofs = system.tree().dofs;
  const std::size_t n = dofs.size();
  for (std::size_t j = 0; j < n; ++j) {
    const articulated::Dof& d = dofs[j];
    const double rate = system.state().rates[j];
    const double q = d.coordinate < 0 ? 0 : system.state().positions[static_cast<std::size_t>(d.coordinate)];
    const double ahead = kStepsAhead * h * std::abs(rate) + kAhead;
    const bool low = d.lower > -kNoLimit && q - d.lower < ahead, high = d.upper < kNoLimit && d.upper - q < ahead;
    const bool stiff = system.is_stiff(static_cast<int>(j));
    if (!low && !high) memory.limit[j] = 0;
    const bool ball = of_ball(system.tree(), d);
    if (!((d.friction > 0 && !ball) || d.motor_effort > 0 || low || high || stiff)) continue;
    JointRow row = row_of(system, first_rate, j, pool);
    const auto add = [&](double target_rate, double softness, double min_impulse, double max_impulse,
                         double& saved) {
      row.target_rate = target_rate;
      row.softness = softness;
      row.min_impulse = min_impulse;
      row.max_impulse = max_impulse;
      row.impulse = std::clamp(saved, min_impulse, max_impulse);
      row.memory = &saved;
      rows.push_back(row);
    };
    if (stiff) {
      // Spring and damper at the end of the step: impulse = -h (k (q + h rate - reference) + d rate).
      const double softness = 1 / (h * (d.damping + h * d.stiffness));
      add(-h * d.stiffness * (q - d.reference) * softness, softness, -kUnbounded, kUnbounded, memory.spring[j]);
    }
    if (d.motor_effort > 0) add(d.motor_velocity, 0, -h * d.motor_effort, h * d.motor_effort, memory.motor[j]);
    if (d.friction > 0 && !ball) add(0, 0, -h * d.friction, h * d.friction, memory.friction[j]);
    // Up to the limit within the step. Beyond it positions are corrected (limit_corrections), which leaves no speed.
    const auto parting = [&](double room) { return -std::max(0.0, room) / h; };
    if (low) add(parting(q - d.lower), 0, 0, kUnbounded, memory.limit[j]);
    if (high) add(-parting(d.upper - q), 0, -kUnbounded, 0, memory.limit[j]);
  }
}

bool limit_corrections(const articulated::ArticulatedSystem& system, double h, double share, double speed, std::vector<double>& by) {
  const auto& dofs = system.tree().dofs;
  by.assign(dofs.size(), 0);
  bool any = false;
  for (std::size_t j = 0; j < dofs.size(); ++j) {
    const articulated::Dof& d = dofs[j];
    if (d.coordinate < 0) continue;
    const double q = system.state().positions[static_cast<std::size_t>(d.coordinate)];
    const double beyond = d.lower > -kNoLimit && q < d.lower ? d.lower - q : d.upper < kNoLimit && q > d.upper ? d.upper - q : 0;
    if (std::abs(beyond) <= kWithin) continue;
    const double distance = std::abs(beyond);
    by[j] = std::copysign(std::min(share * distance, h * std::max(speed, distance / kReturn_s)), beyond);
    any = true;
  }
  return any;
}

void append_ball_friction(articulated::ArticulatedSystem& system, std::size_t first_rate, double h,
                          JointImpulses& memory, std::vector<JointRow>& rows, std::vector<double>& pool) {
  const auto& tree = system.tree();
  const std::size_t n = tree.dofs.size();
  for (std::size_t j = 0; j < n; ++j) {
    const articulated::Dof& d = tree.dofs[j];
    if (!of_ball(tree, d) || !(d.friction > 0)) continue;
    JointRow row = row_of(system, first_rate, j, pool);
    row.max_impulse = h * d.friction;
    row.impulse = std::clamp(memory.friction[j], -row.max_impulse, row.max_impulse);
    row.memory = &memory.friction[j];
    row.ball = static_cast<int>(j) == tree.links[static_cast<std::size_t>(d.link)].first_dof ? 3 : 1;
    rows.push_back(row);
  }
}

void apply(const JointRow& row, double impulse, const std::vector<double>& pool, Velocities& v) {
  const double* response = pool.data() + row.response;
  double* rates = v.rates.data() + row.first_rate;
  for (std::size_t i = 0; i < row.rates; ++i) rates[i] += response[i] * impulse;
}

namespace {

// Three rows of one torque, bounded as a whole: first a step towards zero rate with the sum of the three mobilities,
// then a projection into the ball of the friction limit. A fixed point is at rest, or has the full torque against the
// rotation.
double sweep_ball(JointRow* rows, const std::vector<double>& pool, Velocities& v) {
  double mobility = 0;
  for (int k = 0; k < 3; ++k) mobility += rows[k].mobility;
  Eigen::Vector3d next;
  for (int k = 0; k < 3; ++k) next[k] = rows[k].impulse - v.rates[rows[k].rate] / mobility;
  if (next.norm() > rows[0].max_impulse) next *= rows[0].max_impulse / next.norm();
  double change = 0;
  for (int k = 0; k < 3; ++k) {
    const double by = next[k] - rows[k].impulse;
    rows[k].impulse = next[k];
    apply(rows[k], by, pool, v);
    change = std::max(change, std::abs(by) * mobility);
  }
  return change;
}

}  // namespace

double sweep(JointRow& row, const std::vector<double>& pool, Velocities& v) {
  if (row.ball) return row.ball == 3 ? sweep_ball(&row, pool, v) : 0;
  const double rate_error = row.target_rate - v.rates[row.rate] - row.softness * row.impulse;
  const double impulse =
      std::clamp(row.impulse + rate_error / (row.mobility + row.softness), row.min_impulse, row.max_impulse);
  const double by = impulse - row.impulse;
  row.impulse = impulse;
  apply(row, by, pool, v);
  return std::abs(by) * (row.mobility + row.softness);
}

}  // namespace tactus::sim::impulse
