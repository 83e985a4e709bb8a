// The words of the overlays: report, ages, degradation, groups, help, as lines at the upper left of the picture.
// Pure.
#pragma once

#include <optional>
#include <string>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "sync/resampling/sample_status.h"
#include "sync/node/modality_endpoint.h"
#include "visual_node/overlay/kinds.h"
#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

// How long the ticks of a node took of late: what its counts since the start have gained from one health to the
// next.
class TickTimes {
 public:
  void push(const node_health_t& m);
  // Of the last interval with ticks; nothing before the second message.
  std::optional<sync::Nanoseconds> median() const { return median_; }
  double nominal_rate_Hz() const { return newest_ ? newest_->nominal_rate_Hz : 0; }
  double realtime_factor() const { return newest_ ? newest_->realtime_factor : 0; }

 private:
  std::optional<node_health_t> newest_;
  std::optional<sync::Nanoseconds> median_;
};

struct InputLine {
  std::string channel;
  sync::InputAge age;
  sync::SampleStatus status = sync::SampleStatus::kNone;  // how what is drawn of it was obtained; kNone: it is not resampled
};

struct PanelFacts {
  std::size_t contacts = 0;
  TickTimes physics;
  sync::Nanoseconds rendering{0}, period{0};
  int quality = 0, qualities = 0;
  std::size_t haptic_bodies = 0, visual_bodies = 0;
  std::vector<InputLine> inputs;
  std::string profile;  // empty: none
  sync::Nanoseconds delay{0}, profile_delay{0};
  sync::OutputDef output;
};

std::vector<std::string> panel_lines(const OverlaySet& on, const PanelFacts& facts);

// What of the picture words may take, pixels from its upper left.
struct TextRoom {
  float x, y, right, bottom;
};

// Lines on one dark plate at the upper left of the room, `largest` pixels a pixel of a letter, fewer when not all
// of them would find room so. Long lines go on in the next; what still finds no room is left out. Returns where
// the next plate would be.
float append_lines(std::vector<Rect>& overlay, const std::vector<std::string>& lines, const TextRoom& room,
                   float largest);

// Of a letter's pixel in a picture of that size: 2 at 640 x 480, more in larger ones.
float text_size(int picture_height);

}  // namespace tactus::visual
