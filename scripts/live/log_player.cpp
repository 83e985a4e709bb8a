#include "scripts/live/log_player.h"

#include <algorithm>
#include <stdexcept>

namespace tactus::live {

LogPlayer::LogPlayer(const std::string& path, int run) : file_(std::make_unique<sync::MappedLog>(path)), index_(file_->bytes()), run_(run) {
  try {
    begin();
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(path + " " + e.what());
  }
}

LogPlayer::LogPlayer(std::span<const std::uint8_t> bytes, int run) : index_(bytes), run_(run) { begin(); }

void LogPlayer::begin() {
  const auto known = [&] { return static_cast<std::size_t>(run_) < index_.runs().size() || (static_cast<std::size_t>(run_) == index_.runs().size() && index_.origin_known()); };
  while (!known() && scan_next()) continue;
  if (index_.events() == 0) throw std::runtime_error("has no event of an LCM log; give a run.lcmlog");
  events_.emplace(index_, run_);
  begin_ = position_ = events_->origin().time(events_->first_us());
  playing_ = true;
}

bool LogPlayer::scan_next() { return index_.read(kMaxEvents); }

sync::HostTime LogPlayer::end() const { return std::max(begin_, events_->origin().time(events_->last_us())); }

void LogPlayer::seek(double to_s) {
  position_ = begin_ + sync::from_seconds(std::clamp(to_s, 0.0, length_s()));
  events_->seek(std::max(begin_, position_ - kSeekLead));
  has_pending_ = false;
}

void LogPlayer::advance(sync::Nanoseconds dt, const EventHandler& on_event) {
  if (playing_)
    position_ = std::min(end(), position_ + sync::from_seconds(std::clamp(sync::to_seconds(dt), 0.0, 0.5) * rate_));
  for (int i = 0; i < kMaxEvents; ++i) {
    if (!has_pending_ && !events_->next(pending_, pending_at_)) return;
    has_pending_ = true;
    if (pending_at_ > position_) return;
    on_event(pending_.channel, pending_.data, pending_at_);
    has_pending_ = false;
  }
}

}  // namespace tactus::live
