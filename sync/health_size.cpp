#include "sync/health_size.h"

#include <algorithm>
#include <string>

#include "lcmtypes/channels.h"

namespace tactus::sync {
namespace {

constexpr int kMost = static_cast<int>(channels::kMaxMessageBytes);
// "; 4294967295 inputs more"
constexpr int kRemarkBytes = 24;

}  // namespace

void make_fit(node_health_t& m) {
  if (m.getEncodedSize() <= kMost) return;
  std::size_t left_out = 0;
  while (!m.inputs.empty() && m.getEncodedSize() + kRemarkBytes > kMost) {
    const auto idle = std::find_if(m.inputs.rbegin(), m.inputs.rend(),
                                   [](const input_health_t& in) { return in.messages == 0 && in.bad == 0; });
    m.inputs.erase(idle == m.inputs.rend() ? m.inputs.end() - 1 : idle.base() - 1);
    m.input_count = static_cast<std::int32_t>(m.inputs.size());
    ++left_out;
  }
  const int over = m.getEncodedSize() + kRemarkBytes - kMost;
  if (over > 0) m.note.resize(m.note.size() - std::min(m.note.size(), static_cast<std::size_t>(over)));
  m.note += "; " + std::to_string(left_out) + " inputs more";
}

}  // namespace tactus::sync
