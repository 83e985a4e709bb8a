#include "sync/log/split_page.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"

namespace tactus::sync {
namespace {

using Halves = std::array<std::vector<std::uint8_t>, 2>;

template <class Element>
void cut(const std::vector<Element>& all, std::size_t at, std::vector<Element>& first, std::vector<Element>& second) {
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(at);
  first.assign(all.begin(), middle), second.assign(middle, all.end());
}

// The number of items that fit into a message whose other fields have base_bytes.
template <class Element>
std::size_t fitting(const std::vector<Element>& items, std::size_t base_bytes) {
  std::size_t count = 0;
  for (std::size_t bytes = base_bytes; count < items.size(); ++count) {
    bytes += static_cast<std::size_t>(items[count]._getEncodedSizeNoHash());
    if (bytes > channels::kMaxMessageBytes) break;
  }
  return count;
}

void divide(const contact_frame_t& m, contact_frame_t& first, contact_frame_t& second) {
  cut(m.contacts, fitting(m.contacts, static_cast<std::size_t>(contact_frame_t{}.getEncodedSize())), first.contacts, second.contacts);
  first.count = static_cast<std::int32_t>(first.contacts.size()), second.count = static_cast<std::int32_t>(second.contacts.size());
}

void divide(const contact_events_t& m, contact_events_t& first, contact_events_t& second) {
  cut(m.events, fitting(m.events, static_cast<std::size_t>(contact_events_t{}.getEncodedSize())), first.events, second.events);
  first.count = static_cast<std::int32_t>(first.events.size()), second.count = static_cast<std::int32_t>(second.events.size());
}

void divide(const touch_model_t& m, touch_model_t& first, touch_model_t& second) {
  cut(m.planes, (m.planes.size() + 1) / 2, first.planes, second.planes);
  cut(m.applied, (m.applied.size() + 1) / 2, first.applied, second.applied);
  for (touch_model_t* half : {&first, &second}) {
    half->plane_count = static_cast<std::int8_t>(half->planes.size());
    half->applied_count = static_cast<std::int8_t>(half->applied.size());
  }
}

template <class Message>
std::optional<Halves> split(std::span<const std::uint8_t> bytes) {
  using Number = decltype(Message::pages);
  Message whole{};
  try {
    if (whole.decode(bytes.data(), 0, static_cast<int>(bytes.size())) != static_cast<int>(bytes.size())) return std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;  // the generated decoder throws on hostile lengths
  }
  if (whole.page < 0 || whole.pages <= whole.page || whole.pages > std::numeric_limits<Number>::max() / 2 || whole.header.seq < 0 ||
      whole.header.seq > std::numeric_limits<std::int64_t>::max() / 4)
    return std::nullopt;
  Message first = whole, second = whole;
  divide(whole, first, second);
  int half = 0;
  for (Message* m : {&first, &second}) {
    m->pages = static_cast<Number>(2 * whole.pages);
    m->page = static_cast<Number>(2 * whole.page + half);
    m->header.seq = 2 * whole.header.seq + half++;
  }
  return Halves{encode(first), encode(second)};
}

}  // namespace

std::optional<Halves> split_page(std::span<const std::uint8_t> message) {
  if (message.size() < 8) return std::nullopt;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 8; ++i) bits = bits << 8 | message[i];
  const auto fingerprint = static_cast<std::int64_t>(bits);
  if (fingerprint == contact_frame_t::getHash()) return split<contact_frame_t>(message);
  if (fingerprint == contact_events_t::getHash()) return split<contact_events_t>(message);
  if (fingerprint == touch_model_t::getHash()) return split<touch_model_t>(message);
  return std::nullopt;
}

}  // namespace tactus::sync
