#include "sim_node/publish/publisher.h"

#include <algorithm>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/sim_clock_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sim_node/publish/paging.h"
#include "sim_node/publish/touch_pages.h"
#include "sync/bus/bus.h"

namespace tactus::sim {

void Publisher::publish_events(const StepView& view, const sim_clock_t& clock) {
  repeater_.add(*view.events, pace_);
  const std::vector<contact_event_t>& due = repeater_.due(pace_);
  if (due.empty()) return;
  const auto pages = paged(due, empty_size<contact_events_t>());
  for (std::size_t page = 0; page < pages.size(); ++page) {
    contact_events_t m{};
    m.header.sim_time_ns = sync::to_ns(view.time);
    m.clock = clock;
    m.page = static_cast<std::int32_t>(page);
    m.pages = static_cast<std::int32_t>(pages.size());
    m.events.assign(due.begin() + static_cast<std::ptrdiff_t>(pages[page].first),
                    due.begin() + static_cast<std::ptrdiff_t>(pages[page].second));
    m.count = static_cast<std::int32_t>(m.events.size());
    bus_.publish(channels::kContactEvents, m);
  }
}

void Publisher::publish_tool_contacts(const StepView& view, const sim_clock_t& clock) {
  const std::vector<contact_t>& all = *view.tool_contacts;
  const auto pages = paged(all, empty_size<contact_frame_t>());
  for (std::size_t page = 0; page < pages.size(); ++page) {
    contact_frame_t m{};
    m.header.sim_time_ns = sync::to_ns(view.time);
    m.clock = clock;
    m.group = contact_frame_t::TOOL;
    m.page = static_cast<std::int32_t>(page);
    m.pages = static_cast<std::int32_t>(pages.size());
    m.contacts.assign(all.begin() + static_cast<std::ptrdiff_t>(pages[page].first),
                      all.begin() + static_cast<std::ptrdiff_t>(pages[page].second));
    m.count = static_cast<std::int32_t>(m.contacts.size());
    bus_.publish(channels::kContacts, m);
  }
}

void Publisher::publish_game(const StepView& view, const sim_clock_t& clock) {
  if (view.game == nullptr || !view.game->any()) return;
  const bool changed = view.game->take_change();
  if (!changed && ++game_ticks_ < kGameTicks) return;
  game_ticks_ = 0;
  game_state_t m{};
  m.header.sim_time_ns = sync::to_ns(view.time);
  m.clock = clock;
  view.game->describe(m);
  bus_.publish(channels::kGameState, m);
}

void Publisher::publish(const StepView& view, const sync::TimeMap& map) {
  const sim_clock_t clock{sync::to_ns(map.sim), sync::to_ns(map.host), map.rate};
  pace_ = std::max(pace_ + step_, view.time);
  for (touch_model_t& m : *view.touch_models) {
    if (m.tool < 0) continue;
    m.header.sim_time_ns = sync::to_ns(view.time);
    m.clock = clock;
    each_touch_page(m, touch_page_, [&](touch_model_t& page) { bus_.publish(channels::kTouchModel, page); });
  }
  publish_events(view, clock);
  publish_tool_contacts(view, clock);
  const auto send = [&](const char* channel, auto& m) {
    m.clock = clock;
    bus_.publish(channel, m);
  };
  snapshots_.tick(view.time, pace_, view.state, [&](contact_frame_t& m) { send(channels::kContacts, m); },
                  [&](world_state_t& m) { send(channels::kWorldState, m); });
  publish_game(view, clock);
}

}  // namespace tactus::sim
