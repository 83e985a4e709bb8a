#include "visual_node/overlay/desk.h"

#include "sync/text/printable.h"

namespace tactus::visual {

void SimulationWishes::ask(Act act, std::int64_t id) {
  if (waiting_.size() >= kMaxWaiting) return;
  sim_command_t c{};
  c.header.sim_time_ns = -1;
  c.header.run_id = c.header.incarnation = 1;  // the bus stamps them
  c.id = id;
  switch (act) {
    case Act::kPauseOrResume: c.kind = paused_ ? sim_command_t::RESUME : sim_command_t::PAUSE; break;
    case Act::kStep:
      c.kind = sim_command_t::STEP;
      c.steps = 1;
      break;
    case Act::kReset: c.kind = sim_command_t::RESET; break;
    default: return;
  }
  waiting_.push_back(c);
}

void SimulationWishes::push(const sim_reply_t& m) {
  if (waiting_.empty() || m.id != waiting_.front().id) return;
  paused_ = m.paused == 1;
  answer_ = sync::printable(m.text);
  waiting_.pop_front();
  asked_.reset();
  sent_.reset();
}

std::optional<sim_command_t> SimulationWishes::step(sync::HostTime now) {
  if (waiting_.empty()) return std::nullopt;
  if (!asked_) asked_ = now;
  if (now - *asked_ > kPatience) {
    answer_ = "no sim_node answers";
    waiting_.clear();
    asked_.reset();
    sent_.reset();
    return std::nullopt;
  }
  if (sent_ && now - *sent_ < kRepeat) return std::nullopt;
  sent_ = now;
  return waiting_.front();
}

}  // namespace tactus::visual
