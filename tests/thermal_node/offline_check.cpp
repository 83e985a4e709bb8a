// The program renders the skin temperature of a recorded run.
#include <cmath>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/thermal_device_t.hpp>

#include "tests/audio_node/support/recorded_run.h"
#include "tests/rendered_log.h"

using namespace tactus;
using audio::test::kLogBegins_ns;
using audio::test::RecordedRun;
using test::RenderedLog;

namespace {

constexpr double kRun_s = 4, kTouched_s = 1, kReleased_s = 2.5;
constexpr double kRest_degC = 33;
enum { kSkin = 7, kCommand = 8 };  // columns

header_t header_at(double at_s, std::int64_t seq, std::int64_t incarnation) {
  return {std::llround(at_s * 1e9), kLogBegins_ns + std::llround(at_s * 1e9), 4711, 7, 9, incarnation, seq};
}

// A copper block, body 0, and a finger, body 1.
scene_t copper() {
  scene_t s{};
  s.step_ns = 1'000'000;
  s.bodies.resize(2);
  s.bodies[1].id = 1;
  s.body_count = 2;
  for (body_def_t& b : s.bodies) b.pose.orientation.w = 1;
  s.listener.orientation.w = s.camera.orientation.w = 1;
  s.tools.resize(1), s.tool_count = 1;
  s.tools[0].name = "finger", s.tools[0].body = 1, s.tools[0].radius_m = 0.01, s.tools[0].mass_kg = 0.05;
  s.materials.resize(1), s.material_count = 1;
  material_def_t& m = s.materials[0];
  m.name = "copper", m.conductivity_W_mK = 401, m.density_kg_m3 = 8960, m.specific_heat_J_kgK = 385, m.temperature_degC = 20;
  m.youngs_modulus_Pa = 1e11;
  return s;
}

// The finger rests on the block for 1.5 s with 1 N.
void record(const std::string& path, const std::string& profile = "") {
  RecordedRun run(std::make_unique<sync::FileSink>(path), copper());
  if (!profile.empty()) run.write_raw(0.01, channels::kDegradation, test::in_force(profile, header_at(0.01, 0, 33)));
  std::int64_t seq = 0;
  for (int ms = 20; ms < static_cast<int>(kRun_s * 1000); ms += 2) {
    contact_frame_t m{};
    m.header = header_at(ms * 1e-3, seq++, 21);
    m.clock = {m.header.sim_time_ns, m.header.publish_time_ns, 1};
    m.group = contact_frame_t::TOOL, m.pages = 1;
    if (ms >= kTouched_s * 1000 && ms < kReleased_s * 1000) {
      contact_t c{};
      c.contact_id = 5, c.tool = 0, c.body_a = 0, c.body_b = 1, c.material_a = 0, c.material_b = -1;
      c.normal_force_N = 1, c.area_m2 = 1e-4f;
      c.normal.z = 1;
      c.points.resize(1), c.point_count = 1;
      m.contacts = {c}, m.count = 1;
    }
    run.write_raw(ms * 1e-3, channels::kContacts, sync::encode(m));
  }
  run.finish();
}

double degC(const std::vector<std::string>& row, int column) { return std::stod(row.at(static_cast<std::size_t>(column))); }

constexpr const char* kLate = R"(<profile name="late"><degrade modality="thermal" delay="200ms"/></profile>)";

}  // namespace

TEST_CASE("The skin cools on copper and warms again, with identical results from one log") {
  const RenderedLog of("thermal_node");
  record(of.file("run.lcmlog"));
  const std::string trace = of.trace();
  CHECK((of.trace() == trace));
  const auto rows = test::cells_of(trace);
  CHECK(rows.size() >= static_cast<std::size_t>(kRun_s * 50) - 2);
  const auto at = [&](double s) { return rows.at(static_cast<std::size_t>(s * 50)); };
  CHECK(degC(at(0.9), kSkin) == Approx(kRest_degC).margin(0.05));
  CHECK(degC(at(2.4), kSkin) < kRest_degC - 2);
  CHECK(degC(at(3.9), kSkin) > degC(at(2.4), kSkin) + 1);
}

TEST_CASE("A delay of 200 ms shifts the result by ten ticks, and the recorded profile applies only on request") {
  const RenderedLog of("thermal_node");
  record(of.file("run.lcmlog"));
  record(of.file("late.lcmlog"), kLate);
  const auto now = test::cells_of(of.trace());
  const std::string delayed = of.trace({"--degrade", of.write("late.xml", kLate)});
  const auto late = test::cells_of(delayed);
  REQUIRE(late.size() == now.size());
  // From the tick at which both have a contact.
  for (std::size_t i = 20; i + 10 < now.size(); ++i) {
    INFO(now[i].at(1));
    CHECK(degC(late[i + 10], kSkin) == Approx(degC(now[i], kSkin)).margin(1e-3));
    CHECK(degC(late[i + 10], kCommand) == Approx(degC(now[i], kCommand)).margin(1e-3));
  }
  CHECK((of.trace({}, "late.lcmlog") == of.trace()));
  const auto logged = test::cells_of(of.trace({"--degrade", "logged"}, "late.lcmlog"));
  for (std::size_t i = 20; i < late.size(); ++i) CHECK(logged.at(i) == late.at(i));
}

TEST_CASE("A log without a tool and an unwritable table are rejected in one sentence without a file") {
  const RenderedLog of("thermal_node");
  RecordedRun(std::make_unique<sync::FileSink>(of.file("struck.lcmlog"))).finish();
  const test::Rendered done = of.render({"--log", of.file("struck.lcmlog"), "--trace", of.file("x.csv")});
  CHECK(done.status == 1);
  CHECK_THAT(done.said, Catch::Contains("no tool"));
  CHECK_FALSE(std::filesystem::exists(of.file("x.csv")));
  record(of.file("run.lcmlog"));
  const test::Rendered nowhere = of.render({"--log", of.file("run.lcmlog"), "--trace", of.file("none/x.csv")});
  CHECK(nowhere.status == 1);
  CHECK_THAT(nowhere.said, Catch::Contains("choose another --trace"));
  const test::Rendered rate = of.render({"--log", of.file("run.lcmlog"), "--trace", "/dev/null", "--set", "rate=100"});
  CHECK(rate.status == 0);
}
