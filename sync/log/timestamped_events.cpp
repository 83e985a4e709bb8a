#include "sync/log/timestamped_events.h"

#include <algorithm>

namespace tactus::sync {

TimestampedEvents::TimestampedEvents(const LogIndex& index, int number)
    : index_(&index), whole_file_(number == kWholeFile), run_(whole_file_ ? 0 : static_cast<std::size_t>(number) - 1), scanner_(index.bytes()) {
  if (!whole_file_) index.run(number);  // throws when there is none
  enter(run_, 0);
}

void TimestampedEvents::enter(std::size_t run, std::int64_t join_us) {
  run_ = run;
  join_us_ = join_us;
  const RecordedRun& r = index_->runs()[run];
  scanner_ = LogScanner(index_->bytes());
  scanner_.seek(r.begin);
  event_ = r.first_event;
  ahead_.reset();
  newest_us_ = join_us + (r.seek_points.empty() ? r.first_us : r.seek_points.front().us);
  passed_late_ = {INT64_MIN, 0, 0};
}

std::int64_t TimestampedEvents::join_behind(std::size_t run, std::int64_t join_us) const {
  const RecordedRun &before = index_->runs()[run], &after = index_->runs()[run + 1];
  return join_us + std::max<std::int64_t>(0, before.last_us - after.first_us);
}

bool TimestampedEvents::enter_next_run() {
  if (!whole_file_ || run_ + 1 >= index_->runs().size()) return false;
  enter(run_ + 1, join_behind(run_, join_us_));
  return true;
}

std::int64_t TimestampedEvents::first_us() const { return first_run().first_us; }

std::int64_t TimestampedEvents::last_us() const {
  if (!whole_file_) return run().last_us;
  std::int64_t join_us = 0;
  const auto& runs = index_->runs();
  for (std::size_t i = 0; i + 1 < runs.size(); ++i) join_us = join_behind(i, join_us);
  return runs.back().last_us + join_us;
}

void TimestampedEvents::seek(HostTime from) {
  const std::int64_t us = (to_ns(from) + origin().info.realtime_offset_ns) / 1000;
  returned_us_ = INT64_MIN;
  if (whole_file_) {
    enter(0, 0);
    while (run_ + 1 < index_->runs().size()) {
      const std::int64_t join_us = join_behind(run_, join_us_);
      if (index_->runs()[run_ + 1].first_us + join_us > us) break;
      enter(run_ + 1, join_us);
    }
  } else {
    enter(run_, 0);
  }
  const auto& points = run().seek_points;
  const auto next = std::upper_bound(points.begin(), points.end(), us - join_us_,
                                     [](std::int64_t t, const RecordedRun::SeekPoint& p) { return t < p.us; });
  if (next == points.begin() || std::prev(next) == points.begin()) return;
  const RecordedRun::SeekPoint& point = *std::prev(next);
  scanner_.seek(point.at);
  event_ = point.event;
  newest_us_ = point.us + join_us_;
  passed_late_ = {point.us, 0, 0};
}

bool TimestampedEvents::read_ahead() {
  while (!ahead_) {
    const RecordedRun& r = run();
    LogEvent event;
    if (event_ >= r.first_event + r.events || !scanner_.next(event)) {
      if (!enter_next_run()) return false;
      continue;
    }
    const EventUse use = index_->use(event_++);
    if (!whole_file_ && (use == EventUse::kCopy || use == EventUse::kLate)) continue;
    if (use == EventUse::kInOrder)
      newest_us_ = bounded_us(event.timestamp_us) + r.shift_us(event.begins_at(index_->bytes())) + join_us_;
    event.timestamp_us = newest_us_;
    ahead_ = event;
    ahead_event_ = event_ - 1;
  }
  return true;
}

const RecordedRun::LateEvent* TimestampedEvents::next_late() const {
  if (whole_file_) return nullptr;
  const auto& late = run().late;
  const auto next = std::upper_bound(late.begin(), late.end(), passed_late_);
  return next == late.end() ? nullptr : &*next;
}

bool TimestampedEvents::next(LogEvent& event, HostTime& time) {
  const bool more = read_ahead();
  const RecordedRun::LateEvent* const late = next_late();
  const bool precedes = late != nullptr && (!more || late->us < ahead_->timestamp_us || (late->us == ahead_->timestamp_us && late->before <= ahead_event_));
  if (precedes) {
    LogScanner scanner(index_->bytes());
    scanner.seek(late->at);
    if (!scanner.next(event)) return false;
    event.timestamp_us = late->us;
    passed_late_ = *late;
  } else if (more) {
    event = *ahead_;
    ahead_.reset();
  } else {
    return false;
  }
  returned_us_ = event.timestamp_us = std::max(event.timestamp_us, returned_us_);
  time = origin().time(event.timestamp_us);
  return true;
}

}  // namespace tactus::sync
