// Moves bodies between the haptic and the visual group.
#include <algorithm>
#include <tactus/contact_event_t.hpp>

#include "sim_node/dual/dual_groups.h"
#include "sim_node/model/index.h"

namespace tactus::sim {
void DualGroups::mark(std::span<const int> units, char value) {
  list_.clear();
  for (const int unit : units) world_->unit_bodies(unit, list_);
  for (const int body : list_) mask_[index(body)] = value;
}

// Moves units that have left the haptic group, with their states and contacts, to departed_.
void DualGroups::release() {
  released_.assign(grouping_.left().begin(), grouping_.left().end());
  if (released_.empty()) return;
  gather_units(released_);
  departed_.units = units_;
  departed_.states.resize(units_.size());
  for (std::size_t i = 0; i < units_.size(); ++i) world_->copy_state(units_[i], departed_.states[i]);
  mark(departed_.units, 1);
  tracker_.extract(mask_, departed_.contacts);
  mark(departed_.units, 0);
  activate();
}

// Advances the units from a past instant to the present, in steps no longer than a tick; all other bodies stand
// still.
void DualGroups::catch_up(std::span<const int> units, sync::SimTime from, sync::SimTime to,
                          std::vector<contact_event_t>& events) {
  catching_up_.insert(moved_);
  world_->set_active(units);
  read_motions(world_->active_bodies());
  const sync::Nanoseconds tick = sync::from_seconds(settings_.step_s);
  const std::int64_t steps = (to - from + tick - sync::Nanoseconds(1)) / tick;
  discarded_events_.clear();
  for (std::int64_t k = 0; k < steps; ++k) {
    const sync::Nanoseconds h = (to - from) * (k + 1) / steps - (to - from) * k / steps;
    find_contacts(sync::to_seconds(h));
    stepper_.step(*world_, source_, sync::to_seconds(h), contacts_, solved_);
    source_.frames().place_impacts(solved_);
    read_motions(world_->active_bodies());
    catching_up_.update(from + (to - from) * (k + 1) / steps, h, motions_, contacts_, solved_, discarded_events_);
  }
  mark(units, 1);
  moved_.clear();
  catching_up_.extract(mask_, moved_);
  if (steps > 0) reconcile(from, to, events);
  mark(units, 0);
  tracker_.insert(moved_);
}

// Until now the visual group published the events of these contacts for the last few ticks. Where they differ from
// the result of catch_up(), this function publishes the correction.
void DualGroups::reconcile(sync::SimTime from, sync::SimTime to, std::vector<contact_event_t>& events) {
  const auto involved = [&](int a, int b) { return mask_[index(a)] || mask_[index(b)]; };
  for (std::size_t i = 0; i < published_events_ && i < step_->events.size(); ++i) {
    const contact_event_t& e = step_->events[i];
    if (sync::sim_time(e.time_ns) + clock_offset_ <= from || !involved(e.body_a, e.body_b)) continue;
    if (e.kind == contact_event_t::BEGIN) open_.push_back({e.contact_id, e.body_a, e.body_b, false});
    if (e.kind == contact_event_t::END)
      std::erase_if(open_, [&](const OpenContact& t) { return t.contact == e.contact_id; });
  }
  for (LiveContact& c : moved_) {
    const auto same = std::find_if(open_.begin(), open_.end(), [&](const OpenContact& t) { return t.contact == c.id; });
    if (same != open_.end()) {
      same->matched = true;
      continue;
    }
    const auto similar = std::find_if(open_.begin(), open_.end(), [&](const OpenContact& t) {
      return !t.matched && t.body_a == c.manifold.body_a && t.body_b == c.manifold.body_b;
    });
    if (similar != open_.end()) {
      c.id = similar->contact;
      similar->matched = true;
    } else {
      c.id = ids_.next_id();
      tracker_.report(c, contact_event_t::BEGIN, to, motions_, events);
    }
  }
  for (const OpenContact& t : open_) {
    if (t.matched) continue;
    contact_event_t& e = events.emplace_back();
    e.event_id = ids_.next_id();
    e.contact_id = t.contact;
    e.kind = contact_event_t::END;
    e.time_ns = sync::to_ns(to);
    e.body_a = t.body_a, e.body_b = t.body_b;
    e.material_a = e.material_b = e.tool = -1;
  }
}

// Promotes the bodies that have entered the haptic group: from the trajectory of the visual step, or, for units that
// left when the step began, from their state at that instant.
void DualGroups::promote(sync::SimTime now, std::vector<contact_event_t>& events) {
  const auto entered = grouping_.entered();
  if (entered.empty()) return;
  promoted_.assign(entered.begin(), entered.end());
  gather_units(entered);
  from_late_.clear();
  from_step_.clear();
  for (const int unit : units_) (departed_.find(unit) >= 0 ? from_late_ : from_step_).push_back(unit);
  const sync::Nanoseconds passed = std::min(now - begins_, step_->task.length);
  const std::size_t k = step_->time_before(passed);
  const auto promote_units = [&](const std::vector<int>& units, sync::Nanoseconds at, const auto& state_of,
                             const std::vector<LiveContact>& contacts, sync::Nanoseconds ahead) {
    if (units.empty()) return;
    for (const int unit : units) world_->set_state(unit, state_of(unit));
    mark(units, 1);
    moved_.clear();
    open_.clear();
    for (const LiveContact& c : contacts)
      if (mask_[index(c.manifold.body_a)] || mask_[index(c.manifold.body_b)]) {
        moved_.push_back(c);
        shift(moved_.back(), ahead);
        open_.push_back({c.id, c.manifold.body_a, c.manifold.body_b, false});
      }
    mark(units, 0);
    catch_up(units, begins_ + at, begins_ + passed, events);
  };
  promote_units(from_late_, {}, [&](int unit) -> const auto& { return departed_.states[index(departed_.find(unit))]; },
            departed_.contacts, {});
  promote_units(
      from_step_, step_->times[k],
      [&](int unit) -> const auto& {
        const auto at = std::lower_bound(step_->units.begin(), step_->units.end(), unit);
        return step_->states[k][static_cast<std::size_t>(at - step_->units.begin())];
      },
      step_->live[k], clock_offset_);
  activate();
}

}  // namespace tactus::sim
