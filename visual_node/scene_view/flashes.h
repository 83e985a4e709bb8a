// The flash of every contact that begins or hits: it shows in several frames however short the contact was.
#pragma once

#include <cstdint>
#include <deque>
#include <tactus/contact_event_t.hpp>
#include <vector>

#include "sync/time/time.h"
#include "visual_node/scene_view/draw_list.h"
#include "visual_node/settings.gen.h"

namespace tactus::visual {

class Flashes {
 public:
  explicit Flashes(const Settings& settings);

  // Adds an event that is first shown by the frame presented at t.
  void add(const contact_event_t& event, sync::HostTime t);
  // Call once a frame, after add(): the glows of the frame presented at t, newest first, and ages the flashes.
  // Each lives for the duration set and for the number of frames set, whichever is longer.
  std::vector<Glow> frame(sync::HostTime t, const Camera& camera);
  // Events whose flash the last frame showed, newest first.
  std::vector<std::int64_t> shown() const;
  void clear() { flashes_.clear(); }

 private:
  struct Flash {
    contact_event_t event;
    sync::HostTime first;
    int frames = 0;
  };
  void append_glows(const Flash& flash, sync::HostTime t, const Camera& camera, std::vector<Glow>& out) const;

  sync::Nanoseconds duration_;
  int least_frames_;
  float radius_m_;
  float least_px_;
  std::deque<Flash> flashes_;  // in order of arrival; bounded by the events of some frames, which sync/ bounds
};

}  // namespace tactus::visual
