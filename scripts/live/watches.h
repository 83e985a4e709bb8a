// The variables that one page shows: their values between two frames, of each sender by itself (two hands both
// send TOOL_STATE), thinned out to what a screen can show. Pure; bounded.
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
  // Design: no screen shows more values of one curve in one second than 200.
  static constexpr sync::Nanoseconds kThinnest{5'000'000};
  // Values of one curve for one frame, the newest: what lies before a place in a log comes at once when the log is wound there,
  // LogPlayer::kBefore of it.
  static constexpr std::size_t kMaxWaiting = 600;
  // Curves of one variable; of more senders the values are left out. Design: as many colours can be told apart.
  static constexpr std::size_t kMaxSenders = 8;

  // Instead of those before. A name that is none is left out; the sentence says why, "": all are names.
  // "CHANNEL:path" is a field, anything else "node.tag".
  std::string set(const std::vector<std::string>& names);

  bool wants(std::string_view channel) const;
  void take(std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival);
  // Of a tagged variable.
  void take_tag(const std::string& name, sync::HostTime time, double value);
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
  // Null when there are too many.
  static Curve* curve(Watch& w, std::int32_t source);
  static void keep(Curve& c, sync::HostTime time, double value);
  std::vector<Watch> watches_;
};

}  // namespace tactus::live
