// Arbitrary text as a message of a browser: rejected with one sentence, or a message within its bounds. The profile of its sliders is a
// valid profile.
#include <cstdlib>
#include <stdexcept>

#include "scripts/live/browser_message.h"
#include "scripts/live/origin.h"
#include "scripts/live/sliders.h"
#include "sync/degradation/profile.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tactus;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const live::BrowserMessage m = live::parse_browser_message(text);
    if (const auto* sliders = std::get_if<live::DegradeRequest>(&m))
      if (sync::parse_profile(live::with_sliders("", sliders->senses), "page").rules.size() > sliders->senses.size())
        std::abort();
    if (const auto* hand = std::get_if<live::HandTarget>(&m))
      if (!(hand->x >= -1 && hand->x <= 1 && hand->push_m >= -1 && hand->push_m <= 1)) std::abort();
    if (const auto* watch = std::get_if<live::WatchRequest>(&m))
      if (watch->names.size() > live::kMaxWatched) std::abort();
  } catch (const std::invalid_argument& e) {
    if (*e.what() == 0) std::abort();
  }
  const live::Access access{.port = 8080, .loopback = true, .token = "0123456789abcdef"};
  if (live::token_matches(text, access) && text.find(access.token) == std::string_view::npos) std::abort();
  if (live::origin_allowed(text, "127.0.0.1:8080") && text != "http://127.0.0.1:8080") std::abort();
  live::host_allowed(text, access);
  return 0;
}
