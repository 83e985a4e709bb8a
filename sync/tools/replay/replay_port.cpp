#include "sync/tools/replay/replay_port.h"

#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

namespace tactus::sync {

struct ReplayPort::Connection {
  lcm::LCM lcm;
};

ReplayPort::ReplayPort(const BusOptions& options)
    : connection_(new Connection{lcm::LCM(lcm_url(options, options.port))}) {
  if (!connection_->lcm.good())
    throw std::runtime_error(
        "cannot send to " + lcm_url(options, options.port) +
        "; start it with tactus replay, or add a multicast route: ip route add 224.0.0.0/4 dev lo");
}

ReplayPort::~ReplayPort() = default;

bool ReplayPort::send(std::string_view channel, std::span<const std::uint8_t> message) {
  channel_ = channel;
  if (connection_->lcm.publish(channel_, message.data(), static_cast<unsigned>(message.size())) == 0) return true;
  ++refused_;
  return false;
}

}  // namespace tactus::sync
