// Graphs, bars and words of published variables, at the right of the picture. Pure.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "sync/time/time.h"
#include "visual_node/overlay/plot_spec.h"
#include "visual_node/scene_view/draw_list.h"

namespace tactus::visual {

// The course of one variable over the last seconds: lowest and highest value in each of kColumns slices of time,
// so that no peak is lost and memory is bounded, however often it is published.
class Course {
 public:
  static constexpr int kColumns = 150;
  struct Slice {
    std::int64_t number = 0;  // of its time divided by its length
    double lowest = 0, highest = 0;
  };

  explicit Course(sync::Nanoseconds span) : length_(std::max(sync::Nanoseconds(1), span / kColumns)) {}
  // Not finite: not counted. Time may go back by a few messages, not further.
  void add(double value, sync::HostTime t);
  // Those of the span that ends now, oldest first.
  std::vector<Slice> slices(sync::HostTime now) const;
  std::int64_t number(sync::HostTime t) const { return t.time_since_epoch() / length_; }
  // Of all slices of the span; nothing when there are none.
  std::optional<std::pair<double, double>> range(sync::HostTime now) const;
  sync::Nanoseconds span() const { return length_ * kColumns; }

 private:
  sync::Nanoseconds length_;
  std::deque<Slice> slices_;
};

// A number as a label: four digits, "12.5", "1.2e-05"; a whole one as it is.
std::string label(double value);

// Where the column of plots begins in a picture of that width.
float plots_left(int picture_width);

class Plots {
 public:
  // span: of the graphs, and how long a bar remembers what was most.
  Plots(std::vector<PlotSpec> specs, sync::Nanoseconds span);
  bool empty() const { return plots_.empty(); }
  // Channels that are to be heard, each once.
  std::vector<std::string> channels() const;
  void push(const std::string& channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival);
  // One below the other from the upper right corner, as many as find room in that width and height.
  void append(std::vector<Rect>& overlay, sync::HostTime now, int width, int height) const;

 private:
  struct Plot {
    PlotSpec spec;
    Course course;
    std::optional<std::string> newest;  // as text
    double value = 0;
    sync::HostTime at{};
  };
  std::vector<Plot> plots_;
};

}  // namespace tactus::visual
