// simulation: sends one request to the simulation of the running cluster, and prints the result.
#include <iostream>
#include <stdexcept>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>

#include "sync/bus/request_reply.h"
#include "sync/bus/bus_arguments.h"
#include "sync/bus/bus.h"
#include "sync/node/node_options.h"
#include "sync/text/printable.h"

using namespace tactus;

namespace {

constexpr sync::Nanoseconds kTimeout{
    3'000'000'000};                                // an answer comes with the next step; a file may take a while
constexpr std::size_t kMaxValues = 6;

// "steel_ball.mass": object and property.
void split(const std::string& text, sim_command_t& c) {
  const std::size_t dot = text.rfind('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == text.size())
    throw std::invalid_argument("\"" + sync::printable(text) +
                                "\" names no property; write for example steel_ball.mass");
  c.name = text.substr(0, dot);
  c.property = text.substr(dot + 1);
}

struct Words {
  std::string name;
  int steps = 1;
  std::vector<double> values, force_N, torque_N_m{0, 0, 0};
  double seconds = 0.1;
  bool to_file = false;
};

void add_commands(sync::Arguments& app, Words& w) {
  app.add_command("pause", "pauses the world; hands feel its surfaces, which do not yield");
  app.add_command("resume", "continues the simulation");
  app.add_command("step", "number of steps of 1 ms of a paused world")
      .add_option("N", w.steps).range(1, 1'000'000).show_default();
  app.add_command("reset", "back to the first instant of the scene");
  sync::Arguments set =
      app.add_command("set", "sets a property of a body, a joint or the world; docs/commands.md lists them");
  set.add_option("NAME.PROPERTY", w.name, "for example steel_ball.mass, fan::axle.motor, world.gravity").required();
  set.add_option("VALUE", w.values, "in SI units").required().expected(1, kMaxValues);
  sync::Arguments push = app.add_command("push", "a force on a body at its centre of mass");
  push.add_option("BODY", w.name).required();
  push.add_option("FORCE", w.force_N, "FX FY FZ, N, along the axes of the world").required().expected(3);
  push.add_option("--torque", w.torque_N_m, "TX TY TZ, N m").expected(3);
  push.add_option("--seconds", w.seconds, "duration, s").range(0.001, 10.0).show_default();
  sync::Arguments snapshot = app.add_command("snapshot", "stores the state of the world under a name");
  snapshot.add_option("NAME", w.name).required();
  snapshot.add_flag("--to-file", w.to_file, "also in a file of the run's folder");
  app.add_command("restore", "restores a stored state").add_option("NAME", w.name).required();
}

sim_command_t command_of(const std::string& verb, const Words& w) {
  sim_command_t c{};
  c.header.sim_time_ns = -1;
  c.header.run_id = c.header.incarnation = 1;  // the bus stamps them; a header without is not valid
  c.id = sync::request_id();
  c.name = w.name;
  constexpr const char* kVerbs[] = {"pause", "resume", "step", "reset", "set", "push", "snapshot", "restore"};
  for (std::size_t i = 0; i < std::size(kVerbs); ++i)
    if (verb == kVerbs[i]) c.kind = static_cast<std::int8_t>(i);
  if (verb == "step") c.steps = w.steps;
  if (verb == "set") {
    split(w.name, c);
    c.values = w.values;
    c.count = static_cast<std::int8_t>(c.values.size());
  }
  if (verb == "push") {
    c.force_N = {w.force_N[0], w.force_N[1], w.force_N[2]};
    c.torque_N_m = {w.torque_N_m[0], w.torque_N_m[1], w.torque_N_m[2]};
    c.duration_ns = sync::from_seconds(w.seconds).count();
  }
  c.to_file = w.to_file ? 1 : 0;
  if (!valid(c))
    throw std::invalid_argument(
        "a name is too long or has unprintable characters, or a number is out of range");
  return c;
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app("Sends one command to the simulation of the running cluster, and prints the result.");
  sync::BusOptions bus_options;
  std::int64_t run_id = 1;
  Words words;
  sync::add_bus_options(app, bus_options);
  app.add_option("--run-id", run_id, "number of the cluster run").environment("TACTUS_RUN_ID").show_default();
  add_commands(app, words);
  sync::parse_or_exit(app, "simulation", argc, argv);
  sim_command_t command = command_of(app.command(), words);

  sync::Bus bus(sync::Identity::fresh("simulation", run_id), bus_options);
  auto& replies = bus.queue<sim_reply_t>(channels::kSimReply, 256);
  const auto reply = sync::request(bus, channels::kSimCommand, command, replies, kTimeout);
  if (!reply)
    throw std::runtime_error("no sim_node answers on this bus; run it inside the cluster: tactus simulate");
  if (!reply->done) throw std::runtime_error(sync::printable(reply->text));
  std::cout << sync::printable(reply->text) << std::endl;
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("simulation", e);
}
