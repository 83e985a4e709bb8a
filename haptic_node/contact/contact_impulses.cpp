#include "haptic_node/contact/contact_impulses.h"

#include <algorithm>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {

ContactImpulses::Entry& ContactImpulses::entry(std::int64_t contact_id, sync::HostTime now) {
  const auto known = std::find_if(contacts_.begin(), contacts_.end(),
                                  [&](const Entry& e) { return e.felt.contact_id == contact_id; });
  if (known != contacts_.end()) return *known;
  if (contacts_.size() >= kMaxContacts)
    contacts_.erase(std::min_element(contacts_.begin(), contacts_.end(),
                                     [](const Entry& a, const Entry& b) { return a.last < b.last; }));
  Entry& e = contacts_.emplace_back();
  e.first = e.last = now;
  return e;
}

void ContactImpulses::step(sync::HostTime now, double dt, std::span<const FeltForce> forces) {
  for (Entry& e : contacts_) {
    e.impulse_N_s += dt * e.felt.force_N;
    e.felt.force_N.setZero();
  }
  for (const FeltForce& f : forces) {
    if (f.force_N.isZero(0)) continue;
    Entry& e = entry(f.contact_id, now);
    if (now - e.last > kToldAfter) e.first = now;  // a new first force
    e.felt = f;
    e.last = now;
  }
}

std::optional<sync::HostTime> ContactImpulses::first_felt(std::int64_t contact_id) const {
  for (const Entry& e : contacts_)
    if (e.felt.contact_id == contact_id) return e.first;
  return std::nullopt;
}

void ContactImpulses::tell(sync::HostTime now, std::vector<tool_constraint_t>& out) const {
  out.clear();
  const auto add = [&](bool acting) {
    for (const Entry& e : contacts_) {
      if ((e.last == now) != acting || now - e.last > kToldAfter || out.size() >= kMaxTold) continue;
      tool_constraint_t c{};
      c.contact_id = e.felt.contact_id;
      c.body = e.felt.body;
      c.point_m = to_vec3f(e.felt.point);
      c.force_N = to_vec3f(e.felt.force_N);
      c.impulse_N_s = to_vec3f(e.impulse_N_s);
      out.push_back(c);
    }
  };
  add(true);
  add(false);
}

}  // namespace tactus::haptic
