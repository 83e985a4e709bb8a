#include "haptic_node/contact/contact_impulses.h"

#include <algorithm>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {

ContactImpulses::Entry& ContactImpulses::entry(std::int64_t contact_id, sync::HostTime now) {
  const auto known = std::ranges::find_if(contacts_, [&](const Entry& e) { return e.force.contact_id == contact_id; });
  if (known != contacts_.end()) return *known;
  if (contacts_.size() >= kMaxContacts)
    contacts_.erase(std::ranges::min_element(contacts_, [](const Entry& a, const Entry& b) { return a.last < b.last; }));
  Entry& e = contacts_.emplace_back();
  e.first = e.last = e.since = now;
  return e;
}

void ContactImpulses::step(sync::HostTime now, double dt, std::span<const ContactForce> forces) {
  for (Entry& e : contacts_) {
    e.impulse_N_s += dt * e.force.force_N;
    e.force.force_N.setZero();
  }
  for (const ContactForce& f : forces) {
    if (f.force_N.isZero(0)) continue;
    Entry& e = entry(f.contact_id, now);
    if (now - e.last > kPublishAfter) e.first = now;  // a new first force
    e.force = f;
    e.last = now;
  }
}

std::optional<sync::HostTime> ContactImpulses::first_force_time(std::int64_t contact_id) const {
  for (const Entry& e : contacts_)
    if (e.force.contact_id == contact_id) return e.first;
  return std::nullopt;
}

void ContactImpulses::write_constraints(sync::HostTime now, std::vector<tool_constraint_t>& out) const {
  out.clear();
  const auto add = [&](bool acting) {
    for (const Entry& e : contacts_) {
      if ((e.last == now) != acting || now - e.last > kPublishAfter || out.size() >= kMaxPublished) continue;
      tool_constraint_t c{};
      c.contact_id = e.force.contact_id;
      c.body = e.force.body;
      c.point_m = to_vec3(e.force.point);
      c.force_N = to_vec3f(e.force.force_N);
      c.impulse_N_s = to_vec3(e.impulse_N_s);
      c.impulse_since_ns = sync::to_ns(e.since);
      out.push_back(c);
    }
  };
  add(true);
  add(false);
}

}  // namespace tactus::haptic
