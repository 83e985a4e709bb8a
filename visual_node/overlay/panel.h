// The text of the overlays: report, ages, degradation, groups, help, as lines at the upper left of the picture.
// Pure.
#pragma once

#include <optional>
#include <string>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "sync/node/modality_endpoint.h"
#include "sync/resampling/sample_status.h"
#include "visual_node/frame/text_look.h"
#include "visual_node/overlay/overlay_set.h"
#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

// Tick times of a node of late: the difference between the cumulative histograms of two NODE_HEALTH messages.
class TickTimes {
 public:
  void push(const node_health_t& m);
  // Median of the last interval with ticks; nothing before the second message.
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
  sync::SampleStatus status = sync::SampleStatus::kNone;  // status of the drawn data; kNone: the channel is not resampled
};

struct PanelData {
  std::size_t contacts = 0;
  TickTimes physics;
  sync::Nanoseconds rendering{0}, period{0};
  int quality = 0, qualities = 0;
  std::size_t haptic_bodies = 0, visual_bodies = 0;
  std::vector<InputLine> inputs;
  std::string profile;  // empty: none
  sync::Nanoseconds delay{0}, profile_delay{0};
  sync::OutputValues output;
};

std::vector<std::string> panel_lines(const OverlaySet& on, const PanelData& data);

// The area of the picture that text may use, pixels from its upper left.
struct TextArea {
  float x, y, right, bottom;
};

// Draws lines on one plate at the upper left of the room. largest: pixels for each pixel of a letter, reduced
// until all lines fit. Long lines wrap; lines that still do not fit are left out. Returns the y of the next plate.
float append_lines(std::vector<Rect>& overlay, const std::vector<std::string>& lines, const TextArea& room,
                   float largest, const TextLook& look = {});

// Size of a letter's pixel in a picture of that height: 2 at 640 x 480, more in larger ones, times the factor of the look.
float text_size(int picture_height, const TextLook& look = {});

}  // namespace tactus::visual
