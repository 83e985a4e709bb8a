// The limits for device drivers in C++, by the table that the test in Python (tests/scripts/test_guards.py) reads
// too. That file describes the columns.
#include "examples/device_driver/guards.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/source_dir.h"

using namespace tactus::examples;

namespace {

constexpr std::int64_t kStart_ns = 10'000'000'000, kMs = 1'000'000;

using Row = std::map<std::string, std::string>;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  if (line.ends_with(',')) cells.emplace_back();
  return cells;
}

std::vector<Row> table() {
  std::ifstream file(tactus::source_dir() + "/tests/examples/guard_cases.csv");
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = split(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = split(line);
    REQUIRE(cells.size() == names.size());
    Row row;
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
    rows.push_back(row);
  }
  return rows;
}

double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

// One device and its senders, with time moved by hand.
struct Case {
  ForceGuard force{{}, {}};
  TemperatureGuard plate{{}, {}};
  std::int64_t now_ms = 0, seq = 0;
  Reason message = Reason::kNone, reason = Reason::kNoCommand;
  double output = 0, before_N = 0, given_J = 0, plate_degC = 33;
  bool within = true, slow = true;

  std::int64_t now_ns() const { return kStart_ns + now_ms * kMs; }
  Sent sent(const Row& row, std::int64_t run = 1, std::int64_t more = 0) {
    const auto age_ns = static_cast<std::int64_t>(number(row, "age_ms") * 1e6);
    return {run, std::stoll(row.at("incarnation")) + more, ++seq, now_ns() - age_ns};
  }
  Reason push(const Row& row, const Sent& m, bool torque = false) {
    const Vector v{number(row, "x"), number(row, "y"), number(row, "z")};
    return force.on_message(m, torque ? Vector{} : v, torque ? v : Vector{}, std::stoll(row.at("valid_ms")) * kMs,
                            now_ns());
  }
  void send(const Row& row) {
    const std::string& what = row.at("do");
    if (what == "force" || what == "torque") message = push(row, sent(row), what == "torque");
    if (what == "repeat") --seq, message = push(row, sent(row));
    if (what == "leap") {
      Sent m = sent(row);
      m.seq = std::int64_t{1} << 62;
      message = push(row, m);
    }
    if (what == "other_run") message = push(row, sent(row, 2));
    if (what == "beside_other_run") push(row, sent(row, 2, 1)), message = push(row, sent(row));
    if (what == "two") push(row, sent(row, 1, 1)), message = push(row, sent(row));
    if (what == "two_temperatures") plate.on_message(sent(row, 1, 1), number(row, "x"), now_ns());
    if (what == "temperature" || what == "two_temperatures")
      message = plate.on_message(sent(row), number(row, "x"), now_ns());
  }
  void tick_force(const Row& row, double dt_s) {
    const double speed = number(row, "speed");
    const Exerted out = force.update(now_ns(), {0, 0, speed});
    const double force_N = size(out.force), torque_N_m = size(out.torque);
    within &= force_N <= 8 + 1e-9 && torque_N_m <= 0.3 + 1e-9;  // false for NaN
    slow &= force_N <= before_N || force_N - before_N <= 2000 * dt_s + 1e-9;
    if (std::isfinite(speed)) given_J = std::max(0.0, given_J + (out.force[2] * speed - 1) * dt_s);
    within &= given_J <= 0.49 + 8e-3;  // one tick at 8 N and 1 m/s
    before_N = force_N, reason = out.reason;
    output = row.at("do") == "torque" || torque_N_m > 0 ? torque_N_m : force_N;
  }
  void tick_plate(const Row& row) {
    const double measured = row.at("y").empty() ? plate_degC : number(row, "y");
    output = plate_degC = plate.update(now_ns(), measured);
    within &= output >= 15 && output <= 42;
    reason = plate.reason();
  }
  void run(const Row& row) {
    const std::string& what = row.at("do");
    const std::int64_t to_ms = std::stoll(row.at("to_ms"));
    const bool warm = what == "temperature" || what == "two_temperatures" || what == "plate";
    const std::int64_t step = what == "stop" ? to_ms - now_ms : warm ? 100 : 1;
    while (now_ms < to_ms) {
      now_ms += step;
      send(row);
      if (warm)
        tick_plate(row);
      else
        tick_force(row, static_cast<double>(step) * 1e-3);
    }
  }
};

}  // namespace

TEST_CASE("A driver's limits hold in every case of the table") {
  std::string name;
  std::optional<Case> now;
  int cases = 0;
  for (const Row& row : table()) {
    if (row.at("case") != name) name = row.at("case"), now.emplace(), ++cases;
    now->run(row);
    CAPTURE(name, now->now_ms, now->output, text(now->message), text(now->reason));
    CHECK(now->within);
    CHECK(now->slow);
    CHECK(now->output >= number(row, "low") - 1e-9);
    CHECK(now->output <= number(row, "high") + 1e-9);
    CHECK(text(now->reason) == row.at("reason"));
    CHECK(text(now->message) == row.at("message"));
  }
  CHECK(cases > 30);
}

TEST_CASE("A driver stays within its limits for random messages, gaps and motions") {
  std::mt19937_64 random(4);
  const auto any = [&](std::initializer_list<double> values) { return values.begin()[random() % values.size()]; };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  const ForceLimits limits;
  ForceGuard guard(limits, {});
  std::int64_t now_ns = kStart_ns, seq = 0;
  double before_N = 0, before_N_m = 0;
  bool within = true, slow = true;
  for (int tick = 0; tick < 200'000; ++tick) {
    const std::int64_t dt_ns = static_cast<std::int64_t>(any({0, 1e5, 1e6, 1e6, 1e6, 4e6, 1.9e7, 2.1e7, 1e9}));
    now_ns += dt_ns;
    for (auto left = random() % 3; left > 0; --left) {
      const Sent sent{static_cast<std::int64_t>(random() % 50 != 0),
                      7 + static_cast<std::int64_t>(random() % 2000 == 0),
                      random() % 20 ? ++seq : static_cast<std::int64_t>(random()),
                      random() % 20 ? now_ns : static_cast<std::int64_t>(random())};
      const Vector force{any({0, 8, -8, 1e9}), any({0, 3, -1e30}),
                         random() % 50 ? any({0, 5, -2000}) : any({kNan, kInf})};
      const Vector torque{0, any({0, 0.2, -5}), random() % 50 ? 0 : any({kNan, -kInf})};
      guard.on_message(sent, force, torque, random() % 10 ? 20'000'000 : static_cast<std::int64_t>(random()),
                       now_ns);
    }
    const Vector velocity{0, any({0, 0.3, -0.3}), random() % 200 ? any({0, 1, -1}) : kNan};
    const Exerted out = guard.update(now_ns, velocity);
    const double force_N = size(out.force), torque_N_m = size(out.torque),
                 dt_s = static_cast<double>(dt_ns) * 1e-9;
    within &= force_N <= limits.force_N + 1e-9 && torque_N_m <= limits.torque_N_m + 1e-9;  // false for NaN
    slow &= force_N <= before_N || force_N - before_N <= limits.slew_N_s * dt_s + 1e-9;
    slow &= torque_N_m <= before_N_m || torque_N_m - before_N_m <= limits.torque_slew_N_m_s * dt_s + 1e-9;
    before_N = force_N, before_N_m = torque_N_m;
  }
  CHECK(within);
  CHECK(slow);
}

namespace {

// A TemperatureGuard at 10 Hz, with time moved by hand. Commands are sent unless `wanted` is empty; the plate follows unless it is given.
struct PlateRun {
  TemperatureGuard guard;
  std::int64_t now_ns = kStart_ns, seq = 0;
  explicit PlateRun(const TemperatureLimits& limits = {}) : guard(limits, {}) {}
  double run(double seconds, std::optional<double> wanted_degC, std::optional<double> plate_degC = {}) {
    double out = 33;
    for (int i = 0; i < std::lround(seconds * 10); ++i) {
      now_ns += 100 * kMs;
      if (wanted_degC) guard.on_message({1, 5, ++seq, now_ns}, *wanted_degC, now_ns);
      out = guard.update(now_ns, plate_degC.value_or(last));
      last = out;
    }
    return out;
  }
  double last = 33;
};

}  // namespace

TEST_CASE("A plate that does not obey, or whose sensor has failed, is switched off") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  PlateRun plate;
  plate.run(1, 33);
  for (const auto& [degC, off] : std::vector<std::pair<double, bool>>{
           {33, false}, {44, false}, {44.1, true}, {33, false}, {13, false}, {12.9, true}, {12.95, false}, {kNan, true}, {33, false}}) {
    plate.run(0.1, 33, degC);
    CAPTURE(degC);
    CHECK(plate.guard.off() == off);
  }
  PlateRun cold;
  cold.run(0.1, 33, -5);
  CHECK_FALSE(cold.guard.off());  // it was cold when it was switched on
}

TEST_CASE("The exposure of a person at a plate survives a restart of the driver") {
  PlateRun plate;
  CHECK(plate.run(250, 42) == 39);
  PlateRun again;
  again.guard.resume(plate.guard.account());
  CHECK(again.run(5, 42) == 39);
  PlateRun rested;
  rested.guard.resume(plate.guard.account(), 3600);
  CHECK(rested.run(5, 42) == 42);
  for (const double damaged : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1.0, 1e9}) {
    PlateRun full;
    full.guard.resume({damaged, damaged, false, false});
    CHECK(full.run(5, 42) == 39);
    CHECK(full.run(5, 15) == 20);
  }
}

TEST_CASE("No slew limit of a plate lengthens its way to neutral") {
  for (const double slew : {0.1, 1.0, 20.0}) {
    TemperatureLimits limits;
    limits.slew_K_s = slew;
    PlateRun plate(limits);
    CHECK(plate.run(9 / slew + 1, 42) == Approx(42));
    CHECK(plate.run(0.3 + 0.5, std::nullopt) == Approx(33));  // 0.3 s of validity, and 9 K at 20 K/s
  }
}
