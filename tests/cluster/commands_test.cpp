// Tests of commands to the simulation of a running cluster, sent by the command line program.
#include <tactus/body_state_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/world_state_t.hpp>

#include "tests/cluster/support/profiles.h"

using namespace tactus;
using namespace tactus::cluster;

namespace {

// A cluster and a subscriber to its touch models, which come with every step and carry the map of simulated time.
struct CommandedCluster : RunningCluster {
  sync::Queue<touch_model_t>& models = monitor.bus().queue<touch_model_t>(channels::kTouchModel, 8192);
  std::optional<touch_model_t> newest;
  int call_count = 0;

  // Runs the program and returns its output.
  std::string run_command(const std::vector<std::string>& words, int wanted_status = 0) {
    const std::string name = "simulation" + std::to_string(++call_count);
    std::vector<std::string> command{programs() / "simulation", "--run-id", std::to_string(kRunId)};
    command.insert(command.end(), words.begin(), words.end());
    processes.spawn(name, command);
    const int status = processes.wait_for_exit(name, kTimeout_s);
    INFO(processes.output(name));
    CHECK(status == wanted_status);
    return processes.output(name);
  }
  void receive_for(double seconds) {
    monitor.receive_for(seconds);
    while (auto m = models.pop()) newest = m->message;
  }
  std::int64_t sim_ns() { return newest ? newest->header.sim_time_ns : -1; }
  bool wait_for(const std::function<bool()>& condition) {
    for (double waited = 0; waited < kTimeout_s; waited += 0.2) {
      receive_for(0.2);
      if (condition()) return true;
    }
    return false;
  }
  // Number of events that a modality has presented so far.
  std::size_t presented(const std::string& modality) const {
    const auto it = monitor.presented().find(modality);
    return it == monitor.presented().end() ? 0 : it->second.size();
  }
};

}  // namespace

TEST_CASE("A paused world stands still while every process runs, takes single steps, and resumes", "[smoke]") {
  CommandedCluster c;
  c.start();
  CHECK_THAT(c.run_command({"step"}, 1), Catch::Contains("pause it"));
  CHECK_THAT(c.run_command({"pause"}), Catch::Contains("is paused at"));
  c.receive_for(0.5);
  const std::int64_t paused_ns = c.sim_ns();
  c.receive_for(2);
  CHECK(c.sim_ns() == paused_ns);
  CHECK(c.newest->clock.rate == 0);
  UNSCOPED_INFO(c.log_text());
  CHECK(c.wait_for([&] { return c.all_running(kNodes); }));
  CHECK(c.monitor.force_N() <= 8);
  CHECK_THAT(c.run_command({"step", "25"}), Catch::Contains("25 steps"));
  CHECK(c.wait_for([&] { return c.sim_ns() == paused_ns + 25'000'000; }));
  c.receive_for(0.5);
  CHECK(c.sim_ns() == paused_ns + 25'000'000);
  CHECK_THAT(c.run_command({"resume"}), Catch::Contains("resumes at"));
  const std::int64_t hits = c.monitor.hits();
  CHECK(c.wait_for([&] { return c.monitor.hits() > hits + 2; }));
  CHECK(c.newest->clock.rate > 0.5);
  for (const char* sense : {"haptic", "audio", "visual"}) {
    const std::size_t before = c.presented(sense);
    CHECK(c.wait_for([&] { return c.presented(sense) > before + 2; }));
  }
}

TEST_CASE("After a reset or restore every modality starts with the new world, and drops the contacts of the old one") {
  CommandedCluster c;
  c.start();
  c.receive_for(1);
  CHECK_THAT(c.run_command({"snapshot", "early", "--to-file"}), Catch::Contains("early.state"));
  c.receive_for(2);
  const std::set<std::int64_t> old_ids = c.monitor.contact_ids();
  const std::int64_t late_ns = c.sim_ns(), old_incarnation = c.newest->header.incarnation;
  CHECK(!old_ids.empty());

  const auto check_new_incarnation = [&](std::int64_t incarnation, std::int64_t before_ns) {
    CHECK(c.wait_for([&] { return c.newest->header.incarnation != incarnation; }));
    CHECK(c.sim_ns() < before_ns);
    CHECK(c.newest->clock.rate > 0.5);
    std::map<std::string, std::size_t> presented;
    for (const char* sense : {"haptic", "audio", "visual"}) presented[sense] = c.presented(sense);
    for (const auto& [sense, before] : presented) {
      INFO(sense);
      CHECK(c.wait_for([&, &of = sense, first = before] { return c.presented(of) > first + 1; }));
    }
    for (const std::int64_t id : c.monitor.contact_ids()) CHECK(!old_ids.contains(id));
    CHECK(c.wait_for([&] { return c.all_running(kNodes); }));
    for (const std::string& node : kNodes) CHECK(c.monitor.malformed(node) == 0);
  };
  CHECK_THAT(c.run_command({"reset"}), Catch::Contains("first instant"));
  check_new_incarnation(old_incarnation, late_ns);
  CHECK(c.monitor.rejoined("sim_node") == 1);

  c.receive_for(2);
  const std::int64_t second_incarnation = c.newest->header.incarnation;
  CHECK_THAT(c.run_command({"restore", "early"}), Catch::Contains("\"early\""));
  check_new_incarnation(second_incarnation, c.sim_ns() + 1);
  CHECK(c.monitor.rejoined("sim_node") == 2);

  // A restarted simulation loads it from its file.
  c.processes.kill("sim_node");
  c.processes.start("sim_node", {tapping_scene()});
  CHECK(c.monitor.wait_until([&] { return c.is_running("sim_node"); }, kTimeout_s));
  CHECK_THAT(c.run_command({"restore", "early"}), Catch::Contains("\"early\""));
  CHECK_THAT(c.run_command({"restore", "never"}, 1), Catch::Contains("no file"));
}

TEST_CASE("Set and push commands move bodies of a running cluster, and impossible commands are rejected with one sentence") {
  CommandedCluster c;
  auto& states = c.monitor.bus().queue<world_state_t>(channels::kWorldState, 4096);
  c.start();
  CHECK_THAT(c.run_command({"set", "steel_ball.mass", "0.3"}), Catch::Contains("steel_ball.mass"));
  CHECK_THAT(c.run_command({"set", "steel_ball.mass", "-1"}, 1), Catch::Contains("between"));
  CHECK_THAT(c.run_command({"set", "floor.mass", "1"}, 1), Catch::Contains("fixed"));
  CHECK_THAT(c.run_command({"set", "nothing", "1"}, 1), Catch::Contains("names no property"));
  CHECK_THAT(c.run_command({"push", "nobody", "1", "0", "0"}, 1), Catch::Contains("nobody"));
  CHECK_THAT(c.run_command({"set", "world.gravity", "0", "0", "-1.62"}), Catch::Contains("world.gravity"));
  CHECK_THAT(c.run_command({"push", "steel_ball", "0", "0", "-1", "--torque", "0", "0.001", "0", "--seconds", "0.3"}),
             Catch::Contains("pushed"));
  CHECK_THAT(c.run_command({"push", "steel_ball", "0", "0", "12", "--seconds", "0.2"}), Catch::Contains("pushed"));
  double highest = 0;
  CHECK(c.monitor.wait_until(
      [&] {
        while (const auto m = states.pop())
          for (const body_state_t& b : m->message.bodies)
            if (b.body == 1) highest = std::max(highest, b.position_m.z);
        return highest > 0.5;
      },
      kTimeout_s));
  CHECK(c.wait_for([&] { return c.all_running(kNodes); }));
}
