// Who asks for which tagged variables (TAG_REQUEST). Pure.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tactus/tag_request_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sync {

// '*' in the pattern stands for any characters, also none; every other for itself.
bool matches(std::string_view pattern, std::string_view text);

class TagRequests {
 public:
  static constexpr Nanoseconds kHolds{3'000'000'000};
  // Design: a recorder, some viewers and maps. Beyond these a new one is not heeded until one is over.
  static constexpr std::size_t kMax = 64;

  // Requests of another run are not heeded.
  explicit TagRequests(std::int64_t run_id) : run_id_(run_id) {}

  // True when something else is asked for than before.
  bool take(const tag_request_t& request, HostTime now);
  // Ends those that were not repeated. True when something else is asked for than before.
  bool expire(HostTime now);
  bool any() const { return !requests_.empty(); }
  // name: "node.tag".
  bool wants(std::string_view name) const;

 private:
  struct Request {
    std::int64_t incarnation;
    std::vector<std::string> patterns;
    HostTime until;
  };
  std::int64_t run_id_;
  std::vector<Request> requests_;
};

}  // namespace tactus::sync
