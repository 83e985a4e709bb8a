#include "sim_node/publish/page_scheduler.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim {
namespace {

constexpr double kTiny_s = 1e-9;  // rounding of n / rate

double seconds(sync::SimTime t) { return sync::to_seconds(t.time_since_epoch()); }

}  // namespace

PageScheduler::PageScheduler(double rate_Hz, double pages_per_second, sync::Nanoseconds step)
    : rate_Hz_(rate_Hz), per_tick_(pages_per_second * sync::to_seconds(step)), step_(step) {
  for (State& s : lanes_) s.rate_Hz = rate_Hz;
}

// Distributes the remaining pages evenly over the ticks up to the next snapshot.
void PageScheduler::set_share(State& s) const {
  const double remaining_s = static_cast<double>(s.next) / rate_Hz_ - seconds(now_);
  const double ticks = std::max(1.0, std::floor(remaining_s / sync::to_seconds(step_)));
  s.share = static_cast<std::size_t>(std::ceil(static_cast<double>(s.left()) / ticks));
}

void PageScheduler::tick(sync::SimTime now) {
  now_ = now;
  // Unused pages of a tick are not saved for a burst, so that no second exceeds the budget. Exception: a budget of
  // less than one page per tick accumulates up to one page.
  allowance_ = std::min(allowance_ + per_tick_, std::max(1.0, per_tick_));
  for (State& s : lanes_) set_share(s);
}

bool PageScheduler::due(Lane lane) const {
  const State& s = at(lane);
  return s.left() == 0 && seconds(now_) >= static_cast<double>(s.next) / rate_Hz_ - kTiny_s;
}

void PageScheduler::begin(Lane lane, std::size_t pages) {
  State& s = at(lane);
  s.pages = pages;
  s.sent = 0;
  if (s.taken_ns >= 0) s.rate_Hz = 1e9 / static_cast<double>(sync::to_ns(now_) - s.taken_ns);
  s.taken_ns = sync::to_ns(now_);
  // Missed snapshots are skipped, not made up for.
  s.next = std::max(s.next + 1, static_cast<std::int64_t>(std::floor((seconds(now_) + kTiny_s) * rate_Hz_)) + 1);
  set_share(s);
}

void PageScheduler::begin_urgent_world(std::size_t pages) {
  State& s = at(Lane::kWorld);
  s.pages = pages;
  s.sent = 0;
  s.taken_ns = sync::to_ns(now_);
  urgent_ = true;
}

bool PageScheduler::take_extra() {
  if (allowance_ < 1) return false;
  allowance_ -= 1;
  return true;
}

Lane PageScheduler::next() {
  State &world = at(Lane::kWorld), &contacts = at(Lane::kContacts);
  if (world.left() == 0) urgent_ = false;
  if (allowance_ < 1) return Lane::kNone;
  const bool world_ready = world.left() > 0 && (world.share > 0 || urgent_);
  const bool contacts_ready = contacts.left() > 0 && contacts.share > 0 && !urgent_;
  if (!world_ready && !contacts_ready) return Lane::kNone;
  const bool take_world = world_ready && (!contacts_ready || last_ == Lane::kContacts);
  last_ = take_world ? Lane::kWorld : Lane::kContacts;
  State& s = at(last_);
  allowance_ -= 1;
  ++s.sent;
  if (s.share > 0) --s.share;
  return last_;
}

}  // namespace tactus::sim
