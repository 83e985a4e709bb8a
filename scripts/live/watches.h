// The variables that one page shows: their values between two frames, separate for each sender (two hands both send
// TOOL_STATE), thinned to the resolution of a screen. Pure; bounded.
#pragma once

#include <cstdint>
#include <deque>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/fields.h"
#include "sync/time/time.h"

namespace tactus::live {

class Watches {
 public:
  // Design: no screen shows more than 200 values of one curve per second.
  static constexpr sync::Nanoseconds kMinInterval{5'000'000};
  // Values of one curve for one frame, the newest: after a seek, LogPlayer::kSeekLead of the log arrives in one piece.
  static constexpr std::size_t kMaxWaiting = 600;
  // Curves of one variable; values of further senders are left out. Design: the number of distinguishable colours.
  static constexpr std::size_t kMaxSenders = 8;

  // Replaces the shown variables. Invalid names are left out. Returns a sentence with the reason; "": all are valid.
  // "CHANNEL:path" is a field, anything else "node.tag".
  std::string set(const std::vector<std::string>& names);

  bool accepts(std::string_view channel) const;
  void on_message(std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival);
  // A value of a tagged variable.
  void on_tag_value(const std::string& name, sync::HostTime time, double value);
  std::vector<std::string> tags() const;

  // [[number of the variable, s, value, header.source of its sender; 0: of a tag], ...] since the last call.
  nlohmann::json values();

 private:
  struct Value {
    sync::HostTime time;
    double value;
  };
  struct Curve {
    std::int32_t source = 0;
    std::optional<sync::HostTime> newest;
    std::deque<Value> waiting;
  };
  struct Watch {
    std::string name, channel;  // channel empty: a tag
    std::optional<FieldPath> path, source;
    std::vector<Curve> curves;
  };
  // Returns null when there are too many senders.
  static Curve* curve(Watch& w, std::int32_t source);
  static void add_value(Curve& c, sync::HostTime time, double value);
  std::vector<Watch> watches_;
};

}  // namespace tactus::live
