#include "sim_node/behaviour/impulse/joint_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::sim::impulse {
namespace {

constexpr double kNoLimit = 1e15;
constexpr double kUnbounded = std::numeric_limits<double>::max();
// A limit further away than this many steps at the present rate, and this far besides, is left out, rad or m.
constexpr double kStepsAhead = 4, kAhead = 0.05;

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

void append_rows(articulated::ArticulatedSystem& system, std::size_t first_rate, double h, double repair,
                 JointMemory& memory, std::vector<JointRow>& rows, std::vector<double>& pool) {
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
    if (!(d.friction > 0 || d.motor_effort > 0 || low || high || stiff)) continue;
    JointRow row;
    row.rate = first_rate + j;
    row.first_rate = first_rate;
    row.rates = n;
    row.response = pool.size();
    pool.resize(pool.size() + n);
    system.dynamics().strike_dof(static_cast<int>(j), {pool.data() + row.response, n});
    row.mobility = pool[row.response + j];
    const auto add = [&](double wanted, double softness, double least, double most, double& kept) {
      row.wanted = wanted;
      row.softness = softness;
      row.least = least;
      row.most = most;
      row.impulse = std::clamp(kept, least, most);
      row.memory = &kept;
      rows.push_back(row);
    };
    if (stiff) {
      // The spring and damper at the end of the step: impulse = -h (k (q + h rate - reference) + d rate).
      const double softness = 1 / (h * (d.damping + h * d.stiffness));
      add(-h * d.stiffness * (q - d.reference) * softness, softness, -kUnbounded, kUnbounded, memory.spring[j]);
    }
    if (d.motor_effort > 0) add(d.motor_velocity, 0, -h * d.motor_effort, h * d.motor_effort, memory.motor[j]);
    if (d.friction > 0) add(0, 0, -h * d.friction, h * d.friction, memory.friction[j]);
    const auto parting = [&](double room) { return room >= 0 ? -room / h : -repair * room / h; };
    if (low) add(parting(q - d.lower), 0, 0, kUnbounded, memory.limit[j]);
    if (high) add(-parting(d.upper - q), 0, -kUnbounded, 0, memory.limit[j]);
  }
}

void apply(const JointRow& row, double impulse, const std::vector<double>& pool, Velocities& v) {
  const double* response = pool.data() + row.response;
  double* rates = v.rates.data() + row.first_rate;
  for (std::size_t i = 0; i < row.rates; ++i) rates[i] += response[i] * impulse;
}

double sweep(JointRow& row, const std::vector<double>& pool, Velocities& v) {
  const double missing = row.wanted - v.rates[row.rate] - row.softness * row.impulse;
  const double impulse = std::clamp(row.impulse + missing / (row.mobility + row.softness), row.least, row.most);
  const double by = impulse - row.impulse;
  row.impulse = impulse;
  apply(row, by, pool, v);
  return std::abs(by) * (row.mobility + row.softness);
}

}  // namespace tactus::sim::impulse
