// The variables that one page shows: their values between two frames, thinned out to what a screen can show. Pure; bounded.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/fields.h"
#include "sync/time.h"

namespace tactus::live {

class Watches {
 public:
  // Design: no screen shows more values of one curve in one second than 200.
  static constexpr sync::Nanoseconds kThinnest{5'000'000};
  static constexpr std::size_t kMostWaiting = 64;  // values of one variable for one frame; more are left out

  // Instead of those before. A name that is none is left out; the sentence says why, "": all are names. "CHANNEL:path" is a
  // field, anything else "node.tag".
  std::string set(const std::vector<std::string>& names);

  bool wants(std::string_view channel) const;
  void take(std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival);
  // Of a tagged variable.
  void take_tag(const std::string& name, sync::HostTime time, double value);
  std::vector<std::string> tags() const;

  // [[number of the variable, s, value], ...] since the last call.
  nlohmann::json values();

 private:
  struct Value {
    sync::HostTime time;
    double value;
  };
  struct Watch {
    std::string name, channel;  // channel empty: a tag
    std::optional<FieldPath> path;
    std::optional<sync::HostTime> newest;
    std::vector<Value> waiting;
  };
  static void keep(Watch& w, sync::HostTime time, double value);
  std::vector<Watch> watches_;
};

}  // namespace tactus::live
