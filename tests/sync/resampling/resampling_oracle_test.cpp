// Contact streams and poses as a renderer resamples them, against a reference of all received data and against the truth.
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/resampling/body_history.h"
#include "sync/resampling/contact_stream.h"
#include "tests/sync/resampling/resampling_reference.h"

using namespace tactus;
using namespace tactus::sync;
using namespace tactus::hostile;

namespace {

enum class Clock { kSame, kMapped, kByArrival };

// Number of comparisons of each kind, so that a test without comparisons fails.
struct Tally {
  std::int64_t events = 0, states = 0, interpolated = 0, integrals = 0, true_integrals = 0, poses = 0,
               restarts = 0;
};

// A renderer: ticks of its own period and delay, on its own clock.
class Renderer {
 public:
  Renderer(World& world, Clock clock, Random& random, Tally& tally)
      : world_(world),
        clock_(clock),
        tally_(tally),
        own_(kRun, clock == Clock::kSame ? kTheirClock : kOurClock, clock == Clock::kMapped ? &maps_ : nullptr),
        stream_(own_),
        bodies_(own_),
        contacts_(world),
        poses_(world) {
    const std::int64_t periods_ns[] = {kMs, 2'666'667, 10 * kMs, 16'666'667, 20 * kMs};
    period_ns_ = periods_ns[random.chance(0.15) ? 0 : random.whole(1, 4)];
    delay_ns_ = random.chance(0.4) ? 0 : random.whole(0, 60) * kMs;
    if (clock == Clock::kMapped) learn_map();
  }

  // The first error, or an empty string.
  std::string run(Random& random) {
    std::size_t next = 0;
    if (world_.packets.empty()) return "";
    std::int64_t now = world_.packets.front().arrival_ns + random.whole(0, period_ns_);
    const std::int64_t end = world_.packets.back().arrival_ns + 100 * kMs;
    for (; now < end; now += period_ns_) {
      for (; next < world_.packets.size() && world_.packets[next].arrival_ns <= now; ++next)
        take(world_.packets[next]);
      tick(now);
      if (!said_.str().empty()) return said_.str();
    }
    check_events(SimTime::max(), "at the end");
    for (const auto& [id, e] : contacts_.known().events)
      if (!got_.contains(id)) said_ << "event " << id << " was never delivered; ";
    return said_.str();
  }

 private:
  void learn_map() {
    clock_map_t m{};
    m.header.run_id = kRun, m.header.incarnation = 1, m.header.clock = kOurClock;
    m.of_clock = kTheirClock, m.to_clock = kOurClock;
    m.offset_ns = world_.clocks.offset_ns, m.drift = world_.clocks.drift;
    // The line is exact wherever it is anchored. A nearby anchor keeps its uncertainty small there.
    m.at_ns = world_.packets.empty() ? 0 : world_.packets.front().arrival_ns;
    m.offset_ns += std::llround(static_cast<double>(m.at_ns) * m.drift);
    m.uncertainty_ns = 1000;
    maps_.observe(m, host_time(m.at_ns));
  }

  void take(const Packet& p) {
    const HostTime arrival = host_time(p.arrival_ns);
    if (const auto* page = std::get_if<world_state_t>(&p.message)) {
      poses_.push(p);
      return bodies_.push(*page, arrival);
    }
    if (!contacts_.heard() || contacts_.life().incarnation < world_.lives[p.life].incarnation) {
      tally_.restarts += contacts_.heard();
      got_.clear();
      begun_ = false;
    }
    contacts_.push(p);
    std::visit(
        [&](const auto& m) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(m)>, world_state_t>) stream_.push(m, arrival);
        },
        p.message);
  }

  void tick(std::int64_t now) {
    const auto map = stream_.map(host_time(now));
    if (!contacts_.heard()) return;
    if (!map) return void(said_ << "there is no map; ");
    check_map(map->to_sim(host_time(now)), now);
    const SimTime until = map->to_sim(host_time(now - delay_ns_));
    check_events(until, "at " + std::to_string(to_ns(until)));
    check_state(until);
    if (begun_ && until > until_ && until - until_ < Nanoseconds(60 * kMs))
      check_integral(to_ns(until_), to_ns(until));
    if (!begun_ || until > until_) until_ = until;
    begun_ = true;
    if (poses_.heard()) check_poses(until);
  }

  // By its own clock: exact. By a map: within its uncertainty. By arrival: late by at most the smallest latency.
  void check_map(SimTime sim_now, std::int64_t now) {
    const std::int64_t life_begin = contacts_.life().begin_ns;
    const long double on_sender =
        clock_ == Clock::kSame
            ? static_cast<long double>(now)
            : now * (1 + static_cast<long double>(world_.clocks.drift)) + world_.clocks.offset_ns;
    const auto ahead = static_cast<double>(to_ns(sim_now) - (on_sender - life_begin));
    // Since the newest message, at most 0.3 s ago, the simulation's time is assumed to run at the rate of the receiver's clock. By
    // arrival, the estimate also relaxes by 200 ppm since its best, half a second ago.
    const double drifted = 100e-6 * 0.3e9;
    const double slack = clock_ == Clock::kByArrival ? drifted + 200e-6 * 0.5e9
                         : clock_ == Clock::kMapped  ? drifted + 1'100
                                                     : 1;
    const double late = clock_ == Clock::kByArrival ? static_cast<double>(contacts_.known().least_latency_ns) : 0;
    if (ahead > slack || ahead < -late - slack) said_ << "the map is " << ahead << " ns ahead of the truth; ";
  }

  void check_events(SimTime until, const std::string& when) {
    const auto wanted = contacts_.take_events(to_ns(until));
    const auto due = stream_.take_events(until);
    std::vector<std::int64_t> ids;
    for (const contact_event_t& e : due) {
      ids.push_back(e.event_id);
      const auto& truth = contacts_.life().events.at(static_cast<std::size_t>(e.event_id & 0xffffffff));
      if (truth.event_id != e.event_id || truth.time_ns != e.time_ns || truth.kind != e.kind)
        said_ << "event " << e.event_id << " was changed; ";
      if (!got_.insert(e.event_id).second) said_ << "event " << e.event_id << " came twice; ";
    }
    tally_.events += static_cast<std::int64_t>(ids.size());
    if (ids != wanted) said_ << ids.size() << " events instead of " << wanted.size() << " " << when << "; ";
  }

  void check_state(SimTime t) {
    const auto state = stream_.state_at(t);
    const auto wanted = contacts_.state(to_ns(t));
    const SampleStatus status = std::max({contacts_.status(0, to_ns(t)), contacts_.status(1, to_ns(t)), contacts_.status(2, to_ns(t))});
    if (state.status != status)
      said_ << "the state at " << to_ns(t) << " is " << to_string(state.status) << " instead of " << to_string(status)
            << "; ";
    if (state.value.size() != wanted.size())
      said_ << state.value.size() << " contacts at " << to_ns(t) << " instead of " << wanted.size() << "; ";
    for (const contact_t& c : state.value) {
      const auto it = wanted.find(c.contact_id);
      if (it == wanted.end())
        said_ << "contact " << c.contact_id << " lives at " << to_ns(t) << "; ";
      else if (std::abs(it->second - c.normal_force_N) > 1e-4f)
        said_ << "contact " << c.contact_id << " presses with " << c.normal_force_N << " instead of " << it->second
              << " N; ";
    }
    ++tally_.states;
    tally_.interpolated += status == SampleStatus::kInterpolated && !wanted.empty();
  }

  void check_integral(std::int64_t t0, std::int64_t t1) {
    const auto got = stream_.integral(sim_time(t0), sim_time(t1), kTool, kToolBody);
    const auto wanted = contacts_.integral(t0, t1, kTool);
    const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-9 + 1e-5 * std::abs(b); };
    if (got.contact_time != wanted.contact_time || differ(got.force_N, wanted.force_N) ||
        differ(got.area_m2 * 1e5, wanted.area_m2 * 1e5) || got.status != wanted.status)
      said_ << "over " << t0 << " .. " << t1 << " " << got.contact_time.count() << " ns, " << got.force_N << " N, "
            << got.area_m2 << " m2, " << to_string(got.status) << " instead of " << wanted.contact_time.count()
            << ", " << wanted.force_N << ", " << wanted.area_m2 << ", " << to_string(wanted.status) << "; ";
    double force_N = 0, area_m2 = 0;
    Nanoseconds longest{0}, together{0};
    for (const ContactPart& part : got.parts) {
      force_N += part.force_N, area_m2 += part.area_m2;
      longest = std::max(longest, part.contact_time), together += part.contact_time;
    }
    if (differ(force_N, got.force_N) || differ(area_m2 * 1e5, got.area_m2 * 1e5) || longest > got.contact_time ||
        together < got.contact_time)
      said_ << "over " << t0 << " .. " << t1 << " the parts do not add up: " << force_N << " N of " << got.force_N << "; ";
    ++tally_.integrals;
    if (!contacts_.knows_all(t0, t1, kTool)) return;
    ++tally_.true_integrals;
    const std::int64_t truth = contacts_.true_contact_time_ns(t0, t1, kTool);
    if (got.contact_time.count() != truth)
      said_ << "over " << t0 << " .. " << t1 << " " << got.contact_time.count() << " ns instead of the true " << truth
            << "; ";
  }

  void check_poses(SimTime t) {
    for (const auto& [body, times] : poses_.known().bodies) {
      const TrueBody& truth = poses_.life().bodies[static_cast<std::size_t>(body)];
      const auto got = bodies_.pose(body, t);
      const auto after = times.upper_bound(to_ns(t));
      if (after == times.begin()) continue;  // before all received samples
      const std::int64_t before_ns = *std::prev(after);
      const double s = static_cast<double>(to_ns(t)) * 1e-9;
      Eigen::Vector3d position = truth.position(s);
      double turned = truth.turn_rad_s * s;
      SampleStatus status = SampleStatus::kInterpolated;
      if (before_ns == to_ns(t)) {
        status = SampleStatus::kExact;
      } else if (after == times.end()) {
        const std::int64_t past = std::min<std::int64_t>(to_ns(t) - before_ns, 50 * kMs);
        const double known_s = static_cast<double>(before_ns) * 1e-9, on_s = static_cast<double>(past) * 1e-9;
        position = truth.position(known_s) + on_s * truth.velocity(known_s);
        turned = truth.turn_rad_s * (known_s + on_s);
        const std::int64_t own_past = to_ns(t) - before_ns;
        status = own_past <= 50 * kMs ? SampleStatus::kExtrapolated : own_past <= 200 * kMs ? SampleStatus::kHeld : SampleStatus::kStale;
      }
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ()));
      if (got.status != status)
        said_ << "body " << body << " is " << to_string(got.status) << " instead of " << to_string(status) << "; ";
      // Single precision of velocity and orientation, over 50 ms and 10 rad/s.
      if ((got.value.position - position).norm() > 1e-6 || turn.angularDistance(got.value.orientation) > 1e-5)
        said_ << "body " << body << " is off by " << (got.value.position - position).norm() << " m, "
              << turn.angularDistance(got.value.orientation) << " rad; ";
      ++tally_.poses;
    }
  }

  World& world_;
  Clock clock_;
  Tally& tally_;
  ClockMaps maps_{kRun};
  OwnClock own_;
  ContactStream stream_;
  BodyHistory bodies_;
  Reference contacts_, poses_;
  std::int64_t period_ns_ = kMs, delay_ns_ = 0;
  bool begun_ = false;
  SimTime until_{};
  std::set<std::int64_t> got_;
  std::ostringstream said_;
};

}  // namespace

TEST_CASE("Events, states and integrals match the oracle for lost, repeated, reordered and forged messages") {
  Tally tally;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    Random random(seed);
    const auto clock = static_cast<Clock>(seed % 3);
    World world = make_world(random, clock != Clock::kSame);
    Renderer renderer(world, clock, random, tally);
    const std::string failures = renderer.run(random);
    INFO("seed " << seed << ": " << failures.substr(0, 1000));
    REQUIRE(failures.empty());
  }
  INFO(tally.events << " events, " << tally.states << " states, " << tally.interpolated << " interpolated, "
                    << tally.integrals << " integrals, " << tally.true_integrals << " true, " << tally.poses
                    << " poses, " << tally.restarts << " restarts");
  CHECK(tally.events > 10'000);
  CHECK(tally.states > 10'000);
  CHECK(tally.interpolated > 1'000);
  CHECK(tally.integrals > 10'000);
  CHECK(tally.true_integrals > 1'000);
  CHECK(tally.poses > 10'000);
  CHECK(tally.restarts > 100);
}
