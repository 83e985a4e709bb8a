// Driver of a 3D mouse as a device without force, by libspnav: a head for the view, a wand for the lamp, or a hand without force feedback.
//
//    spacenav [NAME [GROUP [PORT [RUN]]]]        together with: haptic_node --tool TOOL --device external:NAME
//
//    out  DEVICE_STATE   250 times per second
//
// A missing daemon is tried again every second; meanwhile the state of the device is LOST.
#include <spnav.h>
#include <sys/socket.h>

#include <lcm/lcm-cpp.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <tactus/device_state_t.hpp>
#include <thread>

#include "push_motion.h"

namespace {

using Clock = std::chrono::steady_clock;  // CLOCK_MONOTONIC on Linux, as header_t requires
constexpr auto kPeriod = std::chrono::milliseconds(4);
constexpr auto kRetryPeriod = std::chrono::seconds(1);
constexpr double kHalf_m = 0.5;  // range to each side of its origin (design: the reach of an arm)

// The connection to spacenavd.
class Daemon {
 public:
  bool is_connected() const { return connected_; }
  void poll_connection(Clock::time_point now) {
    if (connected_ || now < next_try_) return;
    next_try_ = now + kRetryPeriod;
    connected_ = spnav_open() != -1;
    if (connected_)
      std::cerr << "spacenav: connected to the daemon\n";
    else if (!said_)
      std::cerr << "spacenav: no spacenavd answers, so the 3D mouse is lost; install and start it (apt install "
                   "spacenavd), "
                   "the driver tries to connect every second\n";
    said_ = true;
  }
  // Reads the events that have arrived.
  void read(tactus::examples::PushMotion& motion) {
    if (!connected_) return;
    char byte = 0;
    if (recv(spnav_fd(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0) {  // the daemon has ended
      spnav_close();
      connected_ = false;
      std::cerr << "spacenav: the daemon has ended; the driver tries to connect every second\n";
      return;
    }
    for (spnav_event e; spnav_poll_event(&e) != 0;) {
      if (e.type == SPNAV_EVENT_MOTION)
        motion.push(e.motion.x, e.motion.y, e.motion.z, e.motion.rx, e.motion.ry, e.motion.rz);
      else if (e.type == SPNAV_EVENT_BUTTON)
        motion.press(e.button.bnum, e.button.press != 0);
    }
  }

 private:
  bool connected_ = false, said_ = false;
  Clock::time_point next_try_{};
};

}  // namespace

int main(int argc, char** argv) {
  // An argument, or else the variable of the environment, which tactus attach sets, or else the default.
  const auto argument = [&](int i, const char* default_value, const char* variable = nullptr) {
    const char* set = variable ? std::getenv(variable) : nullptr;
    return std::string(argc > i ? argv[i] : set ? set : default_value);
  };
  if (argument(1, "").starts_with("-")) {
    std::cout << "spacenav [NAME [GROUP [PORT [RUN]]]]: a 3D mouse as the device NAME (head); beside it: "
                 "haptic_node --tool "
                 "TOOL --device external:NAME\n";
    return 0;
  }
  // ttl=0: messages stay on this machine.
  lcm::LCM bus("udpm://" + argument(2, "239.255.76.67", "TACTUS_GROUP") + ":" + argument(3, "7667", "TACTUS_PORT") + "?ttl=0");
  if (!bus.good()) {
    std::cerr << "spacenav: cannot open the bus; check that the network lets multicast through\n";
    return 1;
  }
  tactus::device_state_t state{};  // LCM initialises nothing by itself
  state.device = argument(1, "head");
  state.header.sim_time_ns = -1;
  state.header.run_id = std::stoll(argument(4, "1", "TACTUS_RUN_ID"));
  std::random_device random;
  state.header.incarnation = std::uniform_int_distribution<std::int64_t>(1, INT64_MAX)(random);

  Daemon daemon;
  tactus::examples::PushMotion motion(kHalf_m);
  // Ticks that were missed, as after a stop of the process, are not made up for.
  for (Clock::time_point next = Clock::now();; next = std::max(next + kPeriod, Clock::now())) {
    std::this_thread::sleep_until(next);
    daemon.poll_connection(Clock::now());
    daemon.read(motion);
    motion.step(std::chrono::duration<double>(kPeriod).count());

    const auto& [x, y, z] = motion.position_m();
    const auto& [vx, vy, vz] = motion.velocity_m_s();
    const auto& [wx, wy, wz] = motion.spin_rad_s();
    const auto& [a, b, c, d] = motion.orientation();
    state.pose.position_m.x = x, state.pose.position_m.y = y, state.pose.position_m.z = z;
    state.pose.orientation.w = a, state.pose.orientation.x = b, state.pose.orientation.y = c,
    state.pose.orientation.z = d;
    state.velocity_m_s.x = float(vx), state.velocity_m_s.y = float(vy), state.velocity_m_s.z = float(vz);
    state.spin_rad_s.x = float(wx), state.spin_rad_s.y = float(wy), state.spin_rad_s.z = float(wz);
    state.buttons = motion.buttons();
    state.state = daemon.is_connected() ? tactus::device_state_t::ANSWERS : tactus::device_state_t::LOST;
    state.header.publish_time_ns =
        std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count();
    bus.publish("DEVICE_STATE", &state);
    ++state.header.seq;
  }
}
