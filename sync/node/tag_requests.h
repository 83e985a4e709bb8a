// The processes that request tagged variables, and the patterns that they request (TAG_REQUEST). Pure.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tactus/tag_request_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sync {

// '*' in the pattern matches any number of characters, also none; every other character matches itself.
bool matches(std::string_view pattern, std::string_view text);

class TagRequests {
 public:
  static constexpr Nanoseconds kValidFor{3'000'000'000};
  // Design: a recorder, some viewers and maps. Requests beyond this number are ignored until another one expires.
  static constexpr std::size_t kMax = 64;

  // Requests of another run are ignored.
  explicit TagRequests(std::int64_t run_id) : run_id_(run_id) {}

  // Returns true when the set of requested variables may have changed.
  bool push(const tag_request_t& request, HostTime now);
  // Removes the requests that were not repeated in time. Returns true when the set of requested variables may have changed.
  bool expire(HostTime now);
  bool any() const { return !requests_.empty(); }
  // name: "node.tag".
  bool is_requested(std::string_view name) const;

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
