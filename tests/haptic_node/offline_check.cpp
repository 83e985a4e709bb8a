// The program renders a recorded run; the result is compared tick by tick with a live session.
#include <cmath>
#include <random>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "haptic_node/devices/recorded_hand.h"
#include "haptic_node/rendering/session.h"
#include "sync/log/export_csv.h"
#include "sync/log/log_reader.h"
#include "tests/audio_node/support/recorded_run.h"
#include "tests/haptic_node/support/node_config.h"
#include "tests/haptic_node/support/world.h"
#include "tests/rendered_log.h"

using namespace tactus;
using namespace tactus::haptic;
using audio::test::kLogBegins_ns;
using audio::test::RecordedRun;
using tactus::test::cells_of;
using tactus::test::in_force;
using tactus::test::Rendered;
using tactus::test::RenderedLog;

namespace {

constexpr std::int32_t kClock = 4711;  // as in RecordedRun
constexpr std::int64_t kRun = 7;
constexpr double kFrom_s = 0.1, kUntil_s = 2.1;

header_t header_at(double at_s, std::int64_t seq, std::int64_t incarnation) {
  return {std::llround(at_s * 1e9), kLogBegins_ns + std::llround(at_s * 1e9), kClock, kRun, 9, incarnation, seq};
}

scene_t floor_and_stylus() {
  scene_t s = haptic::test::scene();
  for (body_def_t& b : s.bodies) b.pose.orientation.w = 1;
  s.listener.orientation.w = s.camera.orientation.w = 1;
  return s;
}

// The tip moves up and down through a floor at z = 5 mm, slides, and hits it once; the floor does not stop the
// hand.
DeviceState hand_at(double t_s) {
  DeviceState d;
  d.position = {0.02 * std::sin(3 * t_s), 0.01 * std::cos(2 * t_s), 0.0095 + 0.004 * std::cos(20 * t_s)};
  // A message holds single precision. Volatile: GCC 12 vectorises the rounding of two of them away.
  const auto rounded = [](double v) {
    const volatile float single = static_cast<float>(v);
    return static_cast<double>(single);
  };
  d.velocity = {rounded(0.06 * std::cos(3 * t_s)), rounded(-0.02 * std::sin(2 * t_s)),
                rounded(-0.08 * std::sin(20 * t_s))};
  return d;
}

touch_model_t model_at(double t_s, std::int64_t seq) {
  touch_plane_t floor = haptic::test::plane(7, {0, 0, 0.005}, {0, 0, 1}, 0.4);
  floor.point_body_m.z = 0.005f, floor.normal_body = floor.normal;
  touch_model_t m = haptic::test::model(0, {floor});
  m.header = header_at(t_s, seq, 21);
  m.clock = {m.header.sim_time_ns, m.header.publish_time_ns, 1};
  return m;
}

contact_events_t hit_at(double t_s) {
  contact_events_t m{};
  m.header = header_at(t_s, 0, 21);
  m.clock = {m.header.sim_time_ns, m.header.publish_time_ns, 1};
  m.pages = 1;
  m.events = {haptic::test::event(1, contact_event_t::BEGIN, t_s * 1e3),
              haptic::test::event(2, contact_event_t::HIT, t_s * 1e3)};
  m.count = 2;
  return m;
}

// Runs a live session and records it: touch models at whole milliseconds, ticks a varying time after each, as in a
// real loop. Returns the rendered force as a table.
// From foreign_s on, the log holds only touch models of another simulation for another tool, at 100 Hz.
std::string live(const std::string& log, const std::string& profile = "", double until_s = kUntil_s,
                 double foreign_s = 1e9) {
  const scene_t scene = floor_and_stylus();
  RecordedRun run(std::make_unique<sync::FileSink>(log), scene);
  if (!profile.empty()) run.write_raw(0.01, channels::kDegradation, in_force(profile, header_at(0.01, 0, 33)));
  const NodeConfig config = resolve_config(scene, "", {});
  DeviceState hand;
  Safety safety(safety_limits(config.settings));
  sync::ClockMaps maps(kRun);
  Session session(scene, config, std::make_unique<RecordedHand>(hand), {kRun, kClock, &maps}, safety);
  session.set_maps(std::make_shared<SurfaceMaps>(read_maps(scene, {})));
  std::string table = sync::haptic_csv_names();
  std::mt19937 random(5);
  std::uniform_int_distribution<int> after_us(200, 700);
  std::int64_t seq = 0;
  for (int ms = static_cast<int>(kFrom_s * 1000); ms < static_cast<int>(until_s * 1000); ++ms, ++seq) {
    const double t_s = ms * 1e-3, tick_s = t_s + after_us(random) * 1e-6;
    const touch_model_t model = model_at(t_s, seq);
    if (t_s < foreign_s) run.write_raw(t_s, channels::kTouchModel, sync::encode(model));
    if (t_s >= foreign_s && ms % 10 == 0) {
      touch_model_t foreign = model;
      foreign.header.incarnation = 77, foreign.tool = 1;
      run.write_raw(t_s, channels::kTouchModel, sync::encode(foreign));
    }
    session.push(model, sync::host_time(model.header.publish_time_ns));
    if (ms == 200) {
      run.write_raw(t_s, channels::kContactEvents, sync::encode(hit_at(t_s)));
      session.push(hit_at(t_s).events);
    }
    hand = hand_at(tick_s);
    const header_t header = header_at(tick_s, seq, 44);
    tool_state_t state = session.step(sync::host_time(header.publish_time_ns)).state;
    const std::int64_t sim_time_ns = state.header.sim_time_ns;
    state.header = header;
    state.header.sim_time_ns = sim_time_ns;
    run.write_raw(tick_s + 50e-6, channels::kToolState, sync::encode(state));  // transport time to the recorder
    table += sync::csv_row(state);
  }
  run.finish();
  return table;
}

double largest_force_N(const std::string& table) {
  double most = 0;
  for (const auto& row : cells_of(table)) most = std::max(most, std::abs(std::stod(row.at(11))));
  return most;
}

constexpr const char* kOff = R"(<profile name="numb"><degrade modality="haptic" off="true"/></profile>)";

}  // namespace

TEST_CASE("A log renders to the recorded forces, bit for bit, each time") {
  const RenderedLog of("haptic_node");
  const std::string felt = live(of.file("run.lcmlog"));
  CHECK(largest_force_N(felt) > 2);
  CHECK(cells_of(felt).size() == 2000);
  const std::string again = of.trace();
  CHECK((again == felt));  // not printed: 2000 lines
  CHECK((of.trace() == again));
}

TEST_CASE("A profile degrades the rendered log, and the recorded profile applies only on request") {
  const RenderedLog of("haptic_node");
  const std::string felt = live(of.file("run.lcmlog"));
  live(of.file("numb.lcmlog"), kOff);
  const std::string off = of.trace({"--degrade", of.write("off.xml", kOff)});
  CHECK(largest_force_N(off) == 0);
  CHECK(cells_of(off).size() == 2000);
  CHECK((of.trace({}, "numb.lcmlog") == felt));
  CHECK((of.trace({"--degrade", "logged"}, "numb.lcmlog") == off));

  SECTION("A delay of 20 ms delays the touch models by 20 ticks and the reported times of the events") {
    const std::string late = R"(<profile name="late"><degrade modality="haptic" delay="20ms"/></profile>)";
    const auto table =
        cells_of(of.trace({"--degrade", of.write("late.xml", late), "--presented", of.file("p.csv")}));
    const auto events = cells_of(RenderedLog::bytes(of.file("p.csv")));
    REQUIRE(events.size() == 2);
    const auto hit =
        std::find_if(events.begin(), events.end(), [](const auto& row) { return row.at(2) == "transient"; });
    REQUIRE(hit != events.end());
    CHECK(std::stoll(hit->at(3)) == kLogBegins_ns + 200'000'000 + 20'000'000);
    // The floor arrives with the first delayed model.
    CHECK(table.at(18).at(20) == "none");
    CHECK(table.at(24).at(20) != "none");
  }
}

TEST_CASE("Touch models of another simulation for another tool do not keep the force alive") {
  const RenderedLog of("haptic_node");
  live(of.file("run.lcmlog"), "", kUntil_s, 1);
  const auto table = cells_of(of.trace());
  const auto force_N = [&](std::size_t row) { return std::abs(std::stod(table.at(row).at(11))); };
  double before_N = 0, after_N = 0;
  for (std::size_t row = 0; row < 900; ++row) before_N = std::max(before_N, force_N(row));
  for (std::size_t row = 980; row < table.size(); ++row) after_N = std::max(after_N, force_N(row));
  CHECK(before_N > 2);
  CHECK(after_N == 0);
}

TEST_CASE("Ticks before and after a gap in the recording are rendered, missing ticks are not") {
  const RenderedLog of("haptic_node");
  live(of.file("whole.lcmlog"));
  std::string bytes = RenderedLog::bytes(of.file("whole.lcmlog"));
  const std::size_t middle = bytes.size() / 2;
  bytes.erase(middle, 50'000);
  of.write("run.lcmlog", bytes);
  const auto rows = cells_of(of.trace());
  CHECK(rows.size() < 1990);
  CHECK(rows.size() > 1500);
  for (std::size_t i = 1; i < rows.size(); ++i) CHECK(std::stoll(rows[i].at(25)) > std::stoll(rows[i - 1].at(25)));
  CHECK(std::stoll(rows.back().at(25)) == 1999);
}

TEST_CASE("A log without LOG_INFO is rendered with a warning") {
  const RenderedLog of("haptic_node");
  const std::string felt = live(of.file("whole.lcmlog"));
  std::string bytes = RenderedLog::bytes(of.file("whole.lcmlog"));
  const std::string sync = bytes.substr(0, 4);
  const std::size_t second = bytes.find(sync, 4);
  REQUIRE(bytes.substr(0, second).find("LOG_INFO") != std::string::npos);
  of.write("run.lcmlog", bytes.substr(second));
  const Rendered done = of.render({"--log", of.file("run.lcmlog"), "--trace", of.file("trace.csv")});
  CAPTURE(done.said);
  REQUIRE(done.status == 0);
  CHECK_THAT(done.said, Catch::Contains("LOG_INFO"));
  const auto rows = cells_of(RenderedLog::bytes(of.file("trace.csv")));
  const auto all = cells_of(felt);
  REQUIRE(rows.size() > 1990);
  // Without LOG_INFO the beginning is known only to a latency; the forces belong to the same ticks.
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& same = all.at(static_cast<std::size_t>(std::stoll(rows[i].at(25))));
    for (std::size_t cell = 11; cell < 14; ++cell)
      REQUIRE(std::stod(rows[i].at(cell)) == Approx(std::stod(same.at(cell))).margin(1e-3));
  }
}

TEST_CASE("A recording in parts renders like a single file") {
  const RenderedLog of("haptic_node");
  const std::string felt = live(of.file("whole.lcmlog"));
  const std::string bytes = RenderedLog::bytes(of.file("whole.lcmlog"));
  std::vector<std::size_t> begins;
  sync::LogScanner scanner({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  std::size_t head = 0;
  for (sync::LogEvent e; begins.push_back(scanner.at()), scanner.next(e);)
    if (head == 0 && e.channel == channels::kTouchModel) head = begins.back();
  REQUIRE(head > 0);
  std::filesystem::create_directory(of.file("parts"));
  const std::size_t third = begins[begins.size() / 3], half = begins[begins.size() / 2];
  of.write("parts/run.lcmlog", bytes.substr(0, third));
  of.write("parts/run.2.lcmlog", bytes.substr(0, head) + bytes.substr(third, half - third));
  of.write("parts/run.10.lcmlog", bytes.substr(0, head) + bytes.substr(half));
  CHECK((of.trace({}, "parts") == felt));
  const Rendered over = of.render({"--log", of.file("parts"), "--trace", of.file("parts/run.2.lcmlog")});
  CHECK(over.status == 1);
  CHECK_THAT(over.said, Catch::Contains("is the log itself"));
}

TEST_CASE("A log without the tool, an unknown tool and a log without a run are rejected in one sentence") {
  const RenderedLog of("haptic_node");
  const auto refusal = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--trace", of.file("x.csv")});
    const Rendered done = of.render(words);
    CAPTURE(done.said);
    CHECK(done.status == 1);
    CHECK_FALSE(std::filesystem::exists(of.file("x.csv")));
    CHECK_FALSE(std::filesystem::exists(of.file("x.csv.part")));
    return done.said;
  };
  live(of.file("run.lcmlog"), "", 0.3);
  live(of.file("empty.lcmlog"), "", kFrom_s);
  CHECK_THAT(refusal({"--log", of.file("empty.lcmlog")}), Catch::Contains("no TOOL_STATE of this tool"));
  CHECK_THAT(refusal({"--log", of.file("run.lcmlog"), "--tool", "toe"}), Catch::Contains("\"toe\""));
  RecordedRun(std::make_unique<sync::FileSink>(of.file("bare.lcmlog")), std::vector<sync::Asset>{}).finish();
  CHECK_THAT(refusal({"--log", of.file("bare.lcmlog")}), Catch::Contains("no scene"));
  CHECK_THAT(refusal({"--log", of.write("text.lcmlog", "This is a letter.\n")}),
             Catch::Contains("not an LCM log"));
  CHECK_THAT(refusal({"--log", of.file("run.lcmlog"), "--device", "virtual_hand"}), Catch::Contains("--device"));
  const Rendered no_trace = of.render({"--log", of.file("run.lcmlog")});
  CHECK(no_trace.status == 1);
  CHECK_THAT(no_trace.said, Catch::Contains("--trace"));
  const std::string log = RenderedLog::bytes(of.file("run.lcmlog"));
  const Rendered over = of.render({"--log", of.file("run.lcmlog"), "--trace", of.file("run.lcmlog")});
  CHECK(over.status == 1);
  CHECK_THAT(over.said, Catch::Contains("is the log itself"));
  CHECK((RenderedLog::bytes(of.file("run.lcmlog")) == log));
}
