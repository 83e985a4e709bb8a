// Saves and restores the state of the whole simulation.
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "sim_node/world/simulation.h"
#include "sim_node/model/archive_motion.h"
#include "sim_node/model/envelope.h"
#include "sim_node/model/finite_motion.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kMaxEvents = 1 << 16;
constexpr std::int64_t kMaxSteps = 31'000'000'000;  // just under a year

}  // namespace

void Simulation::archive(StateArchive& a) {
  a(steps_);
  a.require(steps_ >= 0 && steps_ <= kMaxSteps, "the state holds a number out of range");
  ids_.archive(a);
  mechanics_->archive(a);
  const std::size_t bodies = mechanics_->motions().size();
  a.fixed(tools_, [&](Tool& tool) {
    tool.touch.archive(a);
    tool.push.archive(a, bodies);
    a(tool.orientation);
    if (a.reads()) tool.new_messages.clear();
  });
  a.list(events_, kMaxEvents, [&](contact_event_t& e) { a.message(e); });
  a.list(tool_contacts_, kMaxEvents, [&](contact_t& c) { a.message(c); });
  a.fixed(models_, [&](touch_model_t& m) { a.message(m); });
  a.list(wrenches_, kMaxWrenches, [&](Wrench& w) {
    a.index(w.body, bodies);
    a.require(w.body >= 0, "the state holds a force on no body");
    a(w.force_N), a(w.torque_N_m), a(w.steps);
    a.require(w.steps >= 0 && w.steps <= kMaxSteps, "the state holds a number out of range");
  });
  a(held_);
  held_motions_.resize(held_ ? bodies : 0);
  a.fixed(held_motions_, [&](BodyMotion& m) { sim::archive(a, m); });
  game_.archive(a, bodies);
}

// Waits for the step that is computed ahead, and so meets its failure.
std::vector<std::uint8_t> Simulation::save() try {
  StateArchive a;
  archive(a);
  return wrap_state(a.bytes(), fingerprint_);
} catch (const StateNotFinite& e) {
  stop_at(e.body, e.quantity);
}

std::string Simulation::restore(std::span<const std::uint8_t> bytes) {
  const std::vector<std::uint8_t> before = save();
  try {
    StateArchive a(unwrap_state(bytes, fingerprint_));
    archive(a);
    a.require(a.at_end(), "the state is longer than it should be");
    return "";
  } catch (const InvalidState& e) {
    StateArchive back(unwrap_state(before, fingerprint_));
    archive(back);
    return e.what();
  }
}

// Waits as save().
void Simulation::begin_incarnation(std::int64_t incarnation) try {
  ids_.rename(incarnation);
  mechanics_->rename(incarnation);
  for (contact_event_t& e : events_) {
    e.event_id = ids_.renamed(e.event_id);
    e.contact_id = ids_.renamed(e.contact_id);
  }
  for (contact_t& c : tool_contacts_) c.contact_id = ids_.renamed(c.contact_id);
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    tools_[i].touch.rename();
    tools_[i].push.reset();
    for (touch_plane_t& p : models_[i].planes) p.contact_id = ids_.renamed(p.contact_id);
    models_[i].applied.clear();
    models_[i].applied_count = 0;
  }
} catch (const StateNotFinite& e) {
  stop_at(e.body, e.quantity);
}

}  // namespace tactus::sim
