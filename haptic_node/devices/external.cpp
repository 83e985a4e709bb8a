#include "haptic_node/devices/external.h"

#include "lcmtypes/vectors.h"

namespace tactus::haptic {

External::External(std::string name, const Eigen::Vector3d& offset_m, const ExternalDef& def)
    : name_(std::move(name)),
      offset_m_(offset_m),
      stream_(sync::from_seconds(def.stale_after_s), sync::from_seconds(def.unknown_delay_s)),
      timing_(def.at_once) {
  accepted_.position = offset_m_;
  force_.header.sim_time_ns = -1;
  force_.device = name_;
  force_.valid_for_ns = kWatchdog.count();
}

void External::on_message(const device_state_t& state, sync::HostTime arrival) {
  if (state.device != name_) return;
  const StateStream::Result result = stream_.add(state, arrival);
  if (result == StateStream::Result::kRejected) return;
  if (result == StateStream::Result::kRestarted) timing_.restart();
  timing_.on_state(state.header.publish_time_ns, stream_.transit_s(), arrival);
  if (!lost(arrival)) accept_newest();
}

void External::on_message(const device_force_t& others, sync::HostTime arrival) {
  if (others.device == name_) stream_.report(StateFault::kTwoCommanders, arrival);
}

bool External::lost(sync::HostTime now) const {
  return stream_.silent(now) || stream_.newest()->state != device_state_t::ANSWERS || stream_.fault(now).has_value();
}

void External::accept_newest() {
  const device_state_t& m = *stream_.newest();
  accepted_.position = offset_m_ + to_eigen(m.pose.position_m);
  accepted_.orientation = to_eigen(m.pose.orientation).normalized();
  accepted_.velocity = to_eigen(m.velocity_m_s);
  accepted_.spin = to_eigen(m.spin_rad_s);
  accepted_.buttons = m.buttons;
}

DeviceState External::read(sync::HostTime now) {
  accepted_.loop = timing_.step(now);
  accepted_.lost = lost(now);
  if (!accepted_.lost) {
    accept_newest();
    return accepted_;
  }
  accepted_.velocity.setZero();
  accepted_.spin.setZero();
  accepted_.buttons = 0;
  return accepted_;
}

std::string External::problem(sync::HostTime now) const {
  if (!lost(now)) return "";
  const std::string device = "the device \"" + name_ + "\" ";
  if (const auto fault = stream_.fault(now)) return device + stream_.describe(*fault);
  if (!stream_.newest()) return device + "has sent no state; start its driver";
  return device + (stream_.silent(now) ? "sends no new states; check its driver" : "does not answer its driver");
}

void External::write(const Wrench& wrench) {
  force_.force_N = to_vec3f(wrench.force_N);
  force_.torque_N_m = to_vec3f(wrench.torque_N_m);
}

}  // namespace tactus::haptic
