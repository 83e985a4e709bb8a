// Tests of contacts that move between the bodies of the current step and those that are computed ahead, over a wire that loses, repeats
// and reorders.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>

#include "sync/resampling/contact_stream.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

struct Frame {
  std::int64_t now_ms = 0, time_ms = 0, seq = 0;
  std::int8_t group = 0;
  std::set<std::int64_t> ids;
};

template <class Message>
Message stamped(std::int64_t now_ms, std::int64_t time_ms, std::int64_t seq) {
  Message m{};
  m.header.sim_time_ns = time_ms * kMs;
  m.header.publish_time_ns = (now_ms + 1'000) * kMs + seq;
  m.header.run_id = m.header.incarnation = 1;
  m.header.seq = seq;
  m.clock = {now_ms * kMs, (now_ms + 1'000) * kMs, 1};
  m.pages = 1;
  return m;
}

contact_frame_t message(const Frame& f) {
  auto m = stamped<contact_frame_t>(f.now_ms, f.time_ms, f.seq);
  m.group = f.group;
  for (const std::int64_t id : f.ids) {
    contact_t c{};
    c.contact_id = id;
    c.tool = -1;
    c.normal_force_N = static_cast<float>(f.seq);  // the sequence number of its frame
    m.contacts.push_back(c);
  }
  m.count = static_cast<int>(m.contacts.size());
  return m;
}

contact_events_t begins(std::int64_t contacts) {
  auto m = stamped<contact_events_t>(0, 0, 0);
  for (std::int64_t id = 0; id < contacts; ++id) {
    contact_event_t e{};
    e.event_id = e.contact_id = id;
    m.events.push_back(e);
  }
  m.count = static_cast<int>(m.events.size());
  return m;
}

// Received snapshots around t: the newest at or before t, and the next one after it.
using ByTime = std::map<std::int64_t, const Frame*>;
const Frame* before(const ByTime& frames, std::int64_t t) {
  const auto after = frames.upper_bound(t);
  return after == frames.begin() ? nullptr : std::prev(after)->second;
}
const Frame* after(const ByTime& frames, std::int64_t t) {
  const auto it = frames.upper_bound(t);
  return it == frames.end() || it == frames.begin() ? nullptr : it->second;
}

}  // namespace

TEST_CASE("A contact that moves between groups has one state, the newest, for any loss and reordering") {
  int moved = 0, compared = 0;
  constexpr std::int64_t kContacts = 6;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::set<std::int64_t> ahead;
    std::vector<Frame> published;
    for (std::int64_t now = 0, seq = 1; now < 300; ++now) {
      for (std::int64_t id = 0; id < kContacts; ++id) moved += random() % 30 == 0 && ahead.erase(id) > 0;
      if (now % 17 != 0) continue;
      for (std::int64_t id = 0; id < kContacts; ++id)
        if (random() % 2 == 0) ahead.insert(id);
      Frame other{now, now, seq + 1, contact_frame_t::OTHER, {}};
      for (std::int64_t id = 0; id < kContacts; ++id)
        if (!ahead.contains(id)) other.ids.insert(id);
      published.push_back({now, now + 17, seq, contact_frame_t::AHEAD, ahead});
      published.push_back(other);
      seq += 2;
    }
    const unsigned loss = random() % 40, jitter_ms = 1 + random() % 60;
    std::multimap<std::int64_t, const Frame*> wire;
    for (const Frame& f : published)
      for (int copies = random() % 100 < loss ? 0 : random() % 4 == 0 ? 2 : 1; copies > 0; --copies)
        wire.emplace(f.now_ms * kMs + static_cast<std::int64_t>(random() % (jitter_ms * kMs)), &f);
    ContactStream stream(1);
    stream.push(begins(kContacts), host_time(1'000 * kMs));
    ByTime came[3];
    for (const auto& [arrival, frame] : wire) {
      stream.push(message(*frame), host_time(arrival + 1'000 * kMs));
      came[frame->group][frame->time_ms] = frame;
      for (const std::int64_t t : {frame->time_ms - 17, frame->time_ms - 3, frame->time_ms, frame->time_ms + 5}) {
        std::map<std::int64_t, float> wanted;  // the source snapshot, where it is not interpolated with a later one
        for (std::int64_t id = 0; id < kContacts; ++id) {
          std::pair<int, std::int64_t> best{-1, -1};
          bool mixed = false;
          for (const std::int8_t group : {contact_frame_t::OTHER, contact_frame_t::AHEAD}) {
            const Frame *b = before(came[group], t), *a = after(came[group], t);
            if (!b) continue;
            const bool in_b = b->ids.contains(id), in_a = a && a->ids.contains(id);
            const std::pair<int, std::int64_t> mine = in_b   ? std::pair(1, b->seq)
                                                      : in_a ? std::pair(0, a->seq)
                                                             : best;
            if (mine <= best) continue;
            best = mine;
            mixed = in_b && in_a && b->time_ms != t;
          }
          if (best.first >= 0) wanted[id] = mixed ? -1.0f : static_cast<float>(best.second);
        }
        std::map<std::int64_t, float> got;
        for (const contact_t& c : stream.state_at(sim_time(t * kMs)).value)
          REQUIRE(got.emplace(c.contact_id, c.normal_force_N).second);
        REQUIRE(got.size() == wanted.size());
        for (const auto& [id, force] : wanted) {
          REQUIRE(got.contains(id));
          if (force >= 0) REQUIRE(got[id] == force);
          ++compared;
        }
      }
    }
    REQUIRE(stream.refused() == 0);
  }
  CHECK(moved > 500);
  CHECK(compared > 50'000);
}

TEST_CASE("A predicted contact counts from its begin event on, and not without one") {
  ContactStream stream(1);
  std::int64_t seq = 0;
  const auto publish = [&](std::int64_t now, std::int64_t time, std::set<std::int64_t> ids) {
    stream.push(message({now, time, seq++, contact_frame_t::AHEAD, std::move(ids)}),
                host_time((now + 1'000) * kMs));
  };
  const auto ids_at = [&](std::int64_t ms) {
    std::set<std::int64_t> ids;
    for (const contact_t& c : stream.state_at(sim_time(ms * kMs)).value) ids.insert(c.contact_id);
    return ids;
  };
  stream.push(begins(1), host_time(1'000 * kMs));
  publish(0, 17, {0});
  publish(17, 34, {0, 5});  // 5 begins at 25, unless an intermediate snapshot arrives
  CHECK(ids_at(20) == std::set<std::int64_t>{0});
  CHECK(ids_at(34) == std::set<std::int64_t>{0});
  SECTION("the predicted contact does not happen") {
    publish(34, 51, {0});
    CHECK(ids_at(40) == std::set<std::int64_t>{0});
    CHECK(ids_at(51) == std::set<std::int64_t>{0});
  }
  SECTION("the predicted contact begins") {
    auto m = stamped<contact_events_t>(26, 26, 0);
    contact_event_t e{};
    e.event_id = 77, e.contact_id = 5, e.time_ns = 25 * kMs;
    m.events = {e};
    m.count = 1;
    stream.push(m, host_time(1'026 * kMs));
    CHECK(ids_at(24) == std::set<std::int64_t>{0});
    CHECK(ids_at(25) == std::set<std::int64_t>{0, 5});
    CHECK(ids_at(34) == std::set<std::int64_t>{0, 5});
  }
  SECTION("the begin event is lost, and a later snapshot repeats the contact") {
    publish(34, 51, {0, 5});
    CHECK(ids_at(51) == std::set<std::int64_t>{0, 5});
  }
}
