// Driver of a device without code in haptic_node: it publishes the pose of the device and exerts the force that it
// receives.
//
//    device_driver [NAME [GROUP [PORT [RUN]]]]        together with: haptic_node --device external:NAME
//
// RUN is the number of the cluster run, whose forces it obeys. tactus attach sets GROUP, PORT and RUN by the
// variables TACTUS_GROUP, TACTUS_PORT and TACTUS_RUN_ID.
//
//    out  DEVICE_STATE   1000 times per second
//    in   DEVICE_FORCE   within the limits of guards.h; the force is 0 when no new message arrives in time
//
// It needs LCM, the generated types and guards.h, nothing else of Tactus. The hardware here is a weight of 0.1 kg that a
// spring and a damper hold 5 mm below the level of a floor; for a real device replace `Hardware`.
#include <lcm/lcm-cpp.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <random>
#include <string>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>
#include <thread>

#include "guards.h"

namespace {

using tactus::examples::Exerted;
using tactus::examples::ForceGuard;
using tactus::examples::Reason;
using Clock = std::chrono::steady_clock;  // CLOCK_MONOTONIC on Linux, as header_t requires
std::int64_t to_ns(Clock::time_point t) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(t.time_since_epoch()).count();
}

// Simulated hardware; replace it for a real device. Along z only, in m, m/s, N.
struct Hardware {
  double z = 0.05, velocity = 0, force = 0;

  void read_encoders(double dt) {
    constexpr double kMass_kg = 0.1, kDamping_Ns_m = 10, kStiffness_N_m = 300, kRest_m = -0.005;
    velocity += dt / kMass_kg * (force - kDamping_Ns_m * velocity - kStiffness_N_m * (z - kRest_m));
    z += dt * velocity;
  }
  void command_motors(double force_N) { force = force_N; }
  int buttons() const { return 0; }
  bool answers() const { return true; }
};

// Forces for this device, from any sender: the guard decides which are commands.
struct Forces {
  std::string device;
  ForceGuard guard;

  void on_message(const lcm::ReceiveBuffer*, const std::string&, const tactus::device_force_t* m) {
    if (m->device != device) return;
    const tactus::header_t& h = m->header;
    guard.on_message({h.run_id, h.incarnation, h.seq, h.publish_time_ns}, {m->force_N.x, m->force_N.y, m->force_N.z},
                     {m->torque_N_m.x, m->torque_N_m.y, m->torque_N_m.z}, m->valid_for_ns, to_ns(Clock::now()));
  }
};

// A flood of messages must not hold the loop: at most this number is read in a tick.
constexpr int kMaxMessages = 100;

}  // namespace

int main(int argc, char** argv) {
  // An argument, or else the variable of the environment, which tactus attach sets, or else the default.
  const auto argument = [&](int i, const char* default_value, const char* variable = nullptr) {
    const char* set = variable ? std::getenv(variable) : nullptr;
    return std::string(argc > i ? argv[i] : set ? set : default_value);
  };
  if (argument(1, "").starts_with("-")) {
    std::cout << "Usage: device_driver [NAME [GROUP [PORT [RUN]]]]\nDrives the device NAME (arm) for haptic_node "
                 "--device "
                 "external:NAME until it is ended; inside a running cluster: tactus attach device_driver NAME\n";
    return argument(1, "") == "--help" ? 0 : 1;
  }
  const std::int64_t run = std::stoll(argument(4, "1", "TACTUS_RUN_ID"));
  Forces forces{argument(1, "arm"), ForceGuard({}, {.run = run})};
  // ttl=0: messages stay on this machine.
  lcm::LCM bus("udpm://" + argument(2, "239.255.76.67", "TACTUS_GROUP") + ":" + argument(3, "7667", "TACTUS_PORT") + "?ttl=0");
  if (!bus.good()) {
    std::cerr << "device_driver: cannot open the bus; check that the network lets multicast through\n";
    return 1;
  }
  bus.subscribe("DEVICE_FORCE", &Forces::on_message, &forces);

  tactus::device_state_t state{};  // LCM initialises nothing by itself
  state.device = forces.device;
  state.header.sim_time_ns = -1;
  state.header.run_id = run;
  // A new number at every start distinguishes a restarted driver from one whose clock was set back.
  std::random_device random;
  state.header.incarnation = std::uniform_int_distribution<std::int64_t>(1, INT64_MAX)(random);
  state.pose.orientation.w = 1;

  Hardware hardware;
  Reason reported = Reason::kNone;
  // Ticks that were missed, as after a stop of the process, are not made up for.
  for (Clock::time_point next = Clock::now();; next = std::max(next + std::chrono::milliseconds(1), Clock::now())) {
    std::this_thread::sleep_until(next);
    for (int left = kMaxMessages; left > 0 && bus.handleTimeout(0) > 0; --left) continue;
    hardware.read_encoders(1e-3);
    const double velocity = hardware.answers() ? hardware.velocity : std::numeric_limits<double>::quiet_NaN();
    const Exerted out = forces.guard.update(to_ns(Clock::now()), {0, 0, velocity});
    hardware.command_motors(out.force[2]);
    if (out.reason != reported && out.reason == Reason::kSecondSender)
      std::cerr << "device_driver: two programs send DEVICE_FORCE for " << forces.device
                << ", so its force is zero; end one of them\n";
    reported = out.reason;

    state.pose.position_m.z = hardware.z;
    state.velocity_m_s.z = static_cast<float>(hardware.velocity);
    state.buttons = hardware.buttons();
    state.state = hardware.answers() ? tactus::device_state_t::ANSWERS : tactus::device_state_t::LOST;
    state.header.publish_time_ns = to_ns(Clock::now());
    bus.publish("DEVICE_STATE", &state);
    ++state.header.seq;
  }
}
