#include "sim_node/dual/grouping.h"

#include <algorithm>
#include <iterator>

namespace tactus::sim {
namespace {
constexpr double kTick_s = 0.001;
}  // namespace

Grouping::Grouping(std::vector<GroupBody> bodies, const GroupingLimits& limits, GroupingRule rule)
    : bodies_(std::move(bodies)), limits_(limits), rule_(rule) {
  const std::size_t n = bodies_.size();
  departed_trajectories_.resize(n);
  is_departed_.resize(n);
  inside_.resize(n);
  impact_bounds_.resize(n);
  member_.resize(n);
  last_reached_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (bodies_[i].inverse_mass_1_kg > 0) movers_.push_back(static_cast<int>(i));
    const int system = bodies_[i].system;
    if (system < 0) continue;
    systems_.resize(std::max(systems_.size(), static_cast<std::size_t>(system) + 1));
    systems_[static_cast<std::size_t>(system)].push_back(static_cast<int>(i));
  }
}

double Grouping::remaining_s(sync::SimTime now) const {
  return std::max(0.0, sync::to_seconds(step_began_ + limits_.horizon - now));
}

namespace {
// Displacement by a constant acceleration in n ticks for a body that is moved once per tick: h^2 n (n + 1) / 2.
double acceleration_offset_m(double acceleration, double t_s) { return acceleration * t_s * (t_s + kTick_s) / 2; }
}  // namespace

// The pad covers gravity and impacts.
SweptSphere Grouping::swept(std::size_t i, const BodyMotion& m, double t) const {
  return {m.centre_m, m.velocity_m_s, bodies_[i].radius_m,
          acceleration_offset_m(limits_.gravity_m_s2, t) +
              impact_bounds_[i].speed_m_s * std::clamp(impact_bounds_[i].remaining_s + kTick_s, 0.0, t + kTick_s)};
}

SweptSphere Grouping::swept(const GroupTool& tool, double t) const {
  return {tool.centre_m, tool.velocity_m_s, tool.radius_m, acceleration_offset_m(limits_.tool_acceleration_m_s2, t)};
}

// An impact changes the velocity by at most (1 + e) times the closing velocity (Newton's law, for a tool of infinite
// mass), and by at most the impulse of the tool's limited force. Impacts by struck bodies are left to check_pads(): pads
// for them make the group ten times as large and avoid less than half of the alarms (grouping_table at 30 m/s^2, both
// variants).
double Grouping::max_impact_speed_m_s(const SweptSphere& tool, std::size_t body, double t) const {
  const double meeting =
      (tool.velocity_m_s - trajectory_of(static_cast<int>(body)).velocity_m_s).norm() + (t > 0 ? tool.pad_m / t : 0);
  return std::min((1 + limits_.restitution) * meeting, limits_.tool_force_N * bodies_[body].inverse_mass_1_kg * t);
}

void Grouping::add_to_group(int body_index, ImpactBound bound, sync::SimTime now,
                            std::span<const BodyMotion> bodies) {
  const auto i = static_cast<std::size_t>(body_index);
  if (member_[i] || bodies_[i].inverse_mass_1_kg <= 0) return;
  member_[i] = 1;
  impact_bounds_[i] = bound;
  inside_[i] = swept(i, bodies[i], remaining_s(now));
  // A body that enters from outside is at the present point of its trajectory.
  if (!all_have_trajectories_ && !is_departed_[i]) {
    const SweptSphere& trajectory = trajectories_->of(body_index);
    inside_[i].centre_m =
        trajectory.centre_m + trajectory.velocity_m_s * (held_ ? held_after_s_ : sync::to_seconds(now - step_began_));
    inside_[i].velocity_m_s = trajectory.velocity_m_s;
    inside_[i].pad_m += 2 * trajectory.pad_m;
  }
  haptic_.push_back(body_index);
}

// Writes to found_. Departed bodies have no bounds in the grid, because they are few.
void Grouping::find_outside(const Bounds& query) {
  found_.clear();
  trajectories_->find(query, found_);
  // A body that was in the group has no valid trajectory, even if one was computed before it entered the group.
  std::erase_if(found_, [&](int j) { return is_departed_[static_cast<std::size_t>(j)] != 0; });
  found_.insert(found_.end(), departed_.begin(), departed_.end());
}

void Grouping::add_reachable(const SweptSphere& from, double inverse_mass, sync::SimTime now,
                             std::span<const BodyMotion> bodies) {
  const double t = remaining_s(now), passed = sync::to_seconds(now - step_began_);
  find_outside(bounds_of(from, t));
  for (const int j : found_) {
    const auto body = static_cast<std::size_t>(j);
    if (member_[body]) continue;
    SweptSphere other = trajectory_of(j);
    other.centre_m += other.velocity_m_s * (held_ ? held_after_s_ : passed);
    if (held_) other.velocity_m_s.setZero();
    const double meeting =
        first_contact_time_s(from, other, from.radius_m + other.radius_m + from.pad_m + other.pad_m, t);
    if (meeting < 0) continue;
    const bool struck_by_tool = inverse_mass <= 0;
    add_to_group(j, struck_by_tool ? ImpactBound{max_impact_speed_m_s(from, body, t), t - meeting} : ImpactBound{},
                 now, bodies);
  }
}

void Grouping::close_group(sync::SimTime now, std::span<const BodyMotion> bodies,
                           std::span<const GroupTool> tools) {
  watched_from_ = now;
  const double t = remaining_s(now);
  tools_.clear();
  for (const GroupTool& tool : tools) tools_.push_back(swept(tool, t));
  for (const int i : haptic_)
    inside_[static_cast<std::size_t>(i)] =
        swept(static_cast<std::size_t>(i), bodies[static_cast<std::size_t>(i)], t);
  for (const SweptSphere& tool : tools_) add_reachable(tool, 0, now, bodies);
  // The list grows during the iteration.
  for (std::size_t k = 0; k < haptic_.size(); ++k) {
    const auto i = static_cast<std::size_t>(haptic_[k]);
    const ImpactBound bound = impact_bounds_[i];
    if (bodies_[i].system >= 0)
      for (const int j : systems_[static_cast<std::size_t>(bodies_[i].system)])
        add_to_group(j, bound, now, bodies);
    for (const int j : trajectories_->touched_by(haptic_[k])) add_to_group(j, bound, now, bodies);
    for (auto pair = std::lower_bound(touching_.begin(), touching_.end(), std::pair(haptic_[k], -1));
         pair != touching_.end() && pair->first == haptic_[k]; ++pair)
      add_to_group(pair->second, bound, now, bodies);
    add_reachable(inside_[i], bodies_[i].inverse_mass_1_kg, now, bodies);
  }
}

void Grouping::close_kim2005(std::span<const BodyMotion> bodies, std::span<const GroupTool> tools) {
  const double t = remaining_s(step_began_);
  for (const GroupTool& tool : tools)
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const SweptSphere from{tool.centre_m, tool.velocity_m_s, tool.radius_m, 0};
      const SweptSphere body{bodies[i].centre_m, bodies[i].velocity_m_s, bodies_[i].radius_m, 0};
      if (axis_distance_m(from, body, t) <= from.radius_m + body.radius_m)
        add_to_group(static_cast<int>(i), {}, step_began_, bodies);
    }
}

// Whether a body that would leave may meet, in this step, a body that does not leave with it.
bool Grouping::reaches_group(int body, sync::SimTime now) {
  const double t = remaining_s(now);
  const SweptSphere& from = trajectory_of(body);
  find_outside(bounds_of(from, t));
  return std::any_of(found_.begin(), found_.end(), [&](int j) {
    if (leaves_[static_cast<std::size_t>(j)]) return false;
    const SweptSphere& other = trajectory_of(j);
    return first_contact_time_s(from, other, from.radius_m + other.radius_m + from.pad_m + other.pad_m, t) >= 0;
  });
}

// A body that nothing requires any more leaves by itself, or stays with every body that it may meet.
void Grouping::update_leaving(sync::SimTime now, std::span<const BodyMotion> bodies) {
  leaves_.resize(bodies_.size());
  for (const int i : before_) leaves_[static_cast<std::size_t>(i)] = !member_[static_cast<std::size_t>(i)];
  for (bool changed = true; changed;) {
    changed = false;
    for (const int i : before_) {
      if (!leaves_[static_cast<std::size_t>(i)] || !reaches_group(i, now)) continue;
      leaves_[static_cast<std::size_t>(i)] = 0;
      add_to_group(i, {}, now, bodies);
      changed = true;
    }
  }
  for (const int i : before_) leaves_[static_cast<std::size_t>(i)] = 0;
}

void Grouping::set_touching(std::span<const std::pair<int, int>> touching) {
  touching_.clear();
  for (const auto& [a, b] : touching) {
    touching_.emplace_back(a, b);
    touching_.emplace_back(b, a);
  }
  std::sort(touching_.begin(), touching_.end());
}

// Records the bodies that entered in a call in which no body leaves.
void Grouping::record_entered(sync::SimTime now) {
  std::sort(haptic_.begin(), haptic_.end());
  entered_.clear();
  left_.clear();
  std::set_difference(haptic_.begin(), haptic_.end(), before_.begin(), before_.end(),
                      std::back_inserter(entered_));
  for (const int i : entered_) last_reached_[static_cast<std::size_t>(i)] = now;
}

void Grouping::hold_step(sync::SimTime now, std::span<const BodyMotion> bodies,
                         std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools) {
  if (!held_) held_after_s_ = sync::to_seconds(now - step_began_);
  held_ = true;
  step_began_ = now;
  set_touching(touching);
  before_ = haptic_;
  close_group(now, bodies, tools);
  enter_requested(now, bodies);
  close_group(now, bodies, tools);
  record_entered(now);
}

void Grouping::enter_requested(sync::SimTime now, std::span<const BodyMotion> bodies) {
  for (const int body : requested_) {
    add_to_group(body, {}, now, bodies);
    last_reached_[static_cast<std::size_t>(body)] = now;
  }
  requested_.clear();
}

void Grouping::begin_step(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const double> deviations_m,
                          std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools) {
  straight_.clear();
  for (const int i : movers_) {
    const auto k = static_cast<std::size_t>(i);
    straight_.push_back(
        {bodies[k].centre_m, bodies[k].velocity_m_s, bodies_[k].radius_m, deviations_m[k] + limits_.tolerance_m});
  }
  own_trajectories_.set(bodies.size(), movers_, straight_, touching, sync::to_seconds(limits_.horizon));
  begin(now, own_trajectories_, true, bodies, {}, tools);
}

void Grouping::begin_step(sync::SimTime now, const SweptTrajectories& trajectories, std::span<const BodyMotion> bodies,
                          std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools) {
  begin(now, trajectories, false, bodies, touching, tools);
}

void Grouping::begin(sync::SimTime now, const SweptTrajectories& trajectories, bool includes_all, std::span<const BodyMotion> bodies,
                     std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools) {
  step_began_ = now;
  all_have_trajectories_ = includes_all;
  trajectories_ = &trajectories;
  held_ = false;
  for (const int i : departed_) is_departed_[static_cast<std::size_t>(i)] = 0;
  departed_.clear();
  set_touching(touching);
  std::swap(before_, haptic_);
  haptic_.clear();
  for (const int i : before_) {
    member_[static_cast<std::size_t>(i)] = 0;
    // No trajectory exists for this body if it leaves: it may fall and reverse its direction. The pad covers both.
    if (all_have_trajectories_) continue;
    const double t = remaining_s(now), speed = bodies[static_cast<std::size_t>(i)].velocity_m_s.norm();
    SweptSphere& trajectory = departed_trajectories_[static_cast<std::size_t>(i)] =
        swept(static_cast<std::size_t>(i), bodies[static_cast<std::size_t>(i)], t);
    trajectory.pad_m = acceleration_offset_m(limits_.gravity_m_s2, t) + 2 * speed * t + limits_.tolerance_m;
    departed_.push_back(i);
    is_departed_[static_cast<std::size_t>(i)] = 1;
  }
  if (rule_ == GroupingRule::kKim2005) {
    close_kim2005(bodies, tools);
  } else {
    close_group(now, bodies, tools);
    enter_requested(now, bodies);
    for (const int i : haptic_) last_reached_[static_cast<std::size_t>(i)] = now;
    for (const int i : before_)
      if (now - last_reached_[static_cast<std::size_t>(i)] < limits_.leave_after)
        add_to_group(i, {}, now, bodies);
    close_group(now, bodies, tools);
    update_leaving(now, bodies);
    close_group(now, bodies, tools);
  }
  std::sort(haptic_.begin(), haptic_.end());
  entered_.clear();
  left_.clear();
  std::set_difference(haptic_.begin(), haptic_.end(), before_.begin(), before_.end(),
                      std::back_inserter(entered_));
  std::set_difference(before_.begin(), before_.end(), haptic_.begin(), haptic_.end(), std::back_inserter(left_));
}

bool Grouping::pad_exceeded(sync::SimTime now, std::span<const BodyMotion> bodies,
                       std::span<const GroupTool> tools) const {
  const double t = sync::to_seconds(now - watched_from_);
  const auto off = [&](const SweptSphere& trajectory, const Eigen::Vector3d& centre) {
    return (trajectory.centre_m + trajectory.velocity_m_s * t - centre).squaredNorm() > trajectory.pad_m * trajectory.pad_m;
  };
  for (std::size_t i = 0; i < tools.size(); ++i)
    if (off(tools_[i], tools[i].centre_m)) return true;
  return std::any_of(haptic_.begin(), haptic_.end(), [&](int i) {
    return off(inside_[static_cast<std::size_t>(i)], bodies[static_cast<std::size_t>(i)].centre_m);
  });
}

void Grouping::check_pads(sync::SimTime now, std::span<const BodyMotion> bodies,
                          std::span<const GroupTool> tools) {
  entered_.clear();
  left_.clear();
  const bool requested = !requested_.empty();
  if (!requested && (rule_ == GroupingRule::kKim2005 || !pad_exceeded(now, bodies, tools))) return;
  if (!requested) ++pad_violations_;
  before_ = haptic_;
  enter_requested(now, bodies);
  close_group(now, bodies, tools);
  record_entered(now);
}

}  // namespace tactus::sim
