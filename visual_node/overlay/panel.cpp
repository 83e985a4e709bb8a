#include "visual_node/overlay/panel.h"

#include <algorithm>
#include <cstdio>

#include "sync/histogram.h"
#include "visual_node/frame/text.h"
#include "visual_node/overlay/keys.h"

namespace tactus::visual {
namespace {

std::string text(const char* format, auto... values) {
  char buffer[160];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

double ms(sync::Nanoseconds t) { return sync::to_seconds(t) * 1e3; }

void append_report(std::vector<std::string>& lines, const PanelFacts& f) {
  lines.push_back(text("contacts  %zu", f.contacts));
  const auto physics = f.physics.median();
  if (physics && f.physics.nominal_rate_Hz() > 0)
    lines.push_back(text("physics   %.2f of %.2f ms, x%.2f", ms(*physics), 1e3 / f.physics.nominal_rate_Hz(),
                         f.physics.realtime_factor()));
  else
    lines.push_back("physics   not heard of");
  lines.push_back(text("rendering %.1f of %.1f ms", ms(f.rendering), ms(f.period)));
}

void append_ages(std::vector<std::string>& lines, const PanelFacts& f) {
  for (const InputLine& i : f.inputs) {
    const std::string how = i.how == sync::How::kNone ? "" : std::string(" ") + sync::to_string(i.how);
    lines.push_back(i.age.age < sync::Nanoseconds(0) ? i.channel + " nothing yet" + how
                                                     : i.channel + text(" %.1f ms", ms(i.age.age)) + how);
  }
}

void append_degradation(std::vector<std::string>& lines, const PanelFacts& f) {
  lines.push_back("profile   " + (f.profile.empty() ? "none" : f.profile));
  lines.push_back(text("delay     %.0f ms, of the profile %.0f", ms(f.delay), ms(f.profile_delay)));
  if (f.output.frame_rate_Hz > 0) lines.push_back(text("pictures  %.3g a second", f.output.frame_rate_Hz));
  if (f.output.resolution > 0) lines.push_back(text("resolution %.2f", f.output.resolution));
  lines.push_back(text("quality   step %d of 0 to %d", f.quality, std::max(0, f.qualities - 1)));
}

}  // namespace

void TickTimes::push(const node_health_t& m) {
  if (newest_ && newest_->header.incarnation == m.header.incarnation && m.header.seq <= newest_->header.seq)
    return;
  if (newest_ && newest_->header.incarnation == m.header.incarnation) {
    histogram_t gained = m.tick;
    for (std::size_t i = 0; i < gained.bins.size() && i < newest_->tick.bins.size(); ++i)
      gained.bins[i] = std::max(0, gained.bins[i] - newest_->tick.bins[i]);
    const sync::Histogram h = sync::Histogram::from_message(gained);
    if (h.count() > 0) median_ = h.quantile(0.5);
  } else {
    median_.reset();
  }
  newest_ = m;
}

std::vector<std::string> panel_lines(const OverlaySet& on, const PanelFacts& f) {
  std::vector<std::string> lines;
  if (on.on(Overlay::kReport)) append_report(lines, f);
  if (on.on(Overlay::kGroups))
    lines.push_back(text("bodies    %zu haptic (orange), %zu visual (blue)", f.haptic_bodies, f.visual_bodies));
  if (on.on(Overlay::kDegradation)) append_degradation(lines, f);
  if (on.on(Overlay::kAges)) append_ages(lines, f);
  if (on.on(Overlay::kHelp))
    for (const std::string& line : help_lines()) lines.push_back(line);
  return lines;
}

float append_lines(std::vector<Rect>& overlay, const std::vector<std::string>& lines, float x, float y, float size,
                   float picture_width, float picture_height) {
  const float advance = (kGlyphWidth + 1) * size, step = (kGlyphHeight + 3) * size;
  const auto letters = static_cast<std::size_t>(std::max(0.0f, (picture_width - x - 4 * size) / advance));
  const auto room = static_cast<std::size_t>(std::max(0.0f, (picture_height - y - 4 * size) / step));
  const std::size_t shown = std::min(lines.size(), room);
  std::size_t longest = 0;
  for (std::size_t i = 0; i < shown; ++i) longest = std::max(longest, std::min(lines[i].size(), letters));
  if (longest == 0) return y;
  const float height = step * static_cast<float>(shown) + 3 * size;
  overlay.push_back({x, y, text_width(longest, size), height, 0, 0, 0, 0.65f});
  for (std::size_t i = 0; i < shown; ++i)
    append_letters(overlay, std::string_view(lines[i]).substr(0, letters), x + 2 * size,
                   y + 2 * size + step * static_cast<float>(i), size);
  return y + height + 2 * size;
}

float text_size(int picture_height) { return static_cast<float>(std::max(1, picture_height / 240)); }

}  // namespace tactus::visual
