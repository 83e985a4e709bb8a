#include "audio_node/signal/dropout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {

Dropout::Dropout(double rate_Hz)
    : rate_Hz_(rate_Hz), edge_(std::max(1, static_cast<int>(std::lround(kEdge_s * rate_Hz)))), open_(edge_) {}

void Dropout::set(const DropoutDef& def) {
  const bool on = def.length_s > 0 && def.every_s > 0;
  length_ = on ? std::llround(def.length_s * rate_Hz_) : 0;
  every_ = on ? std::max<std::int64_t>(1, std::llround(def.every_s * rate_Hz_)) : 0;
}

void Dropout::next(std::span<float> gains) {
  for (float& gain : gains) {
    const bool silent = every_ > 0 && sample_ % every_ < length_;
    ++sample_;
    open_ = std::clamp(open_ + (silent ? -1 : 1), 0, edge_);
    gain =
        open_ == edge_
            ? 1
            : (1 - std::cos(std::numbers::pi_v<float> * static_cast<float>(open_) / static_cast<float>(edge_))) /
                  2;
  }
}

}  // namespace tactus::audio
