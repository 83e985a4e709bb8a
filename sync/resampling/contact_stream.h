// Turns the contact channels into what a sense needs for its tick: the events due, the state at an instant, and
// the integrals over the tick. Pure: time and messages are arguments.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/sim_clock_t.hpp>
#include <vector>

#include "sync/bus/page_assembler.h"
#include "sync/bus/recent_map.h"
#include "sync/clocks/sim_clock_tracker.h"
#include "sync/resampling/sample_status.h"
#include "sync/time/time.h"

namespace tactus::sync {

// Live contacts at an instant.
using Contacts = std::vector<contact_t>;

// What a slow sense integrates: means over a tick, weighted by the time of contact.
// What the tool had of one body in an interval.
struct ContactPart {
  std::int32_t body = -1, material = -1;
  Nanoseconds contact_time{0};  // how long it touched that at all
  double force_N = 0;           // means over the whole interval, as below
  double area_m2 = 0;
};

struct ContactIntegral {
  Nanoseconds contact_time{0};  // how long the tool touched at all within the interval
  double force_N = 0;           // mean normal force over the whole interval
  double area_m2 = 0;           // mean area over the whole interval
  std::int32_t material = -1;   // of the other body of the contact that lasted longest; -1: none
  std::int32_t body = -1;
  SampleStatus status = SampleStatus::kNone;
  std::vector<ContactPart> parts;  // all bodies touched, by body and material; they add up to the whole but for the time
};

class ContactStream {
 public:
  // Past the newest snapshot the contact state is held, since its begin and end come as events; then it is stale.
  static constexpr Nanoseconds kStaleAfter{50'000'000};
  static constexpr std::size_t kMaxPendingEvents = 4096;
  // 2,000 contacts, three a page, are 700 pages.
  static constexpr int kMaxPages = 1024;
  // Of all snapshots of a group together: half a second of 2,000 contacts at 60 Hz.
  static constexpr std::size_t kMaxContacts = 1 << 16;

  // So much of the past is kept at the least, as far as kMaxContacts reaches, so that a sense may present that late.
  static constexpr Nanoseconds kSpan{1'000'000'000};

  // own: messages of another clock are read through its map; those of another run by arrival.
  explicit ContactStream(OwnClock own);

  // A sense asks for what is so long ago: so much more than kSpan is kept.
  void keep(Nanoseconds delay) { span_ = kSpan + delay; }
  void push(const contact_events_t&, HostTime arrival);
  void push(const contact_frame_t&, HostTime arrival);

  // Map between simulated time and our host clock, from the newest message. Nothing before the first.
  std::optional<TimeMap> map(HostTime now) const { return follower_.map(now); }

  // Events whose time is before `until` and that were not taken before, in order of time; each exactly once,
  // however often it was repeated or replayed within an incarnation. An event that arrives late is returned at the
  // next call.
  std::vector<contact_event_t> take_events(SimTime until);

  // Contacts alive at `t`, of all groups: the newest complete snapshot at or before t, its forces and depths
  // interpolated towards the next. `how` is the worst of the groups. A contact whose begin lies after t or whose end
  // lies at or before t is not in it, whatever the snapshots say. One that moved between OTHER and AHEAD is there once,
  // as it was told last; one that was foreseen is there once its begin has been heard or another snapshot tells of it too.
  Sample<Contacts> state_at(SimTime t) const;

  // Contacts of `tool` over [t0, t1). Begin and end events bound the contact time exactly, so that a contact
  // shorter than the interval between snapshots counts. tool_body: the tool's body id, to tell which side is the
  // other body.
  ContactIntegral integral(SimTime t0, SimTime t1, int tool, int tool_body = -1) const;

  // How many times a new incarnation or epoch of the simulation ended all contacts.
  std::int64_t restarts() const { return restarts_; }
  std::int64_t duplicates() const { return duplicates_; }
  // Events and pages that no simulation can have meant: more than 1 s ahead of its own time, or of too many pages.
  std::int64_t refused() const { return refused_; }
  // Events that found no room: of all that were pending, the latest.
  std::int64_t overflow() const { return overflow_; }

 private:
  static constexpr std::size_t kGroups = 3;  // by contact_frame_t.group
  struct Snapshot {
    SimTime time;
    Contacts contacts;
    std::vector<std::int64_t> seqs;  // of the page of each
  };
  struct Page {
    Contacts contacts;
    std::int64_t seq = 0;
  };
  struct Life {  // of a contact, from its events
    std::optional<contact_event_t> begin;
    std::optional<SimTime> end;
  };

  bool accept(const header_t& header, const sim_clock_t& clock, HostTime arrival);
  void forget_after(SimTime latest);
  void insert(std::size_t group, Snapshot snapshot);
  void note_event(const contact_event_t& event);
  bool alive(std::int64_t contact_id, SimTime t) const;
  SampleStatus status(const std::deque<Snapshot>& group, SimTime t) const;
  struct Candidate {  // for the state at an instant
    contact_t contact;
    std::int64_t seq = 0;
    bool present = false;  // in a snapshot of that instant or before; else known from a later one alone
  };
  void append_state(std::size_t group, SimTime t, std::vector<Candidate>& out) const;
  bool foreseen_only(std::size_t group, std::deque<Snapshot>::const_iterator told, std::int64_t id) const;
  static void keep_last_told(std::vector<Candidate>& list);

  SimClockTracker follower_;
  std::int64_t restarts_ = 0;
  std::int64_t duplicates_ = 0;
  std::int64_t refused_ = 0;
  std::int64_t overflow_ = 0;

  std::multimap<SimTime, contact_event_t> pending_;
  // Repetitions end 50 ms after an event; 8192 ids are 80 ms of 100,000 events a second.
  static constexpr std::size_t kRemembered = 8192;
  struct Received {};
  RecentMap<std::int64_t, Received> received_{kRemembered};  // by event id
  RecentMap<std::int64_t, Life> lives_{kRemembered};         // by contact id

  using Pages = PageAssembler<Page, SimTime>;
  std::array<Pages, kGroups> partial_;
  std::deque<Snapshot> snapshots_[kGroups];  // in order of time
  std::size_t contacts_kept_[kGroups] = {};
  Nanoseconds span_ = kSpan;
};

}  // namespace tactus::sync
