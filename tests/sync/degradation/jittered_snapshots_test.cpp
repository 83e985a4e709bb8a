// Tests of jitter on streams of snapshots and on events: the instants of their presentation, and the order of their release.
#include <malloc.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <climits>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/degradation/degraded_snapshots.h"
#include "sync/resampling/event_inbox.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::kMs;

namespace {

OperatorChain chain_of(const std::string& attributes) {
  return OperatorChain(parse_profile("<profile><degrade modality=\"a\" " + attributes + "/></profile>", "p.xml"), "a", {});
}

header_t header_at(std::int64_t t_ns, std::int64_t seq) {
  header_t h{};
  h.run_id = h.incarnation = 1;
  h.sim_time_ns = h.publish_time_ns = t_ns;
  h.seq = seq;
  return h;
}

template <class Message>
Message page_at(std::int64_t ms, int page = 0, int pages = 1) {
  Message m{};
  m.header = header_at(ms * kMs, ms * pages + page);
  m.clock = {ms * kMs, ms * kMs, 1};
  m.page = static_cast<decltype(m.page)>(page);
  m.pages = static_cast<decltype(m.pages)>(pages);
  return m;
}

}  // namespace

TEST_CASE("The jitter of a presentation delay moves each snapshot to the instant at which it is presented") {
  OperatorChain chain = chain_of("delay=\"40ms\" jitter=\"10ms normal\"");
  DegradedSnapshots<contact_frame_t> frames;
  double square = 0;
  int n = 0;
  for (std::int64_t ms = 0; ms < 100'000; ++ms) {
    if (ms >= 1000 && ms % 100 == 0) frames.push(page_at<contact_frame_t>(ms), host_time(ms * kMs), chain, nullptr);
    while (const auto m = frames.pop(host_time(ms * kMs))) {
      // The renderer shows the state of ms - 40: just now the instant of this snapshot, for any jitter.
      CHECK(std::abs(static_cast<double>(m->first.header.sim_time_ns) * 1e-6 - static_cast<double>(ms - 40)) <= 1);
      const double shift_ms = static_cast<double>(m->first.header.sim_time_ns) * 1e-6 - 100 * std::round(static_cast<double>(m->first.header.sim_time_ns) * 1e-8);
      square += shift_ms * shift_ms;
      ++n;
    }
  }
  CHECK(n >= 989);
  CHECK(std::sqrt(square / n) == Approx(10).epsilon(4.5 / std::sqrt(2.0 * n)));
}

TEST_CASE("In a servo loop a presentation delay with jitter holds each model back, and changes no instant") {
  OperatorChain chain = chain_of("delay=\"9ms\" jitter=\"3ms normal order=free\"");
  DegradedSnapshots<touch_model_t> models;
  models.present_on_release();
  double sum_ms = 0, square = 0;
  int n = 0;
  for (std::int64_t us = 0; us < 20'000'000; us += 50) {
    const std::int64_t t_ns = us * 1000;
    if (us % 1000 == 0) models.push(page_at<touch_model_t>(us / 1000), host_time(t_ns), chain, nullptr);
    while (const auto m = models.pop(host_time(t_ns) - chain.presentation_delay(sim_time(t_ns)))) {
      REQUIRE(m->first.header.sim_time_ns % kMs == 0);
      const double held_ms = static_cast<double>(t_ns - m->first.header.sim_time_ns) * 1e-6;
      REQUIRE(held_ms >= 0);
      sum_ms += held_ms, square += held_ms * held_ms, ++n;
    }
  }
  CHECK(n > 19'900);
  const double mean_ms = sum_ms / n;
  CHECK(mean_ms == Approx(9).margin(4.5 * 3 / std::sqrt(n) + 0.05));  // a tick of 50 us
  CHECK(std::sqrt(square / n - mean_ms * mean_ms) == Approx(3).epsilon(0.03));
}

TEST_CASE("An overtaken snapshot is dropped with all of its pages, and is recorded once") {
  OperatorChain chain = chain_of("delay=\"9ms network\" jitter=\"3ms normal\"");
  DegradedSnapshots<contact_frame_t> frames;
  Decisions decisions;
  std::map<std::int64_t, int> pages;
  std::int64_t newest = -1;
  for (std::int64_t ms = 0; ms < 2100; ++ms) {
    for (int page = 0; ms < 2000 && page < 3; ++page) frames.push(page_at<contact_frame_t>(ms, page, 3), host_time(ms * kMs), chain, &decisions);
    if (ms >= 2050) frames.push(page_at<contact_frame_t>(ms), host_time(ms * kMs), chain, &decisions);  // takes the records
    while (const auto m = frames.pop(host_time(ms * kMs))) {
      CHECK(m->first.header.sim_time_ns >= newest);
      newest = m->first.header.sim_time_ns;
      ++pages[newest / kMs];
    }
  }
  std::set<std::int64_t> overtaken;
  for (const DecisionRecord& d : decisions)
    if (d.decision.why == DropReason::kOvertaken) CHECK(overtaken.insert(to_ns(d.time) / kMs).second);
  CHECK(overtaken.size() > 1000);
  for (std::int64_t ms = 0; ms < 2000; ++ms) {
    CAPTURE(ms);
    CHECK(pages[ms] == (overtaken.contains(ms) ? 0 : 3));
  }
}

TEST_CASE("An overtaken snapshot of poses is released for an instant before that of the newer one") {
  const bool presentation = GENERATE(true, false);
  OperatorChain chain = chain_of(presentation ? "delay=\"60ms\" jitter=\"20ms normal\"" : "delay=\"60ms network\" jitter=\"20ms normal\"");
  DegradedSnapshots<world_state_t> poses;
  std::set<std::int32_t> bodies;
  std::int64_t newest_ns = -1;
  std::int32_t newest_body = -1;
  for (std::int64_t ms = 0; ms < 5000; ++ms) {
    if (ms % 16 == 0 && ms >= 160 && ms < 4800) {
      world_state_t m = page_at<world_state_t>(ms);
      m.bodies.resize(1);  // only this body moves: no other snapshot contains its pose
      m.bodies[0].body = static_cast<std::int32_t>(ms / 16);
      m.count = 1;
      poses.push(m, host_time(ms * kMs), chain, nullptr);
    }
    while (const auto m = poses.pop(host_time(ms * kMs))) {
      const std::int32_t body = m->first.bodies.at(0).body;
      CHECK(bodies.insert(body).second);
      if (body > newest_body)
        newest_body = body, newest_ns = m->first.header.sim_time_ns;
      else
        CHECK(m->first.header.sim_time_ns < newest_ns);
    }
  }
  CHECK(bodies.size() == 290);
}

TEST_CASE("The jitter of a presentation delay shifts each event, and no contact ends before it begins") {
  OperatorChain chain = chain_of("delay=\"40ms\" jitter=\"10ms normal\"");
  EventInbox inbox(1);
  std::map<std::int64_t, std::int64_t> begins_ns;
  for (std::int64_t i = 0; i < 2000; ++i) {
    const std::int64_t t_ns = (100 + 20 * i) * kMs;
    contact_events_t m{};
    m.header = header_at(t_ns + 2 * kMs, i);
    m.clock = {m.header.sim_time_ns, m.header.publish_time_ns, 1};
    m.pages = 1;
    for (const std::int8_t kind : {contact_event_t::BEGIN, contact_event_t::END}) {
      contact_event_t e{};
      e.event_id = 2 * i + (kind == contact_event_t::END);
      e.contact_id = i;
      e.kind = kind;
      e.time_ns = t_ns + (kind == contact_event_t::END ? kMs : 0);
      m.events.push_back(e);
    }
    m.count = 2;
    inbox.push(m, host_time(m.header.publish_time_ns), chain, nullptr);
    inbox.release(host_time(m.header.publish_time_ns));
    for (const contact_event_t& e : inbox.take(SimTime::max())) {
      if (e.kind == contact_event_t::BEGIN) {
        begins_ns[e.contact_id] = e.time_ns;
        const std::int64_t happened_ns = (100 + 20 * e.contact_id) * kMs;
        CHECK(e.time_ns - happened_ns == inbox.shift_of(e.event_id).count());
      } else {
        REQUIRE(begins_ns.contains(e.contact_id));
        CHECK(e.time_ns >= begins_ns[e.contact_id]);
      }
    }
    const ContactSpan* span = inbox.span_of(i);
    REQUIRE(span);
    CHECK(to_ns(*span->end) >= span->begin->time_ns);
  }
  CHECK(begins_ns.size() == 2000);
}

TEST_CASE("Forged pages do not make a deadband store messages without end") {
  OperatorChain chain = chain_of("deadband=\"10% velocity\"");
  DegradedSnapshots<world_state_t> poses;
  std::mt19937 random(3);
  const int count = GENERATE(INT_MAX, 1 << 20, kMaxWorldPages);
  const auto forge = [&](int n) {
    for (int i = 0; i < n; ++i) {
      world_state_t m{};
      m.header = header_at(static_cast<std::int64_t>(random() % 1000) * kMs, i);
      m.page = static_cast<std::int32_t>(random()) & INT_MAX;
      m.pages = count;
      if (count == kMaxWorldPages) m.page %= count;
      m.bodies.resize(18);
      m.count = 18;
      poses.push(m, host_time(i), chain, nullptr);
      while (poses.pop(HostTime::max())) {
      }
    }
  };
  forge(20'000);
  const std::size_t before = mallinfo2().uordblks;
  forge(100'000);
  const std::size_t after = mallinfo2().uordblks;
  CHECK(after < before + (1 << 20));  // the same within 1 MiB; each page has 2 kB
}
