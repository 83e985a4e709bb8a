// Serializes the state of grouping. The trajectories of the step belong to the caller: pass them again by resume().

#include "sim_node/dual/grouping.h"
#include "sim_node/dual/state_limits.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kMaxTools = 64;

void archive(StateArchive& a, SweptSphere& s) { a(s.centre_m), a(s.velocity_m_s), a(s.radius_m), a(s.pad_m); }

void archive(StateArchive& a, sync::Nanoseconds& t) {
  std::int64_t ns = t.count();
  a(ns);
  a.require(ns >= 0 && ns <= 1'000'000'000, "the state holds a time out of range");
  t = sync::Nanoseconds(ns);
}

}  // namespace

void Grouping::archive(StateArchive& a) {
  const std::size_t n = bodies_.size();
  const auto body = [&](int& i) {
    a.index(i, n);
    a.require(i >= 0, "the state names a body that does not exist");
  };
  sim::archive(a, limits_.horizon);
  sim::archive(a, limits_.leave_after);
  a(step_began_), a(watched_from_), a(held_), a(held_after_s_), a(pad_violations_);
  if (a.reads()) {
    for (const int i : haptic_) member_[static_cast<std::size_t>(i)] = 0;
    for (const int i : departed_) is_departed_[static_cast<std::size_t>(i)] = 0;
  }
  for (auto* list : {&haptic_, &departed_, &requested_}) a.list(*list, n, body);
  a.list(touching_, kMaxStoredPairs, [&](std::pair<int, int>& pair) { body(pair.first), body(pair.second); });
  for (const int i : haptic_) {
    const auto k = static_cast<std::size_t>(i);
    member_[k] = 1;
    sim::archive(a, inside_[k]);
    a(impact_bounds_[k].speed_m_s), a(impact_bounds_[k].remaining_s);
  }
  for (const int i : departed_) {
    const auto k = static_cast<std::size_t>(i);
    is_departed_[k] = 1;
    sim::archive(a, departed_trajectories_[k]);
  }
  a.list(tools_, kMaxTools, [&](SweptSphere& s) { sim::archive(a, s); });
  a.fixed(last_reached_, [&](sync::SimTime& t) { a(t); });
  if (a.reads()) {
    entered_.clear();
    left_.clear();
  }
}

}  // namespace tactus::sim
