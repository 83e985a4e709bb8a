#include "visual_node/frame/room_clock_reader.h"

#include <catch2/catch.hpp>
#include <random>
#include <tactus/clock_map_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/sim_clock_t.hpp>

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {

constexpr std::int64_t kReaderRun = 3, kHour_ns = 3'600'000'000'000;
constexpr std::int32_t kSim = 11, kOwn = 22, kThird = 33;

header_t stamp(std::int64_t sent_ns, std::int32_t clock = kSim, std::int64_t incarnation = 9) {
  header_t h{};
  h.publish_time_ns = sent_ns, h.clock = clock, h.run_id = kReaderRun, h.incarnation = incarnation;
  return h;
}
sim_clock_t map_of(std::int64_t sim_ns, std::int64_t host_ns, double rate = 1) {
  sim_clock_t c{};
  c.sim_ns = sim_ns, c.host_ns = host_ns, c.rate = rate;
  return c;
}
// of_clock = to_clock + offset.
clock_map_t between(std::int32_t of, std::int32_t to, std::int64_t offset_ns, double drift = 0) {
  clock_map_t m{};
  m.header = stamp(0, to, of * 1000 + to);
  m.of_clock = of, m.to_clock = to, m.offset_ns = offset_ns, m.drift = drift, m.uncertainty_ns = 20'000;
  m.at_ns = 10'000'000'000;
  return m;
}

}  // namespace

TEST_CASE("On the host of sim_node the room clock is the host clock") {
  RoomClockReader reader({kReaderRun, kSim});
  CHECK_FALSE(reader.known());
  reader.on_message(stamp(5'000'000'000), map_of(1, 5'000'000'000), sync::host_time(5'000'300'000));
  const sync::HostTime now = sync::host_time(6'000'000'000);
  CHECK(reader.mapped(now));
  CHECK(sync::to_ns(reader.to_room(now, now)) == 6'000'000'000);
  CHECK(reader.to_host(room_time(123), now) == sync::host_time(123));
}

TEST_CASE("On another host the room clock is mapped in both directions, exact to 3 ns") {
  std::mt19937_64 random(8);
  for (int trial = 0; trial < 200; ++trial) {
    const std::int64_t ahead = static_cast<std::int64_t>(random() % (2 * kHour_ns)) - kHour_ns;
    const double drift = (static_cast<double>(random() % 2001) - 1000) * 1e-7;  // +-100 ppm
    sync::ClockMaps maps(kReaderRun);
    const bool other_way = trial % 2;
    maps.observe(other_way ? between(kOwn, kSim, -ahead, drift) : between(kSim, kOwn, ahead, drift), {});
    RoomClockReader reader({kReaderRun, kOwn, &maps});
    const std::int64_t sent = 2 * kHour_ns + ahead;
    reader.on_message(stamp(sent), map_of(1, sent), sync::host_time(2 * kHour_ns + 2'000'000'000));
    const sync::HostTime now = sync::host_time(2 * kHour_ns + 2'100'000'000);
    INFO(ahead << " ns, " << drift);
    REQUIRE(reader.mapped(now));
    const RoomTime room = reader.to_room(now, now);
    // Two roundings of the map and one of the search.
    CHECK(std::abs((reader.to_host(room, now) - now).count()) <= 3);
    // The drift counts from at_ns, at most two hours ago: 100 ppm of that.
    CHECK(std::abs(sync::to_ns(room) - (sync::to_ns(now) + ahead)) <= 1e-4 * 3 * kHour_ns);
  }
}

TEST_CASE("A clock without a map is read by arrival and reported") {
  RoomClockReader reader({kReaderRun, kOwn});
  for (int i = 0; i < 100; ++i)
    reader.on_message(stamp(kHour_ns + i * 1'000'000), map_of(i, kHour_ns + i * 1'000'000),
                sync::host_time(i * 1'000'000 + 200'000 + (i * 7919) % 500'000));
  const sync::HostTime now = sync::host_time(100'000'000);
  CHECK_FALSE(reader.mapped(now));
  // Accurate to the smallest latency, here 0.2 ms, and the drift of two quartz clocks in 0.1 s.
  CHECK(std::abs(sync::to_ns(reader.to_room(now, now)) - (kHour_ns + 100'000'000)) <= 200'000 + 100'000);
}

TEST_CASE("The map at a time does not depend on later maps or the order of arrival") {
  std::mt19937 random(5);
  std::vector<int> order(200);
  for (int i = 0; i < 200; ++i) order[static_cast<std::size_t>(i)] = i;
  RoomClockReader straight({kReaderRun, kSim}), shuffled({kReaderRun, kSim});
  const auto on_message = [](RoomClockReader& reader, int i, int arrival_ms) {
    const std::int64_t sent = 1'000'000'000 + i * 5'000'000;
    reader.on_message(stamp(sent), map_of(i * 5'000'000, sent, 1 + 1e-6 * i),
                sync::host_time(sent) + milliseconds(arrival_ms));
  };
  for (const int i : order) on_message(straight, i, 0);
  for (std::size_t i = 0; i + 4 <= order.size(); i += 4)  // pages overtake each other by a few
    std::shuffle(order.begin() + static_cast<std::ptrdiff_t>(i),
                 order.begin() + static_cast<std::ptrdiff_t>(i) + 4, random);
  for (const int i : order) on_message(shuffled, i, 20);
  for (std::int64_t t = 1'000'000'000; t < 1'995'000'000; t += 777'777) {
    const sim_clock_t a = straight.published_by(room_time(t)), b = shuffled.published_by(room_time(t));
    REQUIRE(a.sim_ns == b.sim_ns);
    REQUIRE(a.rate == b.rate);
    REQUIRE(a.host_ns <= t);
    REQUIRE(t - a.host_ns < 5'000'000);
  }
  CHECK(straight.published_by(room_time(5)).sim_ns == 0);  // before the first map: the first one
}

TEST_CASE("A stamp of a third host is mapped, or read by arrival without a map") {
  sync::ClockMaps maps(kReaderRun);
  maps.observe(between(kSim, kOwn, kHour_ns), {});
  maps.observe(between(kThird, kSim, 5'000'000'000), {});
  RoomClockReader reader({kReaderRun, kOwn, &maps});
  reader.on_message(stamp(kHour_ns + 7), map_of(1, 7), sync::host_time(1'000'007));
  // The map is rounded twice.
  CHECK(std::abs(sync::to_ns(reader.sent(stamp(kHour_ns + 5'000'000'000, kThird), sync::host_time(1))) -
                 kHour_ns) <= 2);
  CHECK(reader.sent(stamp(kHour_ns + 99, kSim), sync::host_time(1)) == room_time(kHour_ns + 99));
  CHECK(std::abs(sync::to_ns(reader.sent(stamp(4711, 44), sync::host_time(2'000'000))) - (kHour_ns + 2'000'000)) <=
        3);
}

TEST_CASE("Another simulation on the same host keeps the clock, and one on another host changes it") {
  RoomClockReader reader({kReaderRun, kSim});
  reader.on_message(stamp(1'000'000'000), map_of(1, 1'000'000'000), sync::host_time(1'000'000'000));
  CHECK(reader.clocks() == 1);
  reader.on_message(stamp(2'000'000'000, kSim, 10), map_of(0, 2'000'000'000), sync::host_time(2'000'000'000));
  CHECK(reader.clocks() == 1);
  CHECK(reader.published_by(room_time(1'500'000'000)).sim_ns == 0);  // the maps of the first simulation are gone
  reader.on_message(stamp(9'000'000'000, kThird, 12), map_of(0, 9'000'000'000), sync::host_time(3'000'000'000));
  CHECK(reader.clocks() == 2);
}

TEST_CASE("The number of maps is limited") {
  RoomClockReader reader({kReaderRun, kSim});
  for (int i = 0; i < 100'000; ++i)
    reader.on_message(stamp(1'000'000'000 + i * 1000), map_of(i, 1'000'000'000 + i * 1000),
                sync::host_time(1'000'000'000 + i * 1000));
  CHECK(reader.published_by(room_time(0)).sim_ns == 100'000 - static_cast<int>(RoomClockReader::kMaps));
}
