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
        if (type == nullptr)
          throw std::invalid_argument("there is no channel " + w.channel + "; choose one from the list");
        w.path.emplace(*type, std::string_view(name).substr(colon + 1));
        if (!type->fields.empty() && type->fields.front().name == "header")
          w.source.emplace(*type, "header.source");
        if (w.path->is_text()) throw std::invalid_argument(name + " is text; choose a number");
      }
    } catch (const std::invalid_argument& e) {
      wrong = e.what();
      w.channel = "";
      w.path.reset();
      w.source.reset();
      w.name = "";  // keeps its number, and never has a value
    }
    next.push_back(std::move(w));
  }
  watches_ = std::move(next);
  return wrong;
}

bool Watches::accepts(std::string_view channel) const {
  for (const Watch& w : watches_)
    if (w.path && w.channel == channel) return true;
  return false;
}

Watches::Curve* Watches::curve(Watch& w, std::int32_t source) {
  for (Curve& c : w.curves)
    if (c.source == source) return &c;
  if (w.curves.size() >= kMaxSenders) return nullptr;
  return &w.curves.emplace_back(Curve{source, {}, {}});
}

void Watches::add_value(Curve& c, sync::HostTime time, double value) {
  if (!std::isfinite(value)) return;
  const bool back = c.newest && time < *c.newest;  // a log that was sought backwards
  if (c.newest && !back && time - *c.newest < kMinInterval) return;
  c.newest = time;
  c.waiting.push_back({time, value});
  if (c.waiting.size() > kMaxWaiting) c.waiting.pop_front();
}

void Watches::on_message(std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival) {
  for (Watch& w : watches_) {
    if (!w.path || w.channel != channel) continue;
    const auto source = w.source ? w.source->number(bytes) : 0.0;
    if (!source) continue;
    Curve* c = curve(w, static_cast<std::int32_t>(*source));
    if (c == nullptr || (c->newest && arrival >= *c->newest && arrival - *c->newest < kMinInterval)) continue;
    if (const auto value = w.path->number(bytes)) add_value(*c, arrival, *value);
  }
}

void Watches::on_tag_value(const std::string& name, sync::HostTime time, double value) {
  for (Watch& w : watches_)
    if (!w.path && w.name == name) add_value(*curve(w, 0), time, value);
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
    for (Curve& c : watches_[i].curves) {
      for (const Value& v : c.waiting)
        out.push_back({i, sync::to_seconds(v.time.time_since_epoch()), v.value, c.source});
      c.waiting.clear();
    }
  }
  return out;
}

}  // namespace tactus::live
