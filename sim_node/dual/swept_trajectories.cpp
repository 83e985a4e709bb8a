#include "sim_node/dual/swept_trajectories.h"

#include <algorithm>

#include "sim_node/dual/state_limits.h"

namespace tactus::sim {
void SweptTrajectories::set(std::size_t bodies, std::span<const int> members, std::span<const SweptSphere> trajectories,
               std::span<const std::pair<int, int>> touching, double horizon_s) {
  for (const int body : members_) at_[index(body)] = -1;
  at_.resize(bodies, -1);
  members_.assign(members.begin(), members.end());
  trajectories_.assign(trajectories.begin(), trajectories.end());
  boxes_.clear();
  for (std::size_t k = 0; k < members.size(); ++k) {
    at_[index(members[k])] = static_cast<int>(k);
    boxes_.push_back(bounds_of(trajectories_[k], horizon_s));
  }
  grid_.build(boxes_);
  horizon_s_ = horizon_s;
  first_.assign(bodies + 1, 0);
  for (const auto& [a, b] : touching) ++first_[index(a) + 1], ++first_[index(b) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  touched_.resize(2 * touching.size());
  next_.assign(first_.begin(), first_.end());
  for (const auto& [a, b] : touching) {
    touched_[index(next_[index(a)]++)] = b;
    touched_[index(next_[index(b)]++)] = a;
  }
}

void SweptTrajectories::archive(StateArchive& a, std::size_t bodies) {
  std::vector<int> members = members_;
  std::vector<SweptSphere> trajectories = trajectories_;
  std::vector<std::pair<int, int>> touching;
  for (int body = 0; index(body) + 1 < first_.size(); ++body)
    for (const int other : touched_by(body))
      if (body < other) touching.emplace_back(body, other);
  const auto body = [&](int& i) {
    a.index(i, bodies);
    a.require(i >= 0, "the state names a body that does not exist");
  };
  a.list(members, bodies, body);
  a.require(std::is_sorted(members.begin(), members.end()), "the state holds an unsorted list");
  a.list(trajectories, bodies, [&](SweptSphere& s) { a(s.centre_m), a(s.velocity_m_s), a(s.radius_m), a(s.pad_m); });
  a.require(trajectories.size() == members.size(), "the state holds a list that is too long");
  a.list(touching, kMaxStoredPairs, [&](std::pair<int, int>& pair) { body(pair.first), body(pair.second); });
  a(horizon_s_);
  if (a.reads()) set(bodies, members, trajectories, touching, horizon_s_);
}

void SweptTrajectories::find(const Bounds& query, std::vector<int>& found) const {
  const std::size_t begin = found.size();
  grid_.find(query, found);
  for (std::size_t k = begin; k < found.size(); ++k) found[k] = members_[index(found[k])];
}

std::span<const int> SweptTrajectories::touched_by(int body) const {
  if (index(body) + 1 >= first_.size()) return {};
  const auto from = first_[index(body)], to = first_[index(body) + 1];
  return std::span(touched_).subspan(index(from), index(to - from));
}

}  // namespace tactus::sim
