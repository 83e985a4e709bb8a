#include "sync/log/log_index.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "lcmtypes/channels.h"
#include "lcmtypes/fields.h"
#include "sync/log/log_header.h"
#include "sync/text/printable.h"

namespace tactus::sync {
namespace {

constexpr std::int64_t kMinOwnMessages = 8;     // fewer before those of another run are strays of it
constexpr std::int64_t kEnoughMessages = 4096;  // for the origin of a run: a second of it
constexpr std::size_t kMaxHeadBytes = 320 << 20;  // more than the largest scene at the head
constexpr std::int64_t kReplayedAgain_us = 500'000;  // design: more than a latency, less than a log is played in
constexpr std::size_t kMaxOthers = 64;               // damaged messages name runs that never were
// Of the last 32 messages with a known number; single contradictions are damage.
constexpr int kMinContradictions = 12;

std::string text_of_us(std::int64_t us) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3f", static_cast<double>(us) * 1e-6);
  return text;
}

}  // namespace

std::int64_t RecordedRun::shift_us(std::size_t at) const {
  const auto next = std::upper_bound(jumps.begin(), jumps.end(), at, [](std::size_t byte, const Jump& jump) { return byte < jump.at; });
  return next == jumps.begin() ? 0 : std::prev(next)->shift_us;
}

const RecordedRun& LogIndex::run(int number) const {
  if (number < 1 || static_cast<std::size_t>(number) > runs_.size())
    throw std::runtime_error("holds " + std::to_string(runs_.size()) + (runs_.size() == 1 ? " run" : " runs") + ", and none with the number " +
                             std::to_string(number) + "; see replay LOG --describe");
  return runs_[static_cast<std::size_t>(number) - 1];
}

EventUse LogIndex::use(std::int64_t event) const { return uses_[static_cast<std::size_t>(event)]; }

LogIndex::Mark LogIndex::mark(const LogScanner& before) const {
  const RecordedRun& run = runs_.back();
  return {before, events(), run.last_us, run.messages, run.copies, run.misdated, run.contradicting};
}

bool LogIndex::read(std::int64_t max_events) {
  for (std::int64_t i = 0; i < max_events && !complete_; ++i) {
    const LogScanner before = scanner_;
    LogEvent event;
    if (scanner_.next(event)) {
      add(event, before);
    } else if (present_->other && other_run_confirmed() && other_run_begins()) {
      begin_run(*present_->other);
    } else {
      end_run();
      complete_ = true;
    }
  }
  return !complete_;
}

// False when another run begins, and reading continues at its beginning.
bool LogIndex::add(const LogEvent& event, const LogScanner& before) {
  const auto header = type_of(event.data) ? peek_header(event.data.data(), event.data.size()) : std::nullopt;
  const header_t* const known = header ? &*header : nullptr;
  if (begins_other_run(event, known, before)) {
    begin_run(*present_->other);
    return false;
  }
  RecordedRun& run = runs_.back();
  const StampSample sample = stamp_sample(event);
  const bool copy = is_copy(event, known, sample, before);
  if (same_identities_again()) {
    begin_run(present_->info ? *present_->info : *present_->contradiction);
    return false;
  }
  ++run.events;
  if (copy) {
    ++run.copies;
    uses_.push_back(EventUse::kCopy);
    return true;
  }
  run.messages += known != nullptr;
  place(event, known, present_->clock.observe(sample, scanner_));
  return true;
}

bool LogIndex::other_run_confirmed() const { return present_->other_messages >= kMinRunMessages; }

bool LogIndex::begins_other_run(const LogEvent& event, const header_t* header, const LogScanner& before) {
  RecordedRun& run = runs_.back();
  Attempt& now = *present_;
  if (event.channel == channels::kLogInfo && header != nullptr) {
    if (run.events > 0) now.info = mark(before);
    now.has_info = now.has_info || run.events == 0;
  }
  if (header == nullptr) return false;
  if (run.run_id == 0) run.run_id = header->run_id;
  if (header->run_id == run.run_id) {
    now.other.reset();
    return false;
  }
  if (now.others.size() < kMaxOthers || now.others.contains(header->run_id))
    if (++now.others[header->run_id] == kMinRunMessages) run.guests.insert(header->run_id);
  if (!now.other) {
    now.other = mark(before);
    now.other_messages = 0, now.other_since_us = bounded_us(event.timestamp_us);
    now.since_other.clear();
  }
  // The first message may be damaged and name a run that never was: the run with the most messages counts.
  if (now.since_other.size() < kMaxOthers || now.since_other.contains(header->run_id))
    if (const std::int64_t messages = ++now.since_other[header->run_id]; messages > now.other_messages)
      now.other_run = header->run_id, now.other_messages = messages;
  if (!other_run_confirmed() || std::abs(bounded_us(event.timestamp_us) - now.other_since_us) < kMinRun_us) return false;
  return other_run_begins();
}

// Of a confirmed run: true when it begins at its mark. False: the few messages before it are strays or damaged, and this run is that one.
bool LogIndex::other_run_begins() {
  if (present_->other->messages >= kMinOwnMessages) return true;
  runs_.back().run_id = present_->other_run;
  runs_.back().guests.erase(present_->other_run);
  present_->other.reset();
  return false;
}

bool LogIndex::is_copy(const LogEvent& event, const header_t* header, const StampSample& sample, const LogScanner& before) {
  Attempt& now = *present_;
  if (header == nullptr) {
    if (is_head_channel(event.channel)) return false;
    if (const std::int64_t others = now.copies.observe_plain(event); others > 0) now.plain.emplace_back(events(), others);
    return false;
  }
  const Copy copy = now.copies.observe(event, *header);
  if (copy == Copy::kFirst || is_head_channel(event.channel)) return copy == Copy::kDuplicate;
  if (copy == Copy::kContradiction && now.recent_contradictions == 0) now.contradiction = mark(before);
  now.recent_contradictions = now.recent_contradictions << 1 | (copy == Copy::kContradiction);
  if (copy == Copy::kContradiction) return false;
  // LCM's player sends a recorded run again without any change, while another one is recorded: that is no copy.
  if (!now.has_info || header->run_id == runs_.back().run_id) return true;
  const auto excess_us = now.clock.excess_us(sample);
  const auto played = now.played_again_us.find(header->run_id);
  const bool continues = played != now.played_again_us.end() && std::abs(event.timestamp_us - played->second) < kReplayedAgain_us;
  // The clock of the recorder soon takes the later times of the player for right, so the playing continues until a pause.
  if (!continues && !(excess_us && *excess_us > kReplayedAgain_us)) return true;
  if (played != now.played_again_us.end()) {
    played->second = event.timestamp_us;
  } else if (now.played_again_us.size() < kMaxOthers) {
    now.played_again_us.emplace(header->run_id, event.timestamp_us);
  }
  return false;
}

bool LogIndex::same_identities_again() {
  Attempt& now = *present_;
  return now.contradiction && std::popcount(now.recent_contradictions) >= kMinContradictions;
}

// True for a message that was written behind a later one of its sender, with the same stamp.
bool LogIndex::overtaken(const LogEvent& event, const header_t* header, std::int64_t us) {
  if (header == nullptr || present_->newest.size() > DuplicateFinder::kMaxStreams) return false;
  const auto [it, first] = present_->newest.try_emplace(DuplicateFinder::stream_of(event, *header), Attempt::Newest{header->seq, us, events()});
  if (!first && header->seq < it->second.seq && us == it->second.us) return true;
  it->second = {header->seq, us, events()};
  return false;
}

void LogIndex::add_late(const LogEvent& event, const header_t* header, std::int64_t us) {
  RecordedRun& run = runs_.back();
  const auto newest = header ? present_->newest.find(DuplicateFinder::stream_of(event, *header)) : present_->newest.end();
  const bool precedes = newest != present_->newest.end() && newest->second.us == us && newest->second.seq > header->seq;
  const RecordedRun::LateEvent late{us, precedes ? newest->second.event : INT64_MAX, event.begins_at(bytes_)};
  run.late.insert(std::upper_bound(run.late.begin(), run.late.end(), late), late);
  run.first_us = std::min(run.first_us, us);
}

void LogIndex::place(const LogEvent& event, const header_t* header, const RecorderClock::Result& result) {
  RecordedRun& run = runs_.back();
  Attempt& now = *present_;
  const std::size_t at = event.begins_at(bytes_);
  EventUse use = result.order == RecorderClock::Order::kInOrder ? EventUse::kInOrder
                 : result.order == RecorderClock::Order::kLate  ? EventUse::kLate
                                                                : EventUse::kMisdated;
  if (result.jump_us != 0) run.jumps.push_back({at, result.us, result.jump_us, now.clock.shift_us()});
  if (use == EventUse::kInOrder && overtaken(event, header, result.us)) use = EventUse::kLate;
  if (use == EventUse::kLate && run.late.size() >= kMaxLate) use = EventUse::kMisdated;
  if (use == EventUse::kMisdated) ++run.misdated;
  run.contradicting = now.clock.contradicting();
  if (use == EventUse::kLate) {
    add_late(event, header, result.us);
  } else if (use == EventUse::kInOrder || !now.dated) {
    run.first_us = now.dated ? run.first_us : result.us;
    run.last_us = now.dated ? std::max(run.last_us, result.us) : result.us;
    now.dated = now.dated || use == EventUse::kInOrder;
  }
  if (use != EventUse::kLate && (run.seek_points.empty() || run.last_us >= run.seek_points.back().us + kSeekInterval_us))
    run.seek_points.push_back({run.last_us, at, events()});
  uses_.push_back(use);
  if (now.origin_known) return;
  LogEvent corrected = event;
  corrected.timestamp_us = result.us;
  now.detector.observe(corrected);
  if (now.detector.messages_with_run() >= kEnoughMessages || at - run.begin >= kMaxHeadBytes) find_origin();
}

void LogIndex::find_origin() {
  if (std::exchange(present_->origin_known, true)) return;
  runs_.back().origin = present_->detector.find();
}

void LogIndex::begin_run(Mark at) {
  RecordedRun& run = runs_.back();
  const std::size_t byte = at.before.at();
  const auto behind = [&](const auto& entry) { return entry.at >= byte; };
  std::erase_if(run.late, behind);
  std::erase_if(run.jumps, behind);
  std::erase_if(run.seek_points, behind);
  std::erase_if(present_->plain, [&](const auto& entry) { return entry.first >= at.event; });
  uses_.resize(static_cast<std::size_t>(at.event));
  run.events = at.event - run.first_event;
  run.last_us = at.last_us, run.messages = at.messages, run.copies = at.copies, run.misdated = at.misdated;
  run.contradicting = at.contradicting;
  run.guests.erase(present_->other ? present_->other_run : 0);
  scanner_ = at.before;
  end_run();
  RecordedRun next;
  next.begin = byte;
  next.first_event = at.event;
  runs_.push_back(std::move(next));
  present_ = std::make_unique<Attempt>();
}

void LogIndex::end_run() {
  find_origin();
  mark_plain_copies();
  runs_.back().end = std::min(scanner_.at(), bytes_.size());
  present_ = std::make_unique<Attempt>();
  present_->origin_known = true;
}

// Two loggers wrote the messages of other systems twice, too. Only the others show it, because a message may repeat the last one.
void LogIndex::mark_plain_copies() {
  RecordedRun& run = runs_.back();
  const std::int64_t loggers = run.messages == 0 ? 1 : (run.messages + run.copies + run.messages / 2) / run.messages;
  if (loggers < 2) return;
  for (const auto& [event, others] : present_->plain) {
    if (others % loggers == 0 || use(event) == EventUse::kLate) continue;
    set_use(event, EventUse::kCopy);
    ++run.copies;
  }
}

std::vector<std::string> LogIndex::warnings(int number) const {
  std::vector<std::string> sentences;
  const auto chosen = number == 0 ? std::span(runs_) : std::span(&run(number), 1);
  if (runs_.size() > 1) {
    std::string names;
    for (std::size_t i = 0; i < std::min<std::size_t>(runs_.size(), 9); ++i)
      names += (i > 0 ? ", " : "") + std::to_string(i + 1) + ": " +
               (runs_[i].origin.info.scene.empty() ? "run id " + std::to_string(runs_[i].run_id) : printable(runs_[i].origin.info.scene));
    sentences.push_back("the log holds " + std::to_string(runs_.size()) + " runs (" + names + (runs_.size() > 9 ? ", ..." : "") + "); " +
                        (number == 0 ? "the column run holds their number, --run N selects one"
                                     : "run " + std::to_string(number) + " is read, --run N selects another one"));
  }
  std::int64_t copies = 0, contradicting = 0;
  std::size_t jumps = 0;
  std::string sizes;
  for (const RecordedRun& r : chosen) {
    copies += r.copies, contradicting += r.contradicting;
    for (const RecordedRun::Jump& jump : r.jumps)
      if (++jumps <= 3) sizes += (jumps > 1 ? ", " : "") + text_of_us(jump.by_us) + " s after " + text_of_us(jump.us - r.first_us) + " s";
  }
  if (jumps > 0)
    sentences.push_back("the clock of the recorder jumped " + std::to_string(jumps) + (jumps == 1 ? " time (" : " times (") + sizes +
                        (jumps > 3 ? ", ..." : "") + "); the times are corrected by the clocks of the senders");
  if (contradicting > 0)
    sentences.push_back(std::to_string(contradicting) + (contradicting == 1 ? " message has" : " messages have") +
                        " a time of sending that contradicts the other messages of the sender, as after damage or a forgery; this time is not used");
  if (copies > 0) sentences.push_back(std::to_string(copies) + " copies of messages are left out, as of two loggers of one run");
  return sentences;
}

}  // namespace tactus::sync
