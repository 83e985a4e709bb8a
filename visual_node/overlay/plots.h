// Graphs, bars and text of published variables, at the right of the picture. Pure.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "sync/time/time.h"
#include "visual_node/frame/text_look.h"
#include "visual_node/overlay/plot_spec.h"
#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

// The history of one variable over the last seconds: the lowest and highest value in each of kColumns time slices,
// so that no peak is lost and memory is bounded at any publication rate.
class ValueHistory {
 public:
  static constexpr int kColumns = 150;
  struct Slice {
    std::int64_t number = 0;  // its time divided by its length
    double lowest = 0, highest = 0;
  };

  explicit ValueHistory(sync::Nanoseconds span) : length_(std::max(sync::Nanoseconds(1), span / kColumns)) {}
  // Ignores values that are not finite. Time may go back by a few messages, not further.
  void add(double value, sync::HostTime t);
  // The slices of the span that ends now, oldest first.
  std::vector<Slice> slices(sync::HostTime now) const;
  std::int64_t number(sync::HostTime t) const { return t.time_since_epoch() / length_; }
  // The range of all slices of the span; nothing when there are none.
  std::optional<std::pair<double, double>> range(sync::HostTime now) const;
  sync::Nanoseconds span() const { return length_ * kColumns; }

 private:
  sync::Nanoseconds length_;
  std::deque<Slice> slices_;
};

// A number as a label: four digits, "12.5", "1.2e-05"; an integer in full.
std::string label(double value);

// Left edge of the column of plots in a picture of that width.
float plots_left(int picture_width);

class Plots {
 public:
  // span: of the graphs, and of the maximum of a bar.
  Plots(std::vector<PlotSpec> specs, sync::Nanoseconds span);
  bool empty() const { return plots_.empty(); }
  // Channels to subscribe to, each once.
  std::vector<std::string> channels() const;
  void push(const std::string& channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival);
  // Draws the plots from the upper right corner downwards, as many as fit into that width and height.
  void append(std::vector<Rect>& overlay, sync::HostTime now, int width, int height, const TextLook& look = {}) const;

 private:
  struct Plot {
    PlotSpec spec;
    ValueHistory history;
    std::optional<std::string> newest;  // as text
    double value = 0;
    sync::HostTime at{};
  };
  std::vector<Plot> plots_;
};

}  // namespace tactus::visual
