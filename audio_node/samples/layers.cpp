#include "audio_node/samples/layers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {

std::string name(Interaction interaction) {
  switch (interaction) {
    case Interaction::kScrape: return "scrape";
    case Interaction::kRoll: return "roll";
    default: return "impact";
  }
}

LayerMix mix_of(const Layers& layers, double speed_m_s) {
  LayerMix mix;
  const auto& all = layers.by_speed;
  if (all.empty()) return mix;
  const auto above = std::find_if(all.begin(), all.end(), [&](const Layer& l) { return l.speed_m_s > speed_m_s; });
  const int i = static_cast<int>(above - all.begin());
  if (i == 0 || above == all.end()) {
    mix.layer[0] = i == 0 ? 0 : i - 1;
    mix.gain[0] = 1;
    return mix;
  }
  const Layer& below = all[static_cast<std::size_t>(i - 1)];
  const double part = std::log(speed_m_s / below.speed_m_s) / std::log(above->speed_m_s / below.speed_m_s);
  const double angle = part * std::numbers::pi / 2;
  mix.layer = {i - 1, i};
  mix.gain = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  return mix;
}

const Recording& select_take(const Layer& layer, std::int64_t number) {
  // splitmix64's finaliser (Steele, Lea and Flood 2014), so that consecutive ids do not cycle through the takes.
  auto z = static_cast<std::uint64_t>(number) * 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return layer.takes[static_cast<std::size_t>((z ^ (z >> 31)) % layer.takes.size())];
}

}  // namespace tactus::audio
