#include "sync/bus/health_inputs.h"

#include <algorithm>
#include <string>
#include <tactus/input_health_t.hpp>

namespace tactus::sync {

void add_input(node_health_t& m, const input_health_t& input) {
  const auto same = std::ranges::find_if(m.inputs, [&](const input_health_t& i) { return i.channel == input.channel; });
  if (same == m.inputs.end()) {
    m.inputs.push_back(input);
  } else {
    same->gaps = std::max(same->gaps, input.gaps);
    same->bad = std::max(same->bad, input.bad);
  }
  m.input_count = static_cast<std::int32_t>(m.inputs.size());
}

void fit(node_health_t& m, std::size_t bytes) {
  const std::string text = m.status_text;
  int left_out = 0;
  while (static_cast<std::size_t>(m.getEncodedSize()) > bytes && !m.inputs.empty()) {
    m.inputs.pop_back();
    m.input_count = static_cast<std::int32_t>(m.inputs.size());
    m.status_text = text + "; " + std::to_string(++left_out) + " inputs not listed";
  }
}

}  // namespace tactus::sync
