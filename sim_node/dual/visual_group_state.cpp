// The state of the visual group as bytes.
#include "sim_node/dual/state_limits.h"
#include "sim_node/dual/visual_group.h"
#include "sim_node/model/archive_motion.h"

namespace tactus::sim {
void VisualGroup::archive(StateArchive& a) {
  world_->archive(a);
  ids_.archive(a);
  tracker_.archive(a, motions_.size());
  a.list(sleeping_contacts_, kMaxStoredContacts, [&](LiveContact& c) { tracker_.archive(a, c, motions_.size()); });
  sleeping_.archive(a);
  a(now_);
  a.list(units_, static_cast<std::size_t>(world_->units()), [&](int& unit) {
    a.index(unit, static_cast<std::size_t>(world_->units()));
    a.require(unit >= 0, "the state names a body that does not exist");
  });
  a.require(std::is_sorted(units_.begin(), units_.end()), "the state holds an unsorted list");
  a.fixed(motions_, [&](BodyMotion& m) { sim::archive(a, m); });
  a.list(contacts_, kMaxStoredContacts, [&](Manifold& m) { sim::archive(a, m, motions_.size(), finder_.shapes()); });
  bool found = found_;
  a(found), a(found_for_s_), a(before_s_);
  if (!a.reads()) return;
  contact_motions_ = motions_;
  activate();
  found_ = found;
}

void VisualGroup::rename(std::int64_t incarnation) {
  ids_.rename(incarnation);
  tracker_.rename();
  for (LiveContact& c : sleeping_contacts_) c.id = ids_.renamed(c.id);
}

}  // namespace tactus::sim
