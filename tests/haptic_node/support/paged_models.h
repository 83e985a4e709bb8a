// Touch models of several pages, as the simulation sends them; each page identifies its step.
#pragma once

#include <cstdint>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <tactus/touch_plane_t.hpp>
#include <vector>

#include "haptic_node/contact/touch_model_view.h"
#include "sim_node/publish/touch_pages.h"
#include "tests/haptic_node/support/tick.h"

namespace tactus::haptic::test {


// A model in which every plane and every applied impulse identifies its step.
inline touch_model_t whole_model(std::int64_t step, std::size_t planes, std::size_t applied_count) {
  touch_model_t m{};
  m.header.incarnation = 5;
  m.header.run_id = 1;
  m.header.sim_time_ns = m.header.publish_time_ns = step * kMs;
  m.clock = {step * kMs, step * kMs, 1};
  for (std::size_t i = 0; i < planes; ++i) {
    touch_plane_t p{};
    p.contact_id = step * 1000 + static_cast<std::int64_t>(i);
    m.planes.push_back(p);
  }
  for (std::size_t i = 0; i < applied_count; ++i) {
    touch_applied_t a{};
    a.contact_id = step * 1000 + static_cast<std::int64_t>(i);
    m.applied.push_back(a);
  }
  return m;
}

// As the publisher numbers them.
inline std::vector<touch_model_t> pages_of(touch_model_t whole, std::int64_t& seq) {
  std::vector<touch_model_t> out;
  touch_model_t scratch{};
  sim::each_touch_page(whole, scratch, [&](touch_model_t& page) {
    page.header.seq = seq++;
    out.push_back(page);
  });
  return out;
}

inline bool is_whole(const TouchModelView& m, std::int64_t step, std::size_t planes, std::size_t applied_count) {
  bool good = m.plane_count() == planes;
  for (std::size_t i = 0; good && i < planes; ++i)
    good = m.plane(i).contact_id == step * 1000 + static_cast<std::int64_t>(i);
  std::size_t index = 0;
  m.for_each_applied([&](const touch_applied_t& a) {
    good = good && a.contact_id == step * 1000 + static_cast<std::int64_t>(index++);
  });
  return good && index == applied_count;
}

}  // namespace tactus::haptic::test
