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
  late_ways_.resize(n);
  is_late_.resize(n);
  inside_.resize(n);
  kicks_.resize(n);
  member_.resize(n);
  wanted_at_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (bodies_[i].inverse_mass_1_kg > 0) movers_.push_back(static_cast<int>(i));
    const int system = bodies_[i].system;
    if (system < 0) continue;
    systems_.resize(std::max(systems_.size(), static_cast<std::size_t>(system) + 1));
    systems_[static_cast<std::size_t>(system)].push_back(static_cast<int>(i));
  }
}

double Grouping::left_s(sync::SimTime now) const {
  return std::max(0.0, sync::to_seconds(step_began_ + limits_.horizon - now));
}

namespace {
// What an acceleration does in n ticks to a body that is moved once a tick: h^2 n (n + 1) / 2.
double bend_m(double acceleration, double t_s) { return acceleration * t_s * (t_s + kTick_s) / 2; }
}  // namespace

// Its weight bends its way; what strikes or pushes it turns it aside.
SweptSphere Grouping::swept(std::size_t i, const BodyMotion& m, double t) const {
  return {m.centre_m, m.velocity_m_s, bodies_[i].radius_m,
          bend_m(limits_.gravity_m_s2, t) +
              kicks_[i].speed_m_s * std::clamp(kicks_[i].left_s + kTick_s, 0.0, t + kTick_s)};
}

SweptSphere Grouping::swept(const GroupTool& tool, double t) const {
  return {tool.centre_m, tool.velocity_m_s, tool.radius_m, bend_m(limits_.tool_acceleration_m_s2, t)};
}

// An impact changes the velocity by (1 + e) of that at which they meet (Newton's law, of a tool as heavy as can
// be), no more than its limited force can. Impacts of what was struck in turn are left to the watch: to pad them
// too makes the group ten times as large and saves not half of the alarms (grouping_table at 30 m/s^2, both ways).
double Grouping::kick_m_s(const SweptSphere& tool, std::size_t body, double t) const {
  const double meeting =
      (tool.velocity_m_s - way_of(static_cast<int>(body)).velocity_m_s).norm() + (t > 0 ? tool.pad_m / t : 0);
  return std::min((1 + limits_.restitution) * meeting, limits_.tool_force_N * bodies_[body].inverse_mass_1_kg * t);
}

void Grouping::enter(int index, Kick kick, sync::SimTime now, std::span<const BodyMotion> bodies) {
  const auto i = static_cast<std::size_t>(index);
  if (member_[i] || bodies_[i].inverse_mass_1_kg <= 0) return;
  member_[i] = 1;
  kicks_[i] = kick;
  inside_[i] = swept(i, bodies[i], left_s(now));
  // Who comes from outside is where its way has led it by now.
  if (!all_have_ways_ && !is_late_[i]) {
    const SweptSphere& way = ways_->of(index);
    inside_[i].centre_m =
        way.centre_m + way.velocity_m_s * (held_ ? held_after_s_ : sync::to_seconds(now - step_began_));
    inside_[i].velocity_m_s = way.velocity_m_s;
    inside_[i].pad_m += 2 * way.pad_m;
  }
  haptic_.push_back(index);
}

// Into found_. Bounds of the late ones are not kept: there are few.
void Grouping::find_outside(const Bounds& query) {
  found_.clear();
  ways_->find(query, found_);
  // Who was in the group has no way, whatever was computed before it came into it.
  std::erase_if(found_, [&](int j) { return is_late_[static_cast<std::size_t>(j)] != 0; });
  found_.insert(found_.end(), late_.begin(), late_.end());
}

void Grouping::reach(const SweptSphere& from, double inverse_mass, sync::SimTime now,
                     std::span<const BodyMotion> bodies) {
  const double t = left_s(now), passed = sync::to_seconds(now - step_began_);
  find_outside(bounds_of(from, t));
  for (const int j : found_) {
    const auto body = static_cast<std::size_t>(j);
    if (member_[body]) continue;
    SweptSphere other = way_of(j);
    other.centre_m += other.velocity_m_s * (held_ ? held_after_s_ : passed);
    if (held_) other.velocity_m_s.setZero();
    const double meeting =
        first_meeting_s(from, other, from.radius_m + other.radius_m + from.pad_m + other.pad_m, t);
    if (meeting < 0) continue;
    const bool struck_by_tool = inverse_mass <= 0;
    enter(j, struck_by_tool ? Kick{kick_m_s(from, body, t), t - meeting} : Kick{}, now, bodies);
  }
}

void Grouping::close(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const GroupTool> tools) {
  watched_from_ = now;
  const double t = left_s(now);
  tools_.clear();
  for (const GroupTool& tool : tools) tools_.push_back(swept(tool, t));
  for (const int i : haptic_)
    inside_[static_cast<std::size_t>(i)] =
        swept(static_cast<std::size_t>(i), bodies[static_cast<std::size_t>(i)], t);
  for (const SweptSphere& tool : tools_) reach(tool, 0, now, bodies);
  // The list grows while it is gone through.
  for (std::size_t k = 0; k < haptic_.size(); ++k) {
    const auto i = static_cast<std::size_t>(haptic_[k]);
    const Kick kick = kicks_[i];
    if (bodies_[i].system >= 0)
      for (const int j : systems_[static_cast<std::size_t>(bodies_[i].system)]) enter(j, kick, now, bodies);
    for (const int j : ways_->beside(haptic_[k])) enter(j, kick, now, bodies);
    for (auto pair = std::lower_bound(touching_.begin(), touching_.end(), std::pair(haptic_[k], -1));
         pair != touching_.end() && pair->first == haptic_[k]; ++pair)
      enter(pair->second, kick, now, bodies);
    reach(inside_[i], bodies_[i].inverse_mass_1_kg, now, bodies);
  }
}

void Grouping::close_as_kim(std::span<const BodyMotion> bodies, std::span<const GroupTool> tools) {
  const double t = left_s(step_began_);
  for (const GroupTool& tool : tools)
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const SweptSphere from{tool.centre_m, tool.velocity_m_s, tool.radius_m, 0};
      const SweptSphere body{bodies[i].centre_m, bodies[i].velocity_m_s, bodies_[i].radius_m, 0};
      if (closest_axes_m(from, body, t) <= from.radius_m + body.radius_m)
        enter(static_cast<int>(i), {}, step_began_, bodies);
    }
}

// Of a body that would leave: whether it may meet something in this step that does not leave with it.
bool Grouping::reaches_what_stays(int body, sync::SimTime now) {
  const double t = left_s(now);
  const SweptSphere& from = way_of(body);
  find_outside(bounds_of(from, t));
  return std::any_of(found_.begin(), found_.end(), [&](int j) {
    if (leaves_[static_cast<std::size_t>(j)]) return false;
    const SweptSphere& other = way_of(j);
    return first_meeting_s(from, other, from.radius_m + other.radius_m + from.pad_m + other.pad_m, t) >= 0;
  });
}

// What nothing wants any more leaves by itself, or stays with all that it may meet.
void Grouping::stay_or_leave(sync::SimTime now, std::span<const BodyMotion> bodies) {
  leaves_.resize(bodies_.size());
  for (const int i : before_) leaves_[static_cast<std::size_t>(i)] = !member_[static_cast<std::size_t>(i)];
  for (bool changed = true; changed;) {
    changed = false;
    for (const int i : before_) {
      if (!leaves_[static_cast<std::size_t>(i)] || !reaches_what_stays(i, now)) continue;
      leaves_[static_cast<std::size_t>(i)] = 0;
      enter(i, {}, now, bodies);
      changed = true;
    }
  }
  for (const int i : before_) leaves_[static_cast<std::size_t>(i)] = 0;
}

void Grouping::note(std::span<const std::pair<int, int>> touching) {
  touching_.clear();
  for (const auto& [a, b] : touching) {
    touching_.emplace_back(a, b);
    touching_.emplace_back(b, a);
  }
  std::sort(touching_.begin(), touching_.end());
}

// Who has come in a call in which nobody leaves.
void Grouping::tell(sync::SimTime now) {
  std::sort(haptic_.begin(), haptic_.end());
  entered_.clear();
  left_.clear();
  std::set_difference(haptic_.begin(), haptic_.end(), before_.begin(), before_.end(),
                      std::back_inserter(entered_));
  for (const int i : entered_) wanted_at_[static_cast<std::size_t>(i)] = now;
}

void Grouping::hold_step(sync::SimTime now, std::span<const BodyMotion> bodies,
                         std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools) {
  if (!held_) held_after_s_ = sync::to_seconds(now - step_began_);
  held_ = true;
  step_began_ = now;
  note(touching);
  before_ = haptic_;
  close(now, bodies, tools);
  enter_asked(now, bodies);
  close(now, bodies, tools);
  tell(now);
}

void Grouping::enter_asked(sync::SimTime now, std::span<const BodyMotion> bodies) {
  for (const int body : asked_) {
    enter(body, {}, now, bodies);
    wanted_at_[static_cast<std::size_t>(body)] = now;
  }
  asked_.clear();
}

void Grouping::begin_step(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const double> strays_m,
                          std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools) {
  straight_.clear();
  for (const int i : movers_) {
    const auto k = static_cast<std::size_t>(i);
    straight_.push_back(
        {bodies[k].centre_m, bodies[k].velocity_m_s, bodies_[k].radius_m, strays_m[k] + limits_.tolerance_m});
  }
  own_ways_.set(bodies.size(), movers_, straight_, touching, sync::to_seconds(limits_.horizon));
  begin(now, own_ways_, true, bodies, {}, tools, true);
}

void Grouping::begin_step(sync::SimTime now, const SweptTrajectories& ways, std::span<const BodyMotion> bodies,
                          std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools,
                          bool may_leave) {
  begin(now, ways, false, bodies, touching, tools, may_leave);
}

void Grouping::begin(sync::SimTime now, const SweptTrajectories& ways, bool of_all, std::span<const BodyMotion> bodies,
                     std::span<const std::pair<int, int>> touching, std::span<const GroupTool> tools,
                     bool may_leave) {
  step_began_ = now;
  all_have_ways_ = of_all;
  ways_ = &ways;
  held_ = false;
  for (const int i : late_) is_late_[static_cast<std::size_t>(i)] = 0;
  late_.clear();
  note(touching);
  std::swap(before_, haptic_);
  haptic_.clear();
  for (const int i : before_) {
    member_[static_cast<std::size_t>(i)] = 0;
    // Until it is known whether it stays, and should it leave, it is where nobody has computed it: on its way it
    // may fall, and turn round.
    if (all_have_ways_) continue;
    const double t = left_s(now), speed = bodies[static_cast<std::size_t>(i)].velocity_m_s.norm();
    SweptSphere& way = late_ways_[static_cast<std::size_t>(i)] =
        swept(static_cast<std::size_t>(i), bodies[static_cast<std::size_t>(i)], t);
    way.pad_m = bend_m(limits_.gravity_m_s2, t) + 2 * speed * t + limits_.tolerance_m;
    late_.push_back(i);
    is_late_[static_cast<std::size_t>(i)] = 1;
  }
  if (rule_ == GroupingRule::kKim2005) {
    close_as_kim(bodies, tools);
  } else {
    close(now, bodies, tools);
    enter_asked(now, bodies);
    for (const int i : haptic_) wanted_at_[static_cast<std::size_t>(i)] = now;
    for (const int i : before_)
      if (!may_leave || now - wanted_at_[static_cast<std::size_t>(i)] < limits_.leave_after)
        enter(i, {}, now, bodies);
    close(now, bodies, tools);
    stay_or_leave(now, bodies);
    close(now, bodies, tools);
  }
  std::sort(haptic_.begin(), haptic_.end());
  entered_.clear();
  left_.clear();
  std::set_difference(haptic_.begin(), haptic_.end(), before_.begin(), before_.end(),
                      std::back_inserter(entered_));
  std::set_difference(before_.begin(), before_.end(), haptic_.begin(), haptic_.end(), std::back_inserter(left_));
}

bool Grouping::strayed(sync::SimTime now, std::span<const BodyMotion> bodies,
                       std::span<const GroupTool> tools) const {
  const double t = sync::to_seconds(now - watched_from_);
  const auto off = [&](const SweptSphere& way, const Eigen::Vector3d& centre) {
    return (way.centre_m + way.velocity_m_s * t - centre).squaredNorm() > way.pad_m * way.pad_m;
  };
  for (std::size_t i = 0; i < tools.size(); ++i)
    if (off(tools_[i], tools[i].centre_m)) return true;
  return std::any_of(haptic_.begin(), haptic_.end(), [&](int i) {
    return off(inside_[static_cast<std::size_t>(i)], bodies[static_cast<std::size_t>(i)].centre_m);
  });
}

void Grouping::watch(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const GroupTool> tools) {
  entered_.clear();
  left_.clear();
  const bool wanted = !asked_.empty();
  if (!wanted && (rule_ == GroupingRule::kKim2005 || !strayed(now, bodies, tools))) return;
  if (!wanted) ++alarms_;
  before_ = haptic_;
  enter_asked(now, bodies);
  close(now, bodies, tools);
  tell(now);
}

}  // namespace tactus::sim
