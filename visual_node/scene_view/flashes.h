// Flashes of contact events: every begin and hit is visible in several frames, however short the contact was.
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
  // Call once a frame, after add(): returns the glows of the frame presented at t, newest first, and ages the
  // flashes. Each flash lasts for the duration and the number of frames of the settings, whichever is longer.
  std::vector<Glow> frame(sync::HostTime t, const Camera& camera);
  // Events whose flash is in the last frame, newest first.
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
  int min_frames_;
  float radius_m_;
  float min_px_;
  std::deque<Flash> flashes_;  // in order of arrival; bounded by the events of a few frames, which sync/ bounds
};

}  // namespace tactus::visual
