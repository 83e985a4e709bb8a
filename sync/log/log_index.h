// The first step of every reader of a log: finds the runs that the log holds, the time of each event, and the events that are
// copies of others. One pass over the log, in pieces if wanted. Pure.
//
// A run ends where the messages of another run begin, or where the same identities send other messages under the same numbers.
// A run that was replayed by LCM's own player while another one was recorded is part of that one.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "sync/log/duplicate_finder.h"
#include "sync/log/log_origin.h"
#include "sync/log/log_reader.h"
#include "sync/log/recorder_clock.h"

namespace tactus::sync {

// How an event is passed on.
enum class EventUse : std::uint8_t {
  kInOrder,   // in its place, at its corrected stamp
  kLate,      // written later than its stamp says: before its place
  kMisdated,  // its stamp is damaged: in its place, at the time of the previous event
  kCopy,      // a copy of another event: not at all
};

// One run of a log. All stamps are corrected (sync/log/recorder_clock.h).
struct RecordedRun {
  struct Jump {
    std::size_t at;          // byte of the log
    std::int64_t us, by_us;  // corrected stamp, and the size of the jump
    std::int64_t shift_us;   // correction of the stamps from here on
  };
  struct LateEvent {
    std::int64_t us;
    std::int64_t before;  // the number of the event with the same stamp that it precedes; INT64_MAX: it follows all of them
    std::size_t at;
    auto operator<=>(const LateEvent&) const = default;
  };
  struct SeekPoint {
    std::int64_t us;
    std::size_t at;
    std::int64_t event;
  };
  std::int64_t run_id = 0;  // 0: no message of this system
  std::set<std::int64_t> guests;  // other runs, replayed meanwhile
  std::size_t begin = 0, end = 0;  // bytes
  std::int64_t first_event = 0, events = 0;  // their numbers in the log, with copies
  std::int64_t first_us = 0, last_us = 0;
  std::int64_t messages = 0;  // of this system, without copies
  std::int64_t copies = 0, misdated = 0;
  std::int64_t contradicting = 0;  // messages with a false time of sending (RecorderClock)
  std::vector<Jump> jumps;
  std::vector<LateEvent> late;          // by time
  std::vector<SeekPoint> seek_points;  // every kSeekInterval_us
  LogOrigin origin;

  // Correction of the stamp of the event at this byte.
  std::int64_t shift_us(std::size_t at) const;
  double length_s() const { return static_cast<double>(last_us - first_us) * 1e-6; }
};

class LogIndex {
 public:
  static constexpr std::int64_t kSeekInterval_us = 500'000;
  // Fewer messages cannot be a run (RecorderClock::kMinRunEvents); a run lasts longer than this.
  static constexpr std::int64_t kMinRunMessages = RecorderClock::kMinRunEvents, kMinRun_us = 2'000'000;
  // Further late events keep the time of the previous event.
  static constexpr std::size_t kMaxLate = 4 << 20;

  // The bytes outlive this object. Nothing is read yet.
  explicit LogIndex(std::span<const std::uint8_t> bytes) : bytes_(bytes), scanner_(bytes), present_(new Attempt) { runs_.emplace_back(); }

  // Reads the next events; false: the log is over.
  bool read(std::int64_t max_events);
  void read_all() {
    while (read(INT64_MAX)) continue;
  }
  bool complete() const { return complete_; }

  // Whether the origin of the last run is known; it does not change any more then.
  bool origin_known() const { return present_->origin_known; }

  // At least one; the last one grows while the log is read.
  const std::vector<RecordedRun>& runs() const { return runs_; }
  // number: from 1. Throws std::runtime_error with one sentence, whose subject is the log, when there is no such run.
  const RecordedRun& run(int number) const;
  EventUse use(std::int64_t event) const;
  std::span<const std::uint8_t> bytes() const { return bytes_; }

  // Of the whole log, as far as it was read.
  std::int64_t events() const { return static_cast<std::int64_t>(uses_.size()); }
  std::int64_t damaged_regions() const { return scanner_.damaged_regions(); }
  std::int64_t damaged_bytes() const { return scanner_.damaged_bytes(); }

  // Sentences for the user of one run, or of all runs (0): several runs in the log, jumps of the recorder's clock, copies. Empty:
  // nothing is unusual.
  std::vector<std::string> warnings(int number) const;

 private:
  // A place in the log to return to.
  struct Mark {
    LogScanner before;
    std::int64_t event;
    std::int64_t last_us, messages, copies, misdated, contradicting;
  };
  // Knowledge about the run that is read at present.
  struct Attempt {
    DuplicateFinder copies;
    RecorderClock clock;
    LogClockDetector detector;
    bool has_info = false, dated = false;
    std::optional<Mark> other, info, contradiction;  // where another run may begin
    std::map<std::int64_t, std::int64_t> others;  // messages of other runs, by run id
    std::map<std::int64_t, std::int64_t> since_other;  // the same since the mark `other`
    std::int64_t other_run = 0, other_messages = 0, other_since_us = 0;  // of the most frequent of them
    std::map<std::int64_t, std::int64_t> played_again_us;  // newest message of a run that LCM's player sends again, by run id
    std::uint32_t recent_contradictions = 0;  // a bit for each of the last messages with a known number
    std::vector<std::pair<std::int64_t, std::int64_t>> plain;  // events without number that may be copies, and how many came before
    bool origin_known = false;
    struct Newest {
      std::int64_t seq, us, event;
    };
    std::unordered_map<std::uint64_t, Newest> newest;  // message of each stream (DuplicateFinder)
  };

  Mark mark(const LogScanner& before) const;
  bool begins_other_run(const LogEvent& event, const header_t* header, const LogScanner& before);
  bool other_run_confirmed() const;
  bool other_run_begins();
  bool add(const LogEvent& event, const LogScanner& before);
  void place(const LogEvent& event, const header_t* header, const RecorderClock::Result& result);
  void add_late(const LogEvent& event, const header_t* header, std::int64_t us);
  bool overtaken(const LogEvent& event, const header_t* header, std::int64_t us);
  bool is_copy(const LogEvent& event, const header_t* header, const StampSample& sample, const LogScanner& before);
  bool same_identities_again();
  void begin_run(Mark at);
  void end_run();
  void find_origin();
  void mark_plain_copies();
  void set_use(std::int64_t event, EventUse use) { uses_[static_cast<std::size_t>(event)] = use; }

  std::span<const std::uint8_t> bytes_;
  LogScanner scanner_;
  std::vector<RecordedRun> runs_;
  std::vector<EventUse> uses_;  // of each event
  std::unique_ptr<Attempt> present_;
  bool complete_ = false;
};

}  // namespace tactus::sync
