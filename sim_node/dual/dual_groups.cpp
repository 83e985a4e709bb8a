#include "sim_node/dual/dual_groups.h"

#include <algorithm>
#include <stdexcept>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>

#include "sim_node/behaviour/behaviour_checks.h"
#include "sim_node/dual/group_bodies.h"
#include "sim_node/model/index.h"

namespace tactus::sim {
namespace {

GroupingLimits limits_of(const WorldDef& def, const Settings& s) {
  GroupingLimits l;
  l.horizon = sync::from_seconds(1 / s.visual_rate_Hz + s.tool_jitter_s);
  l.leave_after = 2 * l.horizon;
  l.tool_force_N = s.tool_force_limit_N;
  l.gravity_m_s2 = def.gravity_m_s2.norm();
  return l;
}

const Settings& accepted(const WorldDef& def, const Settings& s) {
  if (const std::string why = unsupported_reason(def, s); !why.empty()) throw std::runtime_error(why);
  return s;
}

}  // namespace

DualGroups::DualGroups(const WorldDef& def, const Settings& settings, Ids& ids,
                       const std::shared_ptr<MeshTrees>& trees)
    : settings_(accepted(def, settings)),
      world_(impulse::build_world(def, for_haptic_group(settings))),
      source_(def, settings, trees),
      stepper_(extents_of(def)),
      scene_(def, *world_),
      ids_(ids),
      tracker_(surface_traits(def, settings), settings, ids),
      catching_up_(surface_traits(def, settings), settings, ids),
      grouping_(group_bodies(def, *world_, *trees), limits_of(def, settings),
                settings.grouping == "kim2005" ? GroupingRule::kKim2005 : GroupingRule::kSound),
      visual_(std::make_unique<VisualGroup>(def, settings, body_radii(def, *trees), Ids(ids.incarnation(), 1, 2),
                                            trees)),
      rate_(settings.visual_rate_Hz, sync::from_seconds(settings.step_s)),
      motions_(source_.frames().at_start(def)),
      mask_(def.bodies.size()) {
  activate();
}

void DualGroups::start(std::span<const GroupTool> tools, std::vector<contact_event_t>& events) {
  // At the first instant the step is computed synchronously, so it cannot be late.
  visual_.group().restart(ids_.incarnation());
  task_ = {};
  task_.length = rate_.next();
  visual_.request(task_);
  visual_.poll(step_);
  begin_step(sync::SimTime{}, tools, events);
  publish_due_events(sync::SimTime{}, events);
  if (settings_.visual_thread == "own") visual_.start();
}

void DualGroups::apply_load(const Load& load) {
  if (world_->unit_of(load.body) < 0) return;
  if (!is_haptic(load.body)) grouping_.request_entry(load.body);
  loads_.push_back(load);
}

void DualGroups::add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m) {
  apply_load({body, force_N, point_m, Eigen::Vector3d::Zero(), false});
}

void DualGroups::add_wrench(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& torque_N_m) {
  apply_load({body, force_N, Eigen::Vector3d::Zero(), torque_N_m, true});
}

void DualGroups::gather_units(std::span<const int> bodies) {
  units_.clear();
  for (const int body : bodies) units_.push_back(world_->unit_of(body));
  std::sort(units_.begin(), units_.end());
  units_.erase(std::unique(units_.begin(), units_.end()), units_.end());
}

void DualGroups::activate() {
  gather_units(grouping_.haptic());
  world_->set_active(units_);
  stale_ = true;
}

void DualGroups::read_motions(std::span<const int> bodies) {
  for (const int body : bodies)
    motions_[index(body)] = source_.frames().motion(body, world_->motions()[index(body)]);
}

void DualGroups::find_contacts(double h_s) {
  source_.find(world_->motions(), world_->active_bodies(), stepper_.horizon_s(*world_, h_s), contacts_);
}

// Records the pairs of moving bodies of the haptic group that touch.
void DualGroups::record_touching() {
  touching_.clear();
  for (const LiveContact& c : tracker_.live())
    if (motions_[index(c.manifold.body_a)].moves() && motions_[index(c.manifold.body_b)].moves())
      touching_.emplace_back(c.manifold.body_a, c.manifold.body_b);
}

// Appends the events of the visual group up to `until`. Skips the events of bodies that have entered the haptic group
// since.
void DualGroups::publish_due_events(sync::SimTime until, std::vector<contact_event_t>& events) {
  if (!step_) return;
  for (; published_events_ < step_->events.size(); ++published_events_) {
    contact_event_t e = step_->events[published_events_];
    e.time_ns += clock_offset_.count();
    if (sync::sim_time(e.time_ns) > until) break;
    const auto gone = [&](int body) { return motions_[index(body)].moves() && is_haptic(body); };
    if (!gone(e.body_a) && !gone(e.body_b)) events.push_back(e);
  }
}

void DualGroups::tick(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events) {
  const sync::Nanoseconds h = sync::from_seconds(settings_.step_s);
  began_ = false;
  promoted_.clear();
  released_.clear();
  if (now >= ends_) {
    if (visual_.poll(step_))
      begin_step(now, tools, events);
    else
      hold(now, tools, events);
  } else {
    grouping_.check_pads(now, motions_, tools);
    promote(now, events);
  }
  apply_queued_changes();
  const auto active = world_->active_bodies();
  if (stale_) find_contacts(settings_.step_s);
  stale_ = false;
  for (const Load& load : loads_) {
    const Eigen::Vector3d centre = world_->motions()[index(load.body)].centre_m;
    world_->add_force(load.body, load.force_N, load.at_centre ? centre : load.point_m);
    world_->add_torque(load.body, load.torque_N_m);
  }
  loads_.clear();
  stepper_.step(*world_, source_, settings_.step_s, contacts_, solved_);
  source_.frames().place_impacts(solved_);
  read_motions(active);
  tracker_.update(now + h, h, motions_, contacts_, solved_, events);
  publish_due_events(now + h, events);
}

void DualGroups::begin_step(sync::SimTime now, std::span<const GroupTool> tools,
                            std::vector<contact_event_t>& events) {
  began_ = true;
  holding_ = false;
  begins_ = now;
  ends_ = now + step_->task.length;
  clock_offset_ = now - step_->begins;
  published_events_ = 0;
  // Every body outside the haptic group takes the state at the beginning of the step.
  list_.assign(world_->active_bodies().begin(), world_->active_bodies().end());
  std::swap(motions_, step_->begin);
  read_motions(list_);
  record_touching();
  grouping_.set_horizon(step_->task.length + sync::from_seconds(settings_.tool_jitter_s));
  grouping_.begin_step(now, step_->trajectories, motions_, touching_, tools);
  departed_.clear();
  promote(now, events);
  release();
  request_next_step();
}

void DualGroups::request_next_step() {
  task_.number = ++number_;
  task_.catch_up_time = step_->task.length;
  task_.length = rate_.next();
  task_.entering = departed_;
  for (LiveContact& c : task_.entering.contacts) shift(c, -clock_offset_);
  // Units of the step just received that were promoted while the next step was being computed.
  task_.leaving.clear();
  const auto haptic = world_->active_units();
  for (const int unit : step_->units)
    if (std::binary_search(haptic.begin(), haptic.end(), unit) || departed_.find(unit) >= 0)
      task_.leaving.push_back(unit);
  task_.changes = changes_;
  changes_.clear();
  visual_.request(task_);
}

void DualGroups::hold(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events) {
  ++held_ticks_;
  if (!holding_) {
    holding_ = true;
    ++late_steps_;
    held_until_ = now;
    list_.assign(world_->active_bodies().begin(), world_->active_bodies().end());
    std::swap(motions_, step_->end);
    read_motions(list_);
  }
  if (now >= held_until_) {
    held_until_ = now + step_->task.length;
    record_touching();
    grouping_.hold_step(now, motions_, touching_, tools);
  } else {
    grouping_.check_pads(now, motions_, tools);
  }
  promote(now, events);
}

// Units that have just left are reported here until the visual group has computed their trajectory.
void DualGroups::contacts(std::vector<contact_t>& out) {
  out.clear();
  for (const LiveContact& c : tracker_.live()) tracker_.describe(c, motions_, out.emplace_back());
  for (const LiveContact& c : departed_.contacts) tracker_.describe(c, motions_, out.emplace_back());
}

const LookAhead* DualGroups::look_ahead() {
  look_ahead_.fresh = began_;
  look_ahead_.held = holding_;
  look_ahead_.promoted = promoted_;
  if (began_ || !promoted_.empty()) {
    look_ahead_.begins = begins_;
    look_ahead_.time = ends_;
    look_ahead_waiting_.clear();
    for (const int unit : departed_.units) world_->unit_bodies(unit, look_ahead_waiting_);
    std::erase_if(look_ahead_waiting_, [this](int body) { return is_haptic(body); });
    std::sort(look_ahead_waiting_.begin(), look_ahead_waiting_.end());
    look_ahead_.waiting = look_ahead_waiting_;
    look_ahead_bodies_.clear();
    look_ahead_motions_.clear();
    for (const int body : step_->bodies) {
      if (is_haptic(body) || departed_.find(world_->unit_of(body)) >= 0) continue;
      look_ahead_bodies_.push_back(body);
      look_ahead_motions_.push_back(holding_ ? motions_[index(body)] : step_->end[index(body)]);
    }
    look_ahead_.bodies = look_ahead_bodies_;
    look_ahead_.motions = look_ahead_motions_;
    look_ahead_.contacts = [this](std::vector<contact_t>& out) {
      out.clear();
      const auto gone = [this](int body) { return motions_[index(body)].moves() && is_haptic(body); };
      for (const LiveContact& c : step_->live.back())
        if (!gone(c.manifold.body_a) && !gone(c.manifold.body_b))
          tracker_.describe(c, step_->end, out.emplace_back());
    };
  }
  return &look_ahead_;
}

}  // namespace tactus::sim
