#include "sim_node/touch/tool_push.h"

#include <algorithm>
#include <tactus/header_t.hpp>
#include <tactus/tool_constraint_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::sim {

using Eigen::Vector3d;

namespace {

// The fastest haptic loop, 4 kHz, publishes every quarter of a millisecond.
constexpr double kMinInterval_s = 0.00025;
// Smaller forces are rounding of the wire format.
constexpr double kMinForce_N = 1e-9;

}  // namespace

bool ToolPush::is_repetition(const header_t& h) const {
  return h.incarnation == incarnation_ && h.seq == last_seq_ && h.publish_time_ns == last_publish_ns_;
}

// Another sender, or one whose numbers begin again, has other sums: all of them start with this message.
void ToolPush::follow(const header_t& h) {
  if (h.incarnation != incarnation_ || h.seq <= last_seq_) {
    impulses_.clear();
    last_publish_ns_ = 0;
  }
  incarnation_ = h.incarnation;
  last_seq_ = h.seq;
}

void ToolPush::add_constraint(const tool_constraint_t& c, sync::SimTime now, std::span<const BodyMotion> bodies) {
  if (!ids_.issued(c.contact_id) || c.body < 0 || static_cast<std::size_t>(c.body) >= bodies.size()) return;
  ContactImpulses& a = impulses_[c.contact_id];
  const Vector3d reported = to_eigen(c.impulse_N_s);
  if (a.since_ns != c.impulse_since_ns) {
    // A sum that is not known here. It counts from zero only if it began after the previous message of this sender;
    // a part of an older sum may have been applied already.
    const bool is_new = last_publish_ns_ > 0 && c.impulse_since_ns > last_publish_ns_;
    a.reported = is_new ? Vector3d(0, 0, 0) : reported;
    a.since_ns = c.impulse_since_ns;
  }
  a.received += reported - a.reported;
  a.reported = reported;
  a.body = c.body;
  const auto body = static_cast<std::size_t>(c.body);
  const Vector3d arm = to_eigen(c.point_m) - bodies[body].centre_m;
  const double far = arm.norm() / reach_m_[body];
  a.point = bodies[body].centre_m + (far > 1 ? Vector3d(arm / far) : arm);
  a.used = now;
}

void ToolPush::receive(std::span<const tool_state_t> new_messages, sync::SimTime now, std::span<const BodyMotion> bodies) {
  const std::int64_t publish_before_ns = last_publish_ns_;
  bool any = false;
  for (auto& [id, a] : impulses_) a.received.setZero();
  for (const tool_state_t& m : new_messages) {
    if (is_repetition(m.header)) continue;
    any = true;
    follow(m.header);
    for (const tool_constraint_t& c : m.constraints) add_constraint(c, now, bodies);
    last_publish_ns_ = m.header.publish_time_ns;
  }
  while (impulses_.size() > kMaxContacts)
    impulses_.erase(std::min_element(impulses_.begin(), impulses_.end(),
                                     [](const auto& x, const auto& y) { return x.second.used < y.second.used; }));
  if (!any) return;
  const double since_s =
      publish_before_ns > 0 ? static_cast<double>(last_publish_ns_ - publish_before_ns) * 1e-9 : settings_.step_s;
  // After a long silence, during which the force was held and faded, the impulse received meanwhile is scaled down,
  // because applying it all would be a blow.
  const double longest_s = settings_.tool_hold_s + settings_.tool_fade_s;
  const double share = since_s > longest_s ? longest_s / since_s : 1;
  // The sender's stamps do not limit what it may give; the time of this world does.
  const double heard_s = last_message_ ? sync::to_seconds(now - *last_message_) : 0;
  const double max_N_s = settings_.tool_force_limit_N * std::max(settings_.step_s, std::min(heard_s, longest_s));
  last_message_ = now;
  for (auto& [id, a] : impulses_) {
    a.received *= share;
    const double size = a.received.norm();
    if (size > max_N_s) a.received *= max_N_s / size;
    a.pending -= a.received;
    a.mean_N = -a.received / std::max(kMinInterval_s, std::min(since_s, longest_s));
  }
}

const std::vector<Push>& ToolPush::step(sync::SimTime now, std::span<const tool_state_t> new_messages,
                                        std::span<const BodyMotion> bodies) {
  const double dt = settings_.step_s;
  receive(new_messages, now, bodies);
  pushes_.clear();
  if (!last_message_) return pushes_;
  const double silence_s = sync::to_seconds(now - *last_message_);
  const double fade = std::clamp(1 - (silence_s - settings_.tool_hold_s) / settings_.tool_fade_s, 0.0, 1.0);
  for (auto& [id, a] : impulses_) {
    if (fade == 0) {
      a.pending.setZero();
      a.mean_N.setZero();
      continue;
    }
    // The newest impulse is applied now; the remaining error is corrected gradually. During silence the force is
    // held.
    Vector3d force = a.mean_N;
    if (silence_s == 0) force += (a.pending - a.mean_N * dt) / (kCorrectionSteps * dt);
    force *= fade;
    if (force.norm() > settings_.tool_force_limit_N) force *= settings_.tool_force_limit_N / force.norm();
    if (force.norm() < kMinForce_N) continue;
    a.pending -= force * dt;
    a.applied += force * dt;
    a.velocity = bodies[static_cast<std::size_t>(a.body)].velocity_at(a.point);
    pushes_.push_back({id, a.body, force, a.point});
  }
  return pushes_;
}

// Force times the mean of the velocities before and after the step is exactly the change of kinetic energy of a free
// body.
void ToolPush::add_work(std::span<const BodyMotion> bodies) {
  for (const Push& p : pushes_) {
    const auto a = impulses_.find(p.contact_id);
    if (a == impulses_.end()) continue;
    const Vector3d after = bodies[static_cast<std::size_t>(p.body)].velocity_at(p.point_m);
    a->second.energy_J += p.force_N.dot(0.5 * (a->second.velocity + after)) * settings_.step_s;
  }
}

void ToolPush::applied_impulses(std::vector<touch_applied_t>& out, std::size_t max_count) const {
  out.clear();
  std::vector<std::pair<sync::SimTime, std::int64_t>> latest;
  for (const auto& [id, a] : impulses_) latest.emplace_back(a.used, id);
  std::sort(latest.rbegin(), latest.rend());
  for (std::size_t i = 0; i < std::min(max_count, latest.size()); ++i) {
    const ContactImpulses& a = impulses_.at(latest[i].second);
    touch_applied_t entry{};
    entry.contact_id = latest[i].second;
    entry.impulse_N_s = to_vec3(a.applied);
    entry.energy_J = a.energy_J;
    out.push_back(entry);
  }
}

}  // namespace tactus::sim
