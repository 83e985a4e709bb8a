#include "sync/node/tag_requests.h"

#include <algorithm>

namespace tactus::sync {

bool matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, after_star = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++, after_star = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p, ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1, t = ++after_star;  // the star matches one more character
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

bool TagRequests::push(const tag_request_t& request, HostTime now) {
  if (request.header.run_id != run_id_) return false;
  const auto known = std::find_if(requests_.begin(), requests_.end(),
                                  [&](const Request& r) { return r.incarnation == request.header.incarnation; });
  if (known == requests_.end()) {
    if (requests_.size() >= kMax) return false;
    requests_.push_back({request.header.incarnation, request.patterns, now + kValidFor});
    return true;
  }
  known->until = now + kValidFor;
  if (known->patterns == request.patterns) return false;
  known->patterns = request.patterns;
  return true;
}

bool TagRequests::expire(HostTime now) {
  return std::erase_if(requests_, [&](const Request& r) { return r.until < now; }) > 0;
}

bool TagRequests::is_requested(std::string_view name) const {
  return std::any_of(requests_.begin(), requests_.end(), [&](const Request& r) {
    return std::ranges::any_of(r.patterns, [&](const std::string& pattern) { return matches(pattern, name); });
  });
}

}  // namespace tactus::sync
