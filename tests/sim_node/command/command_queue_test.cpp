#include "sim_node/command/command_queue.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <tactus/sim_reply_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;

namespace {

constexpr std::int64_t kRun = 7;

struct Desk {
  WorldDef world = empty_world();
  Simulation simulation{world, {}};
  Commander commander{simulation, world, std::filesystem::temp_directory_path()};
  sync::Queue<sim_command_t> commands{channels::kSimCommand, 256};
  std::int64_t seq = 0;

  Desk() { simulation.start(1); }
  void send(std::int64_t id, std::int8_t kind, std::int64_t run_id = kRun) {
    sim_command_t c{};
    c.header.run_id = run_id, c.header.incarnation = 9 + run_id, c.header.seq = ++seq;
    c.id = id, c.kind = kind;
    const auto bytes = sync::encode(c);
    commands.accept(bytes.data(), bytes.size(), sync::host_time(1'000'000'000 + seq));
  }
  // The commands that one tick executes.
  std::set<std::int64_t> tick() {
    execute_commands(commands, commander, kRun);
    std::set<std::int64_t> ids;
    for (const sim_reply_t& r : commander.take_replies()) ids.insert(r.id);
    return ids;
  }
};

}  // namespace

TEST_CASE("Commands of other runs cost nothing: any number of them delays no command of this run") {
  Desk desk;
  for (int i = 0; i < 250; ++i) desk.send(1000 + i, i % 2 == 0 ? sim_command_t::RESET : sim_command_t::PAUSE, kRun + 1 + i % 5);
  desk.send(1, sim_command_t::PAUSE);
  CHECK(desk.tick() == std::set<std::int64_t>{1});
  CHECK(desk.commander.paused());
  CHECK(desk.tick().empty());
}

TEST_CASE("A tick executes at most four commands, and one that copies the state takes all of it") {
  Desk desk;
  for (int i = 1; i <= 6; ++i) desk.send(i, sim_command_t::PAUSE);
  CHECK(desk.tick() == std::set<std::int64_t>{1, 2, 3, 4});
  CHECK(desk.tick() == std::set<std::int64_t>{5, 6});
  desk.send(7, sim_command_t::RESET);
  desk.send(8, sim_command_t::PAUSE);
  CHECK(desk.tick() == std::set<std::int64_t>{7});
  CHECK(desk.tick() == std::set<std::int64_t>{8});
}
