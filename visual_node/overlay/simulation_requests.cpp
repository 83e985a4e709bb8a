#include "visual_node/overlay/simulation_requests.h"

#include "sync/text/printable.h"

namespace tactus::visual {

void SimulationRequests::request(Action action, std::int64_t id) {
  if (pending_.size() >= kMaxPending) return;
  sim_command_t c{};
  c.header.sim_time_ns = -1;
  c.header.run_id = c.header.incarnation = 1;  // placeholders; the bus stamps them
  c.id = id;
  switch (action) {
    case Action::kPauseOrResume: c.kind = paused_ ? sim_command_t::RESUME : sim_command_t::PAUSE; break;
    case Action::kStep:
      c.kind = sim_command_t::STEP;
      c.steps = 1;
      break;
    case Action::kReset: c.kind = sim_command_t::RESET; break;
    default: return;
  }
  pending_.push_back(c);
}

void SimulationRequests::push(const sim_reply_t& m) {
  if (pending_.empty() || m.id != pending_.front().id) return;
  paused_ = m.paused == 1;
  answer_ = sync::printable(m.text);
  pending_.pop_front();
  first_sent_.reset();
  sent_.reset();
}

std::optional<sim_command_t> SimulationRequests::step(sync::HostTime now) {
  if (pending_.empty()) return std::nullopt;
  if (!first_sent_) first_sent_ = now;
  if (now - *first_sent_ > kTimeout) {
    answer_ = "no sim_node answers";
    pending_.clear();
    first_sent_.reset();
    sent_.reset();
    return std::nullopt;
  }
  if (sent_ && now - *sent_ < kRepeat) return std::nullopt;
  sent_ = now;
  return pending_.front();
}

}  // namespace tactus::visual
