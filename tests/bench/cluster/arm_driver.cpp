#include "tests/bench/cluster/arm_driver.h"

#include <cmath>
#include <numbers>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>

#include "sync/bus/bus.h"
#include "sync/virtual_time/virtual_time.h"

namespace tactus::bench {
namespace {

using examples::Vector;

constexpr const char* kDevice = "arm";
constexpr double kStep_s = 1e-3;

// Strokes over both plates once in 8 s, presses 5 mm deep, and taps: it is lifted for 0.1 s in each 0.9 s.
Vector rest_position_m(double time_s) {
  const bool lifted = std::fmod(time_s, 0.9) < 0.1;
  return {0.06 * std::sin(2 * std::numbers::pi * time_s / 8), 0, lifted ? 0.012 : -0.005};
}

device_state_t state_of(const ArmHardware& hardware) {
  const Vector& p = hardware.position_m();
  const Vector& v = hardware.velocity_m_s();
  device_state_t state{};
  state.header.sim_time_ns = -1;
  state.device = kDevice;
  state.pose.orientation.w = 1;
  state.pose.position_m.x = p[0], state.pose.position_m.y = p[1], state.pose.position_m.z = p[2];
  state.velocity_m_s.x = static_cast<float>(v[0]);
  state.velocity_m_s.y = static_cast<float>(v[1]);
  state.velocity_m_s.z = static_cast<float>(v[2]);
  state.state = device_state_t::ANSWERS;
  return state;
}

void pass_on(examples::ForceGuard& guard, const device_force_t& m, std::int64_t now_ns) {
  const header_t& h = m.header;
  guard.on_message({h.run_id, h.incarnation, h.seq, h.publish_time_ns}, {m.force_N.x, m.force_N.y, m.force_N.z},
                   {m.torque_N_m.x, m.torque_N_m.y, m.torque_N_m.z}, m.valid_for_ns, now_ns);
}

}  // namespace

void ArmHardware::step(double time_s, const Vector& force_N) {
  constexpr double kMass_kg = 0.1, kDamping_Ns_m = 10, kStiffness_N_m = 300;
  const Vector rest = rest_position_m(time_s);
  for (std::size_t i = 0; i < 3; ++i) {
    velocity_m_s_[i] += kStep_s / kMass_kg *
                        (force_N[i] - kDamping_Ns_m * velocity_m_s_[i] - kStiffness_N_m * (position_m_[i] - rest[i]));
    position_m_[i] += kStep_s * velocity_m_s_[i];
  }
}

int run_arm_driver(std::int64_t run_id, const std::function<void(const ArmTick&)>& on_tick) {
  sync::VirtualTime& time = *sync::VirtualTime::current();
  sync::Bus bus(sync::Identity::fresh("arm_driver", run_id), {});
  auto& forces = bus.queue<device_force_t>(channels::kDeviceForce, 256);
  examples::ForceGuard guard({}, {.run = run_id});
  ArmHardware hardware;
  examples::Exerted exerted;
  for (sync::HostTime next = sync::host_now(); !time.stop_requested(); next = std::max(next, sync::host_now()) + std::chrono::milliseconds(1)) {
    sync::sleep_until(next);
    const sync::HostTime now = sync::host_now();
    const std::int64_t now_ns = sync::to_ns(now);
    bus.drain(now);
    while (const auto m = forces.pop())
      if (m->message.device == kDevice) pass_on(guard, m->message, now_ns);
    hardware.step(sync::to_seconds(now - sync::VirtualTime::kBegin), exerted.force);
    exerted = guard.update(now_ns, hardware.velocity_m_s());
    on_tick({now, exerted, hardware.position_m(), hardware.velocity_m_s()});
    device_state_t state = state_of(hardware);
    bus.publish(channels::kDeviceState, state);
  }
  return 0;
}

}  // namespace tactus::bench
