#include "sim_node/dual/ways.h"

namespace tactus::sim {

void Ways::set(std::size_t bodies, std::span<const int> members, std::span<const SweptSphere> ways,
               std::span<const std::pair<int, int>> touching, double horizon_s) {
  for (const int body : members_) at_[index(body)] = -1;
  at_.resize(bodies, -1);
  members_.assign(members.begin(), members.end());
  ways_.assign(ways.begin(), ways.end());
  boxes_.clear();
  for (std::size_t k = 0; k < members.size(); ++k) {
    at_[index(members[k])] = static_cast<int>(k);
    boxes_.push_back(bounds_of(ways_[k], horizon_s));
  }
  grid_.build(boxes_);
  first_.assign(bodies + 1, 0);
  for (const auto& [a, b] : touching) ++first_[index(a) + 1], ++first_[index(b) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  beside_.resize(2 * touching.size());
  next_.assign(first_.begin(), first_.end());
  for (const auto& [a, b] : touching) {
    beside_[index(next_[index(a)]++)] = b;
    beside_[index(next_[index(b)]++)] = a;
  }
}

void Ways::find(const Bounds& query, std::vector<int>& found) const {
  const std::size_t begin = found.size();
  grid_.find(query, found);
  for (std::size_t k = begin; k < found.size(); ++k) found[k] = members_[index(found[k])];
}

std::span<const int> Ways::beside(int body) const {
  if (index(body) + 1 >= first_.size()) return {};
  const auto from = first_[index(body)], to = first_[index(body) + 1];
  return std::span(beside_).subspan(index(from), index(to - from));
}

}  // namespace tactus::sim
