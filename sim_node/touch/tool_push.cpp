#include "sim_node/touch/tool_push.h"

#include <algorithm>
#include <cmath>
#include <tactus/header_t.hpp>
#include <tactus/tool_constraint_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::sim {

using Eigen::Vector3d;

namespace {

// A haptic loop of 4 kHz, the fastest there is, sends every quarter of a millisecond.
constexpr double kShortest_s = 0.00025;
// Less is rounding of the wire.
constexpr double kLeast_N = 1e-9;

}  // namespace

bool ToolPush::accept(const header_t& header) {
  if (header.incarnation == incarnation_) {
    if (header.seq <= last_seq_) return false;
    last_seq_ = header.seq;
    return true;
  }
  if (header.incarnation == replaced_) return false;
  accounts_.clear();
  replaced_ = incarnation_;
  incarnation_ = header.incarnation;
  last_seq_ = header.seq;
  last_publish_ns_ = 0;
  return true;
}

void ToolPush::note(const tool_constraint_t& c, sync::SimTime now, std::span<const BodyMotion> bodies) {
  if (!ids_.issued(c.contact_id) || c.body < 0 || static_cast<std::size_t>(c.body) >= bodies.size()) return;
  Account& a = accounts_[c.contact_id];
  const Vector3d told = to_eigen(c.impulse_N_s);
  a.felt += told - a.told;
  a.told = told;
  a.body = c.body;
  const auto body = static_cast<std::size_t>(c.body);
  const Vector3d arm = to_eigen(c.point_m) - bodies[body].centre_m;
  const double far = arm.norm() / reach_m_[body];
  a.point = bodies[body].centre_m + (far > 1 ? Vector3d(arm / far) : arm);
  a.used = now;
}

void ToolPush::take(std::span<const tool_state_t> news, sync::SimTime now, std::span<const BodyMotion> bodies) {
  bool any = false;
  std::int64_t publish_ns = 0;
  for (auto& [id, a] : accounts_) a.felt.setZero();
  for (const tool_state_t& m : news) {
    if (!accept(m.header)) continue;
    any = true;
    publish_ns = m.header.publish_time_ns;
    for (const tool_constraint_t& c : m.constraints) note(c, now, bodies);
  }
  if (!any) return;
  const double since_s = last_publish_ns_ > 0 ? static_cast<double>(publish_ns - last_publish_ns_) * 1e-9 : settings_.step_s;
  last_publish_ns_ = publish_ns;
  heard_ = now;
  // After a long silence, for which the force was held and faded, what was felt meanwhile is not made up for: it would be
  // a blow.
  const double longest_s = settings_.tool_hold_s + settings_.tool_fade_s;
  const double due = since_s > longest_s ? longest_s / since_s : 1;
  for (auto& [id, a] : accounts_) {
    a.owed -= due * a.felt;
    a.mean_N = -a.felt / std::max(since_s, kShortest_s);
  }
}

const std::vector<Push>& ToolPush::step(sync::SimTime now, std::span<const tool_state_t> news,
                                        std::span<const BodyMotion> bodies) {
  const double dt = settings_.step_s;
  take(news, now, bodies);
  pushes_.clear();
  if (!heard_) return pushes_;
  const double silent_s = sync::to_seconds(now - *heard_);
  const double fade = std::clamp(1 - (silent_s - settings_.tool_hold_s) / settings_.tool_fade_s, 0.0, 1.0);
  for (auto& [id, a] : accounts_) {
    if (fade == 0) {
      a.owed.setZero();
      a.mean_N.setZero();
      continue;
    }
    // What is told of now is applied now; what is left over or was too much, bit by bit. In silence the force is held.
    Vector3d force = a.mean_N;
    if (silent_s == 0) force += (a.owed - a.mean_N * dt) / (kMakeUpSteps * dt);
    force *= fade;
    if (force.norm() > settings_.tool_force_limit_N) force *= settings_.tool_force_limit_N / force.norm();
    if (force.norm() < kLeast_N) continue;
    a.owed -= force * dt;
    a.applied += force * dt;
    a.velocity = bodies[static_cast<std::size_t>(a.body)].velocity_at(a.point);
    pushes_.push_back({id, a.body, force, a.point});
  }
  while (accounts_.size() > kRemembered)
    accounts_.erase(std::min_element(accounts_.begin(), accounts_.end(),
                                     [](const auto& x, const auto& y) { return x.second.used < y.second.used; }));
  return pushes_;
}

// Force times the mean of the velocities before and after is the change of kinetic energy, exactly, of a free body.
void ToolPush::settle(std::span<const BodyMotion> bodies) {
  for (const Push& p : pushes_) {
    const auto a = accounts_.find(p.contact_id);
    if (a == accounts_.end()) continue;
    const Vector3d after = bodies[static_cast<std::size_t>(p.body)].velocity_at(p.point_m);
    a->second.energy_J += p.force_N.dot(0.5 * (a->second.velocity + after)) * settings_.step_s;
  }
}

void ToolPush::books(std::vector<touch_applied_t>& out, std::size_t most) const {
  out.clear();
  std::vector<std::pair<sync::SimTime, std::int64_t>> latest;
  for (const auto& [id, a] : accounts_) latest.emplace_back(a.used, id);
  std::sort(latest.rbegin(), latest.rend());
  for (std::size_t i = 0; i < std::min(most, latest.size()); ++i) {
    const Account& a = accounts_.at(latest[i].second);
    touch_applied_t book{};
    book.contact_id = latest[i].second;
    book.impulse_N_s = to_vec3f(a.applied);
    book.energy_J = static_cast<float>(a.energy_J);
    out.push_back(book);
  }
}

}  // namespace tactus::sim
