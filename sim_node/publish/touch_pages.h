// Cuts the touch model of a tool into pages that fit one datagram each. Pure.
#pragma once

#include <algorithm>
#include <tactus/touch_model_t.hpp>
#include <utility>

namespace tactus::sim {

// Maximum number of items per page, by the size of a datagram (tests/lcmtypes/size_test.cpp).
inline constexpr std::size_t kPlanesPerPage = 7, kAppliedPerPage = 4;

// Calls send(page) for each page of a complete model in order: at least one, so that an empty model is published too.
// `page` is a buffer of the caller, so that nothing is allocated per step. A model of one page is not copied: the page
// borrows its lists during the call.
template <class Send>
void each_touch_page(touch_model_t& whole, touch_model_t& page, Send&& send) {
  const auto pages_for = [](std::size_t items, std::size_t per_page) { return (items + per_page - 1) / per_page; };
  const std::size_t pages = std::max({std::size_t{1}, pages_for(whole.planes.size(), kPlanesPerPage),
                                      pages_for(whole.applied.size(), kAppliedPerPage)});
  const auto send_page = [&](std::size_t number) {
    page.page = static_cast<std::int8_t>(number);
    page.plane_count = static_cast<std::int8_t>(page.planes.size());
    page.applied_count = static_cast<std::int8_t>(page.applied.size());
    send(page);
  };
  const auto part = [](const auto& all, std::size_t number, std::size_t per_page, auto& out) {
    const std::size_t first = std::min(all.size(), number * per_page),
                      last = std::min(all.size(), first + per_page);
    out.assign(all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(last));
  };
  const auto exchange_lists = [&] {
    std::swap(page.planes, whole.planes);
    std::swap(page.applied, whole.applied);
  };
  page.header = whole.header;
  page.clock = whole.clock;
  page.tool = whole.tool;
  page.pages = static_cast<std::int8_t>(pages);
  if (pages == 1) {
    exchange_lists();
    send_page(0);
    exchange_lists();
    return;
  }
  for (std::size_t number = 0; number < pages; ++number) {
    part(whole.planes, number, kPlanesPerPage, page.planes);
    part(whole.applied, number, kAppliedPerPage, page.applied);
    send_page(number);
  }
}

}  // namespace tactus::sim
