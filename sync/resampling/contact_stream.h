// The contact state of a renderer's tick: at an instant, and integrated over the tick. Its events are in an EventInbox. Pure:
// time and messages are arguments.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <vector>

#include "lcmtypes/page_limits.h"
#include "sync/bus/page_assembler.h"
#include "sync/resampling/event_inbox.h"
#include "sync/resampling/sample_status.h"
#include "sync/time/time.h"

namespace tactus::sync {

// Active contacts at an instant.
using Contacts = std::vector<contact_t>;

// The contact of the tool with one body in an interval. Slow modalities integrate: values are means over a tick, weighted by
// the time of contact.
struct ContactPart {
  std::int32_t body = -1, material = -1;
  Nanoseconds contact_time{0};  // duration of contact with this body
  double force_N = 0;           // means over the whole interval, as below
  double area_m2 = 0;
};

struct ContactIntegral {
  Nanoseconds contact_time{0};  // duration of any contact of the tool within the interval
  double force_N = 0;           // mean normal force over the whole interval
  double area_m2 = 0;           // mean area over the whole interval
  std::int32_t material = -1;   // of the other body of the contact that lasted longest; -1: none
  std::int32_t body = -1;
  SampleStatus status = SampleStatus::kNone;
  std::vector<ContactPart> parts;  // all touched bodies, by body and material; their sums equal the totals, except the time
};

class ContactStream {
 public:
  // After the newest snapshot the contact state is held for this time, because begin and end arrive as events; then it is
  // stale.
  static constexpr Nanoseconds kStaleAfter{50'000'000};
  static constexpr int kMaxPages = kMaxContactPages;
  // Maximum number of contacts in all snapshots of a group: half a second of 2,000 contacts at 60 Hz.
  static constexpr std::size_t kMaxContacts = 1 << 16;

  // Length of the stored past, limited by kMaxContacts; it limits the presentation delay of a modality.
  static constexpr Nanoseconds kSpan{1'000'000'000};

  // events: of the same simulation; it outlives this object.
  explicit ContactStream(EventInbox& events);
  // Stores the events that push() receives itself, without a profile. own: as for EventInbox.
  explicit ContactStream(OwnClock own);

  // Stores this time beyond kSpan, for a modality that presents with this delay.
  void extend_history(Nanoseconds delay) { span_ = kSpan + delay; }
  void push(const contact_events_t& m, HostTime arrival) { events_.push(m, arrival); }
  void push(const contact_frame_t&, HostTime arrival);

  // Map between simulated time and this host's clock, from the newest message. nullopt before the first.
  std::optional<TimeMap> map(HostTime now) const { return events_.map(now); }

  // Same as EventInbox::take.
  std::vector<contact_event_t> take_events(SimTime until) { return events_.take(until); }

  // Contacts that exist at `t`, of all groups: the newest complete snapshot at or before t, with forces and depths
  // interpolated towards the next. `status` is the worst of the groups. Begin and end events take precedence: a contact that
  // begins after t or ends at or before t is left out. A contact that moved between OTHER and AHEAD is listed once, as
  // published last. A predicted contact is listed once its begin event has arrived or another snapshot contains it.
  Sample<Contacts> state_at(SimTime t);

  // Contacts of `tool` over [t0, t1). Begin and end events bound the contact time exactly, so that a contact shorter than the
  // interval between snapshots counts. tool_body: the body id of the tool, which distinguishes it from the other body.
  ContactIntegral integral(SimTime t0, SimTime t1, int tool, int tool_body = -1);

  // Number of new incarnations or epochs of the simulation, each of which ended all contacts.
  std::int64_t restarts() const { return std::max<std::int64_t>(0, events_.epoch() - 1); }
  // Rejected events and pages: more than 1 s ahead of their simulation's own time, or with too many pages.
  std::int64_t refused() const { return refused_ + events_.refused(); }

 private:
  static constexpr std::size_t kGroups = 3;  // by contact_frame_t.group
  struct Snapshot {
    SimTime time;
    Contacts contacts;
    std::vector<std::int64_t> seqs;  // of the page of each contact
  };
  struct Page {
    Contacts contacts;
    std::int64_t seq = 0;
  };

  // Drops the snapshots of an ended simulation, and those after the latest credible time: they may have been accepted only
  // because their corrupt message was the first one.
  void follow_events();
  void insert(std::size_t group, Snapshot snapshot);
  bool active(std::int64_t contact_id, SimTime t) const;
  SampleStatus status(const std::deque<Snapshot>& group, SimTime t) const;
  struct Candidate {  // for the state at an instant
    contact_t contact;
    std::int64_t seq = 0;
    bool present = false;  // in a snapshot at or before that instant; else only in a later one
  };
  void append_state(std::size_t group, SimTime t, std::vector<Candidate>& out) const;
  bool predicted_only(std::size_t group, std::deque<Snapshot>::const_iterator snapshot, std::int64_t id) const;
  static void keep_last_published(std::vector<Candidate>& list);

  std::unique_ptr<EventInbox> own_events_;  // null: the events are shared
  EventInbox& events_;
  std::int64_t epoch_ = 0;  // of events_, as of the snapshots
  std::int64_t refused_ = 0;

  using Pages = PageAssembler<Page, SimTime>;
  std::array<Pages, kGroups> partial_;
  std::deque<Snapshot> snapshots_[kGroups];  // in order of time
  std::size_t contact_counts_[kGroups] = {};
  Nanoseconds span_ = kSpan;
};

}  // namespace tactus::sync
