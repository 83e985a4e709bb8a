#include "sim_node/behaviour/single_group.h"

#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>

#include "sim_node/model/archive_motion.h"

namespace tactus::sim {

SingleGroup::SingleGroup(const WorldDef& world, const Settings& settings, Ids& ids)
    : step_(sync::from_seconds(settings.step_s)),
      solver_(world, settings),
      tracker_(surface_traits(world, settings), settings, ids),
      motions_(solver_.bodies().begin(), solver_.bodies().end()) {}

// The caller sets the poses of tools.
void SingleGroup::read() {
  for (std::size_t i = 0; i < motions_.size(); ++i)
    if (solver_.bodies()[i].moves()) motions_[i] = solver_.bodies()[i];
}

void SingleGroup::detect_contacts(sync::SimTime now, std::vector<contact_event_t>& events) {
  read();
  tracker_.update(now, step_, motions_, solver_.contacts(), solver_.solved(), events);
}

void SingleGroup::start(std::span<const GroupTool>, std::vector<contact_event_t>& events) { detect_contacts({}, events); }

void SingleGroup::tick(sync::SimTime now, std::span<const GroupTool>, std::vector<contact_event_t>& events) {
  solver_.step();
  detect_contacts(now + step_, events);
}

void SingleGroup::contacts(std::vector<contact_t>& out) {
  out.clear();
  for (const LiveContact& c : tracker_.live()) tracker_.describe(c, motions_, out.emplace_back());
}

void SingleGroup::archive(StateArchive& a) {
  solver_.archive(a);
  tracker_.archive(a, motions_.size());
  a.fixed(motions_, [&](BodyMotion& m) { sim::archive(a, m); });
}

}  // namespace tactus::sim
