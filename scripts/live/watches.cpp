#include "scripts/live/watches.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace tactus::live {

std::string Watches::set(const std::vector<std::string>& names) {
  std::string wrong;
  std::vector<Watch> next;
  for (const std::string& name : names) {
    Watch w{name, "", {}, {}, {}};
    const std::size_t colon = name.find(':');
    try {
      if (colon != std::string::npos) {
        w.channel = name.substr(0, colon);
        const MessageType* type = type_on(w.channel);
        if (type == nullptr) throw std::invalid_argument("there is no channel " + w.channel + "; choose one from the list");
        w.path.emplace(*type, std::string_view(name).substr(colon + 1));
        if (w.path->is_text()) throw std::invalid_argument(name + " is text; choose a number");
      }
    } catch (const std::invalid_argument& e) {
      wrong = e.what();
      w.channel = "";
      w.path.reset();
      w.name = "";  // keeps its number, and never has a value
    }
    next.push_back(std::move(w));
  }
  watches_ = std::move(next);
  return wrong;
}

bool Watches::wants(std::string_view channel) const {
  for (const Watch& w : watches_)
    if (w.path && w.channel == channel) return true;
  return false;
}

void Watches::keep(Watch& w, sync::HostTime time, double value) {
  if (!std::isfinite(value)) return;
  const bool back = w.newest && time < *w.newest;  // a log that was wound back
  if (w.newest && !back && time - *w.newest < kThinnest) return;
  if (w.waiting.size() >= kMostWaiting) return;
  w.newest = time;
  w.waiting.push_back({time, value});
}

void Watches::take(std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival) {
  for (Watch& w : watches_) {
    if (!w.path || w.channel != channel) continue;
    if (w.newest && arrival >= *w.newest && arrival - *w.newest < kThinnest) continue;
    if (const auto value = w.path->number(bytes)) keep(w, arrival, *value);
  }
}

void Watches::take_tag(const std::string& name, sync::HostTime time, double value) {
  for (Watch& w : watches_)
    if (!w.path && w.name == name) keep(w, time, value);
}

std::vector<std::string> Watches::tags() const {
  std::vector<std::string> names;
  for (const Watch& w : watches_)
    if (!w.path && !w.name.empty()) names.push_back(w.name);
  return names;
}

nlohmann::json Watches::values() {
  nlohmann::json out = nlohmann::json::array();
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    for (const Value& v : watches_[i].waiting)
      out.push_back({i, sync::to_seconds(v.time.time_since_epoch()), v.value});
    watches_[i].waiting.clear();
  }
  return out;
}

}  // namespace tactus::live
