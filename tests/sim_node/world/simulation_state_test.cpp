// A simulation that is saved and restored continues identically to the bit.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "sim_node/world/simulation.h"
#include "sim_node/scene/load_sdf.h"
#include "sim_node/model/envelope.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "tests/sim_node/support/simple_hand.h"
#include "tests/source_dir.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

using Bytes = std::vector<std::uint8_t>;

struct Hash {
  std::uint64_t value = sync::kFnv1aBegin;
  void add(const void* data, std::size_t size) { value = sync::fnv1a_64(value, data, size); }
  template <class Message>
  void message(const Message& m) {
    Bytes bytes(static_cast<std::size_t>(m.getEncodedSize()));
    m.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    add(bytes.data(), bytes.size());
  }
};

// All published data of a step, and the unrounded poses and velocities.
void add_step(Hash& h, Simulation& s) {
  for (const auto& e : s.events()) h.message(e);
  for (const auto& m : s.touch_models()) h.message(m);
  for (const auto& c : s.tool_contacts()) h.message(c);
  std::vector<contact_t> contacts;
  s.body_contacts(contacts);
  for (const auto& c : contacts) h.message(c);
  game_state_t game{};
  s.game().describe(game);
  h.message(game);
  for (const BodyMotion& m : s.bodies()) {
    h.add(m.position_m.data(), 3 * sizeof(double));
    h.add(m.orientation.coeffs().data(), 4 * sizeof(double));
    h.add(m.velocity_m_s.data(), 3 * sizeof(double));
    h.add(m.spin_rad_s.data(), 3 * sizeof(double));
  }
}

using Path = std::function<Vector3d(double)>;

// Runs a number of steps of a world, with a hand if the world has a tool.
std::uint64_t run(Simulation& s, Hand& hand, const Path& path, int steps) {
  Hash h;
  for (int i = 0; i < steps; ++i) {
    std::vector<tool_state_t> new_messages;
    if (!s.touch_models().empty()) {
      const std::int64_t now_ns = sync::to_ns(s.now());
      new_messages.push_back(hand.tick(s.touch_models()[0], path(now_ns * 1e-9), now_ns));
    }
    s.step(new_messages);
    add_step(h, s);
  }
  return h.value;
}

Settings exact() {
  Settings s;
  s.solver = "step";
  return s;
}

Settings by_impulses() {
  Settings s;
  s.solver = "impulse";
  return s;
}

struct World {
  std::string name;
  WorldDef def;
  Settings settings{};
  Path path = [](double) { return Vector3d(0, 0, 1); };
};

WorldDef scene(const std::string& name) {
  std::vector<std::string> warnings;
  return load_sdf(source_dir() + "/sim_node/scenes/" + name + ".sdf", warnings);
}

// Presses and pushes among the balls and boxes.
Vector3d about_the_room(double t) {
  return {-0.12 + 0.1 * std::sin(3 * t), -0.25 + 0.15 * std::sin(1.7 * t), 0.03 + 0.04 * std::cos(9 * t)};
}

WorldDef stack() {
  WorldDef w = empty_world();
  add_floor(w);
  for (int i = 0; i < 5; ++i)
    add_box(w, 0.2, {0.1, 0.1, 0.1}, at(0.005 * (i % 2), 0.002 * i, 0.051 + 0.102 * i), 0.6, 0.2);
  add_tool(w, {-0.2, 0, 0.2});
  return w;
}

WorldDef springs() {
  WorldDef w = chain_world(6);
  for (JointDef& j : w.joints) j.axes[0].damping = j.axes[1].damping = 1e-4, j.axes[0].stiffness = 0.01;
  w.bodies.back().velocity_m_s = {1, 0.4, 0};
  add_ball(w, 0.5, 0.05, {0.1, 0.03, 1.5});
  return w;
}

WorldDef motor() {
  WorldDef w = empty_world();
  add_floor(w, 0.7, 0.6);
  const int rotor = add_box(w, 0.1, {0.3, 0.02, 0.05}, at(0, 0, 0.1));
  JointDef& j = add_joint(w, JointKind::kRevolute, -1, rotor, {0, 0, 0.1}, {0, 0, 1});
  j.axes[0].motor_effort = 0.02, j.axes[0].motor_velocity = 1000, j.axes[0].friction = 0.005,
  j.axes[0].damping = 0.004;
  for (int i = 0; i < 4; ++i) add_ball(w, 0.05, 0.02, {0.05 + 0.01 * i, 0.06, 0.1 + 0.07 * i}, 0.5, 0.8);
  return w;
}

std::vector<World> made_worlds() {
  const Path along = [](double t) { return Vector3d(-0.12 + 0.1 * t, 0.01 * std::sin(20 * t), 0.2); };
  return {{"a stack that a hand pushes over", stack(), {}, along},
          {"the same, solved exactly", stack(), exact(), along},
          {"the same, by impulses", stack(), by_impulses(), along},
          {"a chain with springs, and a ball", springs()},
          {"the same chain, by impulses", springs(), by_impulses()},
          {"a motor, by impulses", motor(), by_impulses()},
          {"a motor and bouncing balls", motor()}};
}

std::vector<World> worlds() {
  std::vector<World> all = made_worlds();
  all.push_back({"the dark room", scene("dark_room"), {}, about_the_room});
  all.push_back({"the dark room, by impulses", scene("dark_room"), by_impulses(), about_the_room});
  all.push_back(
      {"a mesh in a mesh", scene("peg_in_hole"), {}, [](double t) { return Vector3d(0, 0, 0.12 - 0.08 * t); }});
  all.push_back({"a cradle", scene("newtons_cradle")});
  all.push_back({"many bodies", scene("many_bodies"), {}, about_the_room});
  all.push_back(
      {"bowls and bars", scene("materials_bench"), {}, [](double t) { return Vector3d(0.16, 0.35 - t, 0.03); }});
  return all;
}

// The world that the child process continues.
World world_named(const std::string& name) {
  for (World& w : made_worlds())
    if (w.name == name) return w;
  throw std::runtime_error("no such world");
}

Bytes contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

struct Folder {
  Folder() : path(std::filesystem::temp_directory_path() / ("tactus_state_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path path;
};

constexpr int kMore = 250;

}  // namespace

TEST_CASE("A restored state continues bit-identically in the same or another simulation") {
  for (const World& w : worlds()) {
    INFO(w.name);
    Simulation s(w.def, w.settings);
    s.start(11);
    Hand hand{.radius = 0.01, .last = w.path(0)};
    std::mt19937 random(3);
    for (int round = 0; round < 3; ++round) {
      run(s, hand, w.path, 40 + static_cast<int>(random() % 150));
      const Bytes state = s.save();
      CHECK(s.save() == state);
      const Hand before = hand;
      const std::uint64_t truth = run(s, hand, w.path, kMore);
      Hand again = before;
      REQUIRE(s.restore(state) == "");
      CHECK(s.save() == state);
      CHECK(run(s, again, w.path, kMore) == truth);
      Simulation other(w.def, w.settings);
      other.start(12);
      Hand elsewhere = before;
      run(other, elsewhere, w.path, 17);
      elsewhere = before;
      REQUIRE(other.restore(state) == "");
      CHECK(run(other, elsewhere, w.path, kMore) == truth);
    }
  }
}

TEST_CASE("continues a state in a process of its own", "[.]") {
  const std::filesystem::path folder = std::getenv("TACTUS_STATE_FOLDER");
  const World w = world_named(std::getenv("TACTUS_STATE_WORLD"));
  Simulation s(w.def, w.settings);
  s.start(99);
  REQUIRE(s.restore(contents(folder / "state")) == "");
  Hand none{.radius = 0.01, .last = w.path(0)};
  std::ofstream(folder / "hash") << run(s, none, w.path, kMore);
}

TEST_CASE("A restored state continues identically in another process") {
  const Folder folder;
  for (const char* name : {"a chain with springs, and a ball", "a motor and bouncing balls"}) {
    INFO(name);
    const World w = world_named(name);
    Simulation s(w.def, w.settings);
    s.start(11);
    Hand hand{.radius = 0.01, .last = w.path(0)};
    run(s, hand, w.path, 120);
    const Bytes state = s.save();
    std::ofstream(folder.path / "state", std::ios::binary)
        .write(reinterpret_cast<const char*>(state.data()), static_cast<std::streamsize>(state.size()));
    const std::uint64_t truth = run(s, hand, w.path, kMore);
    setenv("TACTUS_STATE_FOLDER", folder.path.c_str(), 1);
    setenv("TACTUS_STATE_WORLD", name, 1);
    std::string program = "/proc/self/exe", test = "continues a state in a process of its own";
    char* words[] = {program.data(), test.data(), nullptr};
    pid_t child = 0;
    int status = -1;
    REQUIRE(posix_spawn(&child, std::filesystem::read_symlink(program).c_str(), nullptr, nullptr, words,
                        environ) == 0);
    REQUIRE(waitpid(child, &status, 0) == child);
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
    std::uint64_t theirs = 0;
    std::ifstream(folder.path / "hash") >> theirs;
    CHECK(theirs == truth);
  }
}

TEST_CASE("A damaged or foreign state is rejected with a message and changes nothing") {
  const WorldDef w = stack();
  Simulation s(w, {});
  s.start(11);
  Hand hand{.radius = 0.01, .last = {-0.2, 0, 0.2}};
  const Path path = [](double t) { return Vector3d(-0.12 + 0.1 * t, 0, 0.2); };
  run(s, hand, path, 100);
  const Bytes earlier = s.save();
  run(s, hand, path, 100);
  const Bytes now = s.save();
  const auto restore_error = [&](const Bytes& bytes) {
    const std::string why = s.restore(bytes);
    CHECK(!why.empty());
    CHECK(s.save() == now);
    return why;
  };
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    Bytes damaged = earlier;
    damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
    restore_error(damaged);
    restore_error(Bytes(earlier.begin(), earlier.begin() + static_cast<std::ptrdiff_t>(random() % earlier.size())));
  }
  CHECK_THAT(restore_error({}), Catch::Contains("not a saved state"));
  Bytes version = earlier;
  ++version[8];
  CHECK_THAT(restore_error(version), Catch::Contains("version"));
  Simulation other(motor(), {});
  other.start(11);
  CHECK_THAT(restore_error(other.save()), Catch::Contains("another scene"));
  Simulation set_otherwise(w, exact());
  set_otherwise.start(11);
  CHECK_THAT(restore_error(set_otherwise.save()), Catch::Contains("other settings"));
  CHECK(s.restore(earlier) == "");
}

TEST_CASE("A state with impossible values is rejected and changes nothing") {
  const WorldDef w = stack();
  Simulation s(w, {});
  s.start(11);
  Hand hand{.radius = 0.01, .last = {-0.2, 0, 0.2}};
  const Path path = [](double t) { return Vector3d(-0.12 + 0.1 * t, 0, 0.2); };
  run(s, hand, path, 150);
  const Bytes now = s.save();
  std::uint64_t fingerprint = 0;
  std::memcpy(&fingerprint, now.data() + 16, sizeof fingerprint);
  const std::span<const std::uint8_t> state = unwrap_state(now, fingerprint);
  std::mt19937_64 random(6);
  int refusals = 0;
  for (std::size_t word = 0; word + 8 <= state.size(); word += 8)
    for (const std::uint64_t poison :
         {std::uint64_t{0x7ff8000000000000}, ~std::uint64_t{0}, std::uint64_t{random()}}) {
      Bytes poisoned(state.begin(), state.end());
      std::memcpy(poisoned.data() + word, &poison, sizeof poison);
      const std::string why = s.restore(wrap_state(poisoned, fingerprint));
      refusals += !why.empty();
      if (why.empty()) REQUIRE(s.restore(now) == "");  // a valid number
      REQUIRE(s.save() == now);
    }
  CHECK(refusals > 500);
}

TEST_CASE("A world that is reset repeats its first run") {
  for (const World& w : worlds()) {
    INFO(w.name);
    Simulation s(w.def, w.settings);
    s.start(11);
    Hand hand{.radius = 0.01, .last = w.path(0)};
    const Hand before = hand;
    const std::uint64_t first = run(s, hand, w.path, 200);
    s.reset();
    Hand again = before;
    CHECK(run(s, again, w.path, 200) == first);
  }
}

TEST_CASE("A world of a new incarnation has new contact ids and no old forces") {
  WorldDef w = empty_world();
  add_floor(w);
  const int ball = add_ball(w, 0.2, 0.05, {0, 0, 0.05});
  add_tool(w, {0, 0, 0.2});
  Simulation s(w, {});
  s.start(11);
  Hand hand{.radius = 0.01, .last = {0, 0, 0.2}};
  run(
      s, hand, [](double t) { return Vector3d(0, 0, std::max(0.105, 0.2 - 0.5 * t)); }, 400);
  std::vector<contact_t> contacts;
  s.body_contacts(contacts);
  REQUIRE(contacts.size() == 1);
  REQUIRE(s.tool_contacts().size() == 1);
  const std::int64_t old_id = contacts[0].contact_id, old_touch = s.tool_contacts()[0].contact_id;
  const Bytes state = s.save();
  run(
      s, hand, [](double) { return Vector3d(0, 0, 0.105); }, 100);
  REQUIRE(s.restore(state) == "");
  s.begin_incarnation(12);
  const std::int64_t mask = (std::int64_t{1} << 40) - 1;
  s.body_contacts(contacts);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].contact_id == sync::prefixed_id(12, old_id & mask));
  CHECK(s.tool_contacts()[0].contact_id == sync::prefixed_id(12, old_touch & mask));
  // Messages of the old incarnation push nothing: the hand still uses the old contact ids.
  const Vector3d before = s.bodies()[static_cast<std::size_t>(ball)].position_m;
  touch_model_t old_model = s.touch_models()[0];
  for (touch_plane_t& p : old_model.planes) p.contact_id = old_touch;
  for (int i = 0; i < 20; ++i) {
    s.step(std::vector{hand.tick(old_model, {0, 0, 0.1}, sync::to_ns(s.now()))});
    CHECK(s.touch_models()[0].applied.empty());
  }
  CHECK((s.bodies()[static_cast<std::size_t>(ball)].position_m - before).norm() < 1e-4);
  // The contact that the hand has left meanwhile ends.
  bool ended = false;
  for (int i = 0; i < 100; ++i) {
    s.step(std::vector{hand.tick(s.touch_models()[0], {0, 0, 0.5}, sync::to_ns(s.now()))});
    for (const contact_event_t& e : s.events())
      ended = ended || (e.kind == contact_event_t::END && e.contact_id == sync::prefixed_id(12, old_touch & mask));
  }
  CHECK(ended);
  CHECK(s.tool_contacts().empty());
}
