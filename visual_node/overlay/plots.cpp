#include "visual_node/overlay/plots.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lcmtypes/utf8.h"
#include "sync/text/printable.h"
#include "visual_node/frame/text.h"
#include "visual_node/overlay/panel.h"

namespace tactus::visual {
namespace {

using Colour = Eigen::Vector3f;
constexpr float kMargin_px = 6, kPad_px = 3;
constexpr std::size_t kMaxTextLength = 64;
// An older value is drawn grey.
constexpr sync::Nanoseconds kOldAfter{2'000'000'000};

struct Box {  // place of a plot, pixels
  float x, y, width, size;
  float line() const { return (kGlyphHeight + 2) * size; }
};

void fill(std::vector<Rect>& out, float x, float y, float width, float height, const Colour& c, float alpha = 1) {
  out.push_back({x, y, width, height, c.x(), c.y(), c.z(), alpha});
}

std::size_t letters(const Box& b) {
  return static_cast<std::size_t>(std::max(0.0f, (b.width - 2 * kPad_px) / ((kGlyphWidth + 1) * b.size)));
}

// Appends a line of text, clipped at the edge of the box.
void words(std::vector<Rect>& out, const Box& b, std::string_view text, float y, const Colour& colour) {
  append_letters(out, text.substr(0, letters(b)), b.x + kPad_px, y, b.size, colour);
}

void right_words(std::vector<Rect>& out, const Box& b, std::string_view text, float y, const Colour& colour) {
  const float width = (kGlyphWidth + 1) * b.size * static_cast<float>(text.size());
  append_letters(out, text, b.x + b.width - kPad_px - width, y, b.size, colour);
}

void middle_words(std::vector<Rect>& out, const Box& b, std::string_view text, float y, const Colour& colour) {
  const float width = (kGlyphWidth + 1) * b.size * static_cast<float>(text.size());
  append_letters(out, text, b.x + (b.width - width) / 2, y, b.size, colour);
}

}  // namespace

float plots_left(int picture_width) { return 0.64f * static_cast<float>(picture_width) - kMargin_px; }

std::string label(double value) {
  char buffer[40];
  const bool whole = std::abs(value) < 1e7 && value == std::nearbyint(value);
  std::snprintf(buffer, sizeof buffer, whole ? "%.0f" : "%.4g", value);
  return buffer;
}

void ValueHistory::add(double value, sync::HostTime t) {
  if (!std::isfinite(value)) return;
  const std::int64_t slice = number(t);
  if (slices_.empty() || slice > slices_.back().number) {
    slices_.push_back({slice, value, value});
    while (slices_.size() > kColumns) slices_.pop_front();
    return;
  }
  // A value that is late by a slice or more is added to the newest slice.
  slices_.back().lowest = std::min(slices_.back().lowest, value);
  slices_.back().highest = std::max(slices_.back().highest, value);
}

std::vector<ValueHistory::Slice> ValueHistory::slices(sync::HostTime now) const {
  std::vector<Slice> seen;
  for (const Slice& s : slices_)
    if (s.number > number(now) - kColumns && s.number <= number(now)) seen.push_back(s);
  return seen;
}

std::optional<std::pair<double, double>> ValueHistory::range(sync::HostTime now) const {
  std::optional<std::pair<double, double>> range;
  for (const Slice& s : slices(now)) {
    if (!range) range.emplace(s.lowest, s.highest);
    range->first = std::min(range->first, s.lowest);
    range->second = std::max(range->second, s.highest);
  }
  return range;
}

Plots::Plots(std::vector<PlotSpec> specs, sync::Nanoseconds span) {
  for (PlotSpec& s : specs) plots_.push_back({std::move(s), ValueHistory(span), std::nullopt, 0, {}});
}

std::vector<std::string> Plots::channels() const {
  std::vector<std::string> names;
  for (const Plot& p : plots_)
    if (std::find(names.begin(), names.end(), p.spec.channel) == names.end()) names.push_back(p.spec.channel);
  return names;
}

void Plots::push(const std::string& channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival) {
  for (Plot& p : plots_) {
    if (p.spec.channel != channel) continue;
    const auto read = p.spec.read(bytes);
    if (!read) continue;
    p.at = arrival;
    if (const auto* words = std::get_if<std::string>(&*read)) {
      p.newest = sync::printable(first_characters(*words, kMaxTextLength));
      continue;
    }
    p.value = std::get<double>(*read);
    p.newest = label(p.value);
    p.history.add(p.value, arrival);
  }
}

namespace {

std::string span(double least, double most, const std::string& unit) {
  return label(least) + " to " + label(most) + (unit.empty() ? "" : " " + unit);
}

// Draws the curve of the values, scaled to their lowest and highest value, which are printed below it.
void append_graph(std::vector<Rect>& out, const Box& b, const ValueHistory& history, const std::string& unit,
                  sync::HostTime now, float height, const TextLook& look) {
  const auto range = history.range(now);
  const float top = b.y + b.line() + kPad_px, left = b.x + kPad_px;
  const float width = b.width - 2 * kPad_px, bottom = top + height;
  fill(out, left, bottom, width, 1, look.label, 0.6f);
  fill(out, left, top, 1, height, look.label, 0.6f);
  const std::string ago = label(-sync::to_seconds(history.span())) + " s", newest = "now";
  const std::string values = range ? span(range->first, range->second, unit) : "";
  // In a narrow picture the range of values has priority over the time labels.
  if (letters(b) >= ago.size() + values.size() + newest.size() + 2) {
    words(out, b, ago, bottom + kPad_px, look.label);
    right_words(out, b, newest, bottom + kPad_px, look.label);
  }
  if (!range) return;
  middle_words(out, b, std::string_view(values).substr(0, letters(b)), bottom + kPad_px, look.title);
  const double least = range->first, most = range->second;
  // A constant value is a line in the middle.
  const auto place = [&](double v) {
    // Halves avoid an overflow: the difference of two of the largest numbers is not finite.
    const double share = most > least ? (v / 2 - least / 2) / (most / 2 - least / 2) : 0.5;
    return bottom - static_cast<float>(share) * (height - 1);
  };
  const std::int64_t last = history.number(now);
  const float column = width / ValueHistory::kColumns;
  double before = 0;
  bool first = true;
  for (const ValueHistory::Slice& s : history.slices(now)) {
    // Drawn up to the previous slice, so that a step is a line.
    const double low = first ? s.lowest : std::min(s.lowest, before),
                 high = first ? s.highest : std::max(s.highest, before);
    first = false;
    before = s.lowest / 2 + s.highest / 2;
    const float x = left + column * static_cast<float>(ValueHistory::kColumns - 1 - (last - s.number));
    fill(out, x, place(high) - 1, std::max(1.0f, column), place(low) - place(high) + 2, look.curve);
  }
  if (least < 0 && most > 0) fill(out, left, place(0), width, 1, look.label, 0.4f);
}

// Draws a bar from zero to the value, on the scale of its recent range.
void append_bar(std::vector<Rect>& out, const Box& b, double value, const ValueHistory& history,
                sync::HostTime now, float y, const TextLook& look) {
  const auto range = history.range(now);
  if (!range || !std::isfinite(value)) return;
  const double least = std::min(0.0, range->first), most = std::max(0.0, range->second);
  const float left = b.x + kPad_px, width = b.width - 2 * kPad_px, height = b.line() * 0.8f;
  const auto place = [&](double v) {
    return left + static_cast<float>(
                      most > least ? (std::clamp(v, least, most) / 2 - least / 2) / (most / 2 - least / 2) : 0) *
                      width;
  };
  fill(out, left, y, width, height, look.label, 0.25f);
  const float from = std::min(place(0), place(value)), to = std::max(place(0), place(value));
  fill(out, from, y, std::max(1.0f, to - from), height, look.curve);
}

}  // namespace

void Plots::append(std::vector<Rect>& overlay, sync::HostTime now, int width, int height, const TextLook& look) const {
  const float size = look.scaled(std::max(1.0f, text_size(height) - 1));
  Box b{plots_left(width), kMargin_px, 0, size};
  b.width = static_cast<float>(width) - kMargin_px - b.x;
  const float graph_height = 46 * size;
  for (const Plot& p : plots_) {
    const bool graph = p.spec.kind == PlotSpec::Kind::kGraph, bar = p.spec.kind == PlotSpec::Kind::kBar;
    const float body = (graph ? graph_height + 2 * kPad_px : bar ? b.line() + kPad_px : 0) + b.line();
    const float plate_height = b.line() + body + 2 * kPad_px;
    if (b.y + plate_height > static_cast<float>(height)) return;
    append_plate(overlay, look.plot, b.x, b.y, b.width, plate_height);
    words(overlay, b, p.spec.title, b.y + kPad_px, look.title);
    const std::string unit = p.spec.value.unit();
    const std::string value = !p.newest           ? "nothing yet"
                              : p.newest->empty() ? "(empty)"
                              : unit.empty()      ? *p.newest
                                                  : *p.newest + " " + unit;
    const bool old = !p.newest || now - p.at > kOldAfter;
    const float y = b.y + b.line() + kPad_px;
    if (graph) append_graph(overlay, b, p.history, unit, now, graph_height, look);
    if (bar) append_bar(overlay, b, p.value, p.history, now, y, look);
    if (!graph) words(overlay, b, value, bar ? y + b.line() + kPad_px : y, old ? look.old : look.label);
    b.y += plate_height + kMargin_px;
  }
}

}  // namespace tactus::visual
