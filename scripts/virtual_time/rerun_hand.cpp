// rerun_hand: the hand of a recorded run.
//
//   in   TOUCH_MODEL     the first one is the begin of the path, and the clock of the commands
//        DEVICE_FORCE    the force on the hand
//   out  DEVICE_STATE    the pose of the hand, a thousand times a second
//        SIM_COMMAND     the commands of the recorded run, at their times
//
// When DEVICE_FORCE is lost, the hand is free after 20 ms.
#include "scripts/virtual_time/rerun_hand.h"

#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "haptic_node/devices/motion_file.h"
#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"
#include "sync/log/log_feed.h"
#include "sync/node/node.h"

namespace tactus {
namespace {

const sync::NodeDescriptor kRerunHand{.name = "rerun_hand",
                                      .modality = "",
                                      .rate_Hz = 1000,
                                      .fifo_priority = 55,
                                      .about = "The hand of a recorded run, in place of a person."};

// The hand at each tick, as the state of its device.
void fill_state(device_state_t& state, const haptic::DeviceState& hand) {
  state.header.sim_time_ns = -1;
  state.pose.position_m = {hand.position.x(), hand.position.y(), hand.position.z()};
  state.pose.orientation.w = 1;
  state.velocity_m_s = {static_cast<float>(hand.velocity.x()), static_cast<float>(hand.velocity.y()), static_cast<float>(hand.velocity.z())};
  state.state = device_state_t::ANSWERS;
}

}  // namespace

std::optional<Eigen::Vector3d> DelayedForce::take(sync::HostTime now) {
  std::optional<Eigen::Vector3d> newest;
  for (; !waiting_.empty() && waiting_.front().first <= now; waiting_.pop_front()) newest = waiting_.front().second;
  return newest;
}

haptic::DeviceState RerunHand::tick(sync::HostTime now) {
  const haptic::DeviceState state = hand_.read(now);
  if (const auto force_N = felt_.take(now)) {
    hand_.write(haptic::Wrench{*force_N, Eigen::Vector3d::Zero()});
    renewed_ = now;
  } else if (renewed_ && now - *renewed_ >= haptic::Device::kWatchdog) {  // the hand itself watches only its readings
    hand_.write(haptic::Wrench{});
    renewed_.reset();
  }
  return state;
}

std::vector<RecordedCommand> recorded_commands(const std::string& log, int run) {
  const sync::LogFeed feed(log, kRerunHand.rate_Hz, run);
  sync::TimestampedEvents events = feed.from_begin();
  std::vector<RecordedCommand> commands;
  std::optional<sync::HostTime> begin;
  sync::LogEvent e;
  for (sync::HostTime arrival{}; events.next(e, arrival);) {
    if (!begin && e.channel == channels::kTouchModel) begin = arrival;
    if (e.channel != channels::kSimCommand) continue;
    if (const auto m = sync::decode<sim_command_t>(e.data.data(), e.data.size()))
      commands.push_back({begin ? arrival - *begin : sync::Nanoseconds(0), *m});
  }
  return commands;
}

int run_rerun_hand(int argc, char** argv) try {
  sync::Arguments app;
  sync::NodeOptions options;
  std::string device, motion, log;
  haptic::HandImpedance hand_def;
  double force_delay_s = 0;
  int run = 1;
  options.add_to(app, kRerunHand);
  app.add_option("--device", device, "name of the device that it holds: haptic_node --device external:NAME");
  app.add_option("--motion", motion, "CSV of the intention over simulated time: time_s,x_m,y_m,z_m; needed with --device");
  app.add_option("--mass", hand_def.mass_kg, "mass of the hand, kg").range(0.001, 5.0).show_default();
  app.add_option("--damping", hand_def.damping_N_s_m, "damper between hand and intention, N s/m").range(0.01, 200.0).show_default();
  app.add_option("--stiffness", hand_def.stiffness_N_m, "spring between hand and intention, N/m").range(1.0, 5000.0).show_default();
  app.add_option("--force-delay", force_delay_s, "delay of the force after its arrival, s").range(0.0, 0.1).show_default();
  app.add_option("--commands", log, "log whose commands to the simulation are repeated");
  app.add_option("--run", run, "number of the run, of a log with several").range(1, 1'000'000).show_default();
  sync::parse_or_exit(app, kRerunHand.name, argc, argv);
  if (device.empty() != motion.empty()) throw std::runtime_error("--device and --motion belong together; give both or neither");

  std::optional<RerunHand> hand;
  if (!motion.empty()) {
    haptic::Motion path = haptic::read_motion(motion);
    hand.emplace(haptic::MonotoneCubic(std::move(path.times_s), std::move(path.positions_m), haptic::MonotoneCubic::Ends::kRest), hand_def,
                 sync::from_seconds(force_delay_s));
  }
  const std::vector<RecordedCommand> commands = log.empty() ? std::vector<RecordedCommand>{} : recorded_commands(log, run);
  std::size_t next_command = 0;
  sync::Node node(kRerunHand, options);
  auto& models = node.bus().queue<touch_model_t>(channels::kTouchModel, 64);
  auto& forces = node.bus().queue<device_force_t>(channels::kDeviceForce, 64);
  std::optional<sync::HostTime> begin;  // arrival of the first touch model
  device_state_t state{};
  state.device = device;
  node.set_state(node_health_t::RUNNING);
  while (node.running()) {
    const sync::HostTime now = node.wait();
    while (const auto m = models.pop())
      if (!begin && m->message.header.run_id == options.run_id) {
        begin = m->arrival;
        // The path is over simulated time.
        if (hand) hand->begin(sync::host_time(m->message.clock.host_ns) - sync::Nanoseconds(m->message.clock.sim_ns));
      }
    while (const auto m = forces.pop())
      if (hand && m->message.device == device && m->message.header.run_id == options.run_id)
        hand->push(m->arrival, {m->message.force_N.x, m->message.force_N.y, m->message.force_N.z});
    if (hand) {
      fill_state(state, hand->tick(now));
      node.bus().publish(channels::kDeviceState, state);
    }
    for (; begin && next_command < commands.size() && now - *begin >= commands[next_command].after; ++next_command) {
      sim_command_t command = commands[next_command].command;
      command.header.sim_time_ns = -1;
      node.bus().publish(channels::kSimCommand, command);
    }
  }
  return 0;
} catch (const std::exception& e) {
  return sync::fail(kRerunHand.name, e);
}

}  // namespace tactus
