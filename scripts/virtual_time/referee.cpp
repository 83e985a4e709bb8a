#include "scripts/virtual_time/referee.h"

#include <algorithm>
#include <cmath>
#include <tactus/game_state_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"

namespace tactus {

void Referee::on_message(std::string_view channel, std::span<const std::uint8_t> data) {
  if (channel == channels::kGameState) {
    const auto m = sync::decode<game_state_t>(data.data(), data.size());
    if (!m) return;
    begun_ = true;
    verdict_.filled = 0;
    for (std::size_t i = 0; i < m->holes.size(); ++i) {
      verdict_.filled += m->holes[i].filled;
      if (m->holes[i].inside >= 0 && !m->holes[i].filled)
        mistakes_.emplace(static_cast<int>(i), m->holes[i].inside);
    }
    verdict_.wrong = static_cast<int>(mistakes_.size());
    verdict_.won = m->won != 0;
    verdict_.time_s = 1e-9 * static_cast<double>(verdict_.won ? m->won_ns : m->header.sim_time_ns);
  } else if (channel == channels::kToolState) {
    const auto m = sync::decode<tool_state_t>(data.data(), data.size());
    if (!m || m->tool != 0) return;
    verdict_.peak_force_N =
        std::max<double>(verdict_.peak_force_N, std::hypot(m->force_N.x, m->force_N.y, m->force_N.z));
    const auto& p = m->device.position_m;
    if (last_) verdict_.path_m += std::hypot(p.x - last_->x, p.y - last_->y, p.z - last_->z);
    last_ = Point{p.x, p.y, p.z};
  }
}

}  // namespace tactus
