#include "sim_node/publish/publisher.h"

#include <catch2/catch.hpp>
#include <iostream>
#include <map>
#include <set>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>
#include <unordered_map>

#include "sync/bus/bus.h"
#include "sync/resampling/contact_stream.h"

using namespace tactus;
using namespace tactus::sim;

namespace {

// A sender and a receiver in this process.
struct Wire {
  sync::Bus bus{sync::Identity{"sim_node", 1, 99, 1}, {.memory = true}};
  sync::Queue<touch_model_t>& touch = bus.queue<touch_model_t>(channels::kTouchModel, 100000);
  sync::Queue<contact_events_t>& events = bus.queue<contact_events_t>(channels::kContactEvents, 100000);
  sync::Queue<contact_frame_t>& contacts = bus.queue<contact_frame_t>(channels::kContacts, 100000);
  sync::Queue<world_state_t>& world = bus.queue<world_state_t>(channels::kWorldState, 100000);
};

contact_t contact(int i, int points) {
  contact_t c{};
  c.contact_id = i + 1;
  c.body_b = 1;
  c.material_a = c.material_b = c.tool = -1;
  c.normal.z = 1;
  c.point_count = static_cast<std::int8_t>(points);
  c.points.resize(static_cast<std::size_t>(points));
  return c;
}

contact_event_t event(std::int64_t id, std::int64_t time_ns) {
  contact_event_t e{};
  e.event_id = id;
  e.contact_id = 1;
  e.time_ns = time_ns;
  e.body_b = 1;
  e.material_a = e.material_b = e.tool = -1;
  e.normal.z = 1;
  e.effective_mass_kg = 1;
  return e;
}

std::vector<BodyMotion> moving(std::size_t count) {
  std::vector<BodyMotion> bodies(count);
  for (BodyMotion& b : bodies) b.velocity_m_s = {1, 0, 0};
  return bodies;
}

}  // namespace

TEST_CASE("3,000 bodies and 2,000 contacts are published without a lost page within the budget") {
  Wire wire;
  Publisher publisher(wire.bus, 60, 2000, 4, sync::Nanoseconds(1'000'000));
  const std::vector<BodyMotion> bodies = moving(3000);
  std::vector<touch_model_t> models(1);
  const std::vector<contact_event_t> none;
  const std::vector<contact_t> tool;
  const auto contacts = [](std::vector<contact_t>& out) {
    out.clear();
    for (int i = 0; i < 2000; ++i) out.push_back(contact(i, 1 + i % 4));
  };
  constexpr int kTicks = 3000;
  double bytes = 0, datagrams = 0;
  std::map<std::int64_t, std::set<int>> world_pages, contact_pages;
  std::map<std::int64_t, std::unordered_map<int, int>> seen_bodies, seen_contacts;
  std::map<std::int64_t, int> world_of, contacts_of;
  float rate = 0;
  int wrong = 0, largest = 0, max_slow = 0;
  for (int i = 0; i < kTicks; ++i) {
    const sync::SimTime now = sync::sim_time(i * std::int64_t{1'000'000});
    publisher.publish({now, &models, &none, &tool, {bodies, contacts}}, {now, sync::host_time(5'000'000'000 + i * std::int64_t{1'000'000}), 1});
    wire.bus.drain(sync::host_time(5'000'000'000 + i * std::int64_t{1'000'000}));
    int slow = 0;
    const auto count = [&](const auto& m) {
      bytes += m.getEncodedSize();
      ++datagrams;
      largest = std::max(largest, m.getEncodedSize());
      wrong += m.clock.sim_ns != sync::to_ns(now);
    };
    while (const auto m = wire.world.pop()) {
      count(m->message);
      ++slow;
      rate = m->message.rate_Hz;
      world_of[m->message.header.sim_time_ns] = m->message.pages;
      wrong += !world_pages[m->message.header.sim_time_ns].insert(m->message.page).second;
      for (const body_state_t& b : m->message.bodies) ++seen_bodies[m->message.header.sim_time_ns][b.body];
    }
    while (const auto m = wire.contacts.pop()) {
      count(m->message);
      if (m->message.group == contact_frame_t::TOOL) continue;
      ++slow;
      contacts_of[m->message.header.sim_time_ns] = m->message.pages;
      wrong += !contact_pages[m->message.header.sim_time_ns].insert(m->message.page).second;
      for (const contact_t& c : m->message.contacts) ++seen_contacts[m->message.header.sim_time_ns][static_cast<int>(c.contact_id)];
    }
    while (const auto m = wire.touch.pop()) count(m->message);
    max_slow = std::max(max_slow, slow);
  }
  CHECK(wrong == 0);
  CHECK(max_slow <= 2);
  CHECK(largest <= static_cast<int>(channels::kMaxMessageBytes));
  CHECK(wire.bus.refused() == 0);
  for (const auto* inbox : {static_cast<sync::InboxBase*>(&wire.world), static_cast<sync::InboxBase*>(&wire.contacts)}) {
    CHECK(inbox->count().sequence.gaps() == 0);
    CHECK(inbox->count().bad == 0);
  }
  // Every snapshot is complete, except those in progress at the end.
  std::size_t whole_worlds = 0, whole_contacts = 0;
  for (const auto& [time, pages] : world_pages)
    if (static_cast<int>(pages.size()) == world_of[time]) {
      ++whole_worlds;
      CHECK(seen_bodies[time].size() == 3000);
    }
  for (const auto& [time, pages] : contact_pages)
    if (static_cast<int>(pages.size()) == contacts_of[time]) {
      ++whole_contacts;
      CHECK(seen_contacts[time].size() == 2000);
    }
  CHECK(whole_worlds + 1 >= world_pages.size());
  CHECK(whole_contacts + 1 >= contact_pages.size());
  const double seconds = kTicks * 1e-3;
  CHECK(rate == Approx(static_cast<double>(whole_worlds) / seconds).epsilon(0.1));
  std::cout << "3000 bodies, 2000 contacts: " << bytes / seconds / 1e6 << " MB/s in " << datagrams / seconds
            << " datagrams/s; world " << whole_worlds / seconds << " Hz (published " << rate << "), contacts "
            << whole_contacts / seconds << " Hz\n";
}

TEST_CASE("Each step publishes touch models, events and tool contacts before the slow state") {
  Wire wire;
  Publisher publisher(wire.bus, 60, 2000, 4, sync::Nanoseconds(1'000'000));
  const std::vector<BodyMotion> bodies = moving(3);
  std::vector<touch_model_t> models(2);
  const std::vector<contact_event_t> events{event(5, 0)};
  const std::vector<contact_t> tool{contact(0, 1)};
  publisher.publish({sync::sim_time(0), &models, &events, &tool, {bodies, [](auto& out) { out.clear(); }}}, {});
  wire.bus.drain(sync::host_time(1));
  std::vector<std::pair<std::int64_t, std::string>> order;
  const auto note = [&](auto& queue, const char* name) {
    while (const auto m = queue.pop()) order.emplace_back(m->message.header.publish_time_ns, name);
  };
  note(wire.touch, "touch");
  note(wire.events, "events");
  note(wire.contacts, "contacts");
  note(wire.world, "world");
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string all;
  for (const auto& [time, name] : order) all += name + " ";
  // The tool's contacts, then world and contacts between bodies alternately.
  CHECK(all == "touch touch events contacts world contacts ");
}

TEST_CASE("Every event is repeated for 50 ms, and many events at once lose none") {
  EventRepeater repeater(5);
  std::map<std::int64_t, int> sent;
  std::int64_t id = 0;
  const int per_step = GENERATE(1, 20, 60);
  for (int i = 0; i < 400; ++i) {
    std::vector<contact_event_t> fresh;
    for (int k = 0; i < 300 && k < per_step; ++k) fresh.push_back(event(id++, i * std::int64_t{1'000'000}));
    repeater.add(fresh, sync::sim_time(i * std::int64_t{1'000'000}));
    const auto& due = repeater.due(sync::sim_time(i * std::int64_t{1'000'000}));
    CHECK(due.size() <= 5 * EventRepeater::kPerPage);
    std::set<std::int64_t> unique;
    for (const auto& e : due) {
      CHECK(unique.insert(e.event_id).second);
      ++sent[e.event_id];
    }
  }
  CHECK(sent.size() == static_cast<std::size_t>(id));
  CHECK(repeater.overflow() == 0);
  if (per_step == 1)
    for (const auto& [event_id, times] : sent) CHECK(times == 50);
}

TEST_CASE("Moving bodies are published at the rate, resting ones once a second and for a new receiver") {
  Snapshots snapshots(60, 2000, sync::Nanoseconds(1'000'000));
  std::vector<BodyMotion> bodies(40);
  bodies[7].velocity_m_s = {0.5, 0, 0};
  std::map<std::int64_t, std::vector<body_state_t>> published;
  std::map<std::int64_t, int> full;
  int tick = 0;
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i, ++tick) {
      if (bodies[7].velocity_m_s.x() > 0) bodies[7].position_m.x() += 0.0005;
      snapshots.tick(sync::sim_time(tick * std::int64_t{1'000'000}), sync::sim_time(tick * std::int64_t{1'000'000}), {bodies, [](auto& out) { out.clear(); }}, [](contact_frame_t&) {},
                     [&](world_state_t& m) {
                       full[m.header.sim_time_ns] = m.full;
                       auto& list = published[m.header.sim_time_ns];
                       list.insert(list.end(), m.bodies.begin(), m.bodies.end());
                     });
    }
  };
  run(500);
  int all = 0;
  for (const auto& [time, list] : published) {
    if (full[time]) {
      ++all;
      CHECK(list.size() == 40);
    } else {
      REQUIRE(list.size() == 1);
      CHECK(list[0].body == 7);
    }
  }
  CHECK(all == 1);
  bodies[7].velocity_m_s.setZero();
  published.clear();
  run(200);
  int times_published = 0;
  for (const auto& [time, list] : published) times_published += static_cast<int>(list.size());
  // The final pose, and the state of rest.
  CHECK(times_published >= 1);
  CHECK(times_published <= 2);
  CHECK(published.begin()->second.back().velocity_m_s.x == 0);
  published.clear();
  snapshots.request_full();
  run(30);
  CHECK(published.begin()->second.size() == 40);
  published.clear();
  full.clear();
  run(2000);
  int fulls = 0;
  for (const auto& [time, is_full] : full) fulls += is_full;
  CHECK(fulls == 2);
}

TEST_CASE("A paused world is published at the usual rate without old events") {
  Wire wire;
  Publisher publisher(wire.bus, 60, 2000, 4, sync::Nanoseconds(1'000'000));
  const std::vector<BodyMotion> bodies(20);
  std::vector<touch_model_t> models(1);
  const std::vector<contact_t> tool;
  const auto contacts = [](std::vector<contact_t>& out) { out.assign(1, contact(1, 1)); };
  const auto publish = [&](std::int64_t time_ns, const std::vector<contact_event_t>& events) {
    publisher.publish({.time = sync::sim_time(time_ns), .touch_models = &models, .events = &events, .tool_contacts = &tool,
                       .state = {bodies, contacts}},
                      {});
  };
  for (int i = 0; i < 500; ++i) publish(i * std::int64_t{1'000'000}, {});
  publish(500'000'000, {event(7, 499'500'000)});
  wire.bus.drain({});
  const auto count = [&](auto& queue) {
    int n = 0;
    while (queue.pop()) ++n;
    return n;
  };
  for (const auto& forget : {count(wire.touch), count(wire.world), count(wire.contacts), count(wire.events)}) (void)forget;
  for (int i = 0; i < 2000; ++i) publish(500'000'000, {});
  wire.bus.drain({});
  CHECK(count(wire.touch) == 2000);
  CHECK(count(wire.events) <= 50);
  CHECK(count(wire.contacts) >= 2000 + 110);  // the tool's in each tick, the others 60 times a second
  std::int64_t full = 0, snapshots = 0;
  while (const auto m = wire.world.pop()) {
    full += m->message.full && m->message.page == 0;
    snapshots += m->message.page == 0;
    CHECK(m->message.header.sim_time_ns == 500'000'000);
  }
  CHECK(snapshots >= 115);
  CHECK(full >= 1);
}
