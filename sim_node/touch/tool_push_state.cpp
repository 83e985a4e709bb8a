#include "sim_node/touch/tool_push.h"

namespace tactus::sim {

void ToolPush::archive(StateArchive& a, std::size_t bodies) {
  std::vector<std::pair<std::int64_t, Account>> all(accounts_.begin(), accounts_.end());
  a.list(all, kRemembered, [&](auto& entry) {
    auto& [id, book] = entry;
    a(id);
    a.index(book.body, bodies);
    a.require(book.body >= 0, "the state holds a contact of no body");
    a(book.point), a(book.told), a(book.felt), a(book.owed), a(book.mean_N), a(book.applied), a(book.velocity);
    a(book.energy_J), a(book.used);
  });
  if (a.reads()) accounts_ = {all.begin(), all.end()};
  a(incarnation_), a(replaced_), a(last_seq_), a(last_publish_ns_);
  bool heard = heard_.has_value();
  sync::SimTime when = heard_.value_or(sync::SimTime{});
  a(heard), a(when);
  heard_ = heard ? std::optional(when) : std::nullopt;
  if (a.reads()) pushes_.clear();
}

void ToolPush::hold(sync::SimTime now, std::span<const tool_state_t> news, std::span<const BodyMotion> bodies) {
  take(news, now, bodies);
  for (auto& [id, book] : accounts_) book.felt = book.owed = book.mean_N = Eigen::Vector3d::Zero();
  pushes_.clear();
}

void ToolPush::forget() {
  accounts_.clear();
  incarnation_ = replaced_ = 0;
  last_seq_ = -1;
  last_publish_ns_ = 0;
  heard_.reset();
  pushes_.clear();
}

}  // namespace tactus::sim
